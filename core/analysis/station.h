// Station: one pose, instant or set of inputs that an analysis looks at, and the posture there.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "analysis/joint_way.h"
#include "analysis/posture.h"
#include "model/grid_values.h"

namespace freeplay {

struct Station {
  double time = std::numeric_limits<double>::quiet_NaN();  ///< on a path [s]; NaN elsewhere
  Demand demand;
  bool reachable = false;
  bool folded = false;  ///< on a fold of its branch (PostureSolver::folded): speeds have no value
  Unreachable why;
  Posture posture;  ///< where it is reachable
};

/// The components of a pose that are to be given: those of `given`, and all angles where the mechanism leaves its frame
/// all freedoms (they are 0 then). Throws Error{usage} "bad-value", or Error{input} "ik-underdetermined" at `place` if
/// it names a file: the mechanism leaves its frame more or fewer freedoms.
Components components_to_give(const PoseForm& form, int freedoms, const Components& given, const std::string& what,
                              const Location& place);

/// Called with 1 when a pose is taken up and with 0 now and then inside a long one, by any thread; what it throws ends
/// the analysis. May be empty.
using Tick = std::function<void(long done)>;

/// Each reached from the start by a straight way.
std::vector<Station> at_demands(IdealMechanism& mechanism, const std::vector<Demand>& demands, const Tick& tick = {});

/// Along the path of Platform::path, or, where there is none, along what drivers prescribe for the inputs; from the
/// start time on. Throws Error{numerical} "bad-expression" where the path has no value.
std::vector<Station> along_path(IdealMechanism& mechanism, const GridValues& times, const Tick& tick = {});

/// `axes`: of each number of a pose; the first slowest. Where all has a closed form every point stands by itself; else
/// points are reached from their neighbours, beginning next to the start, where no joint leaves one of `ways`. The
/// result does not depend on `threads`.
std::vector<Station> on_grid(IdealMechanism& mechanism, std::span<const GridValues> axes, const Components& given,
                             int threads, const Tick& tick = {}, std::span<const JointWay> ways = {});

/// Calls work(worker, first, last) for pieces of 0 .. count, `threads` at a time, `worker` being the number of the
/// piece, and tick(0) now and then while the caller waits for others. Rethrows the first exception by piece.
void in_parallel(std::size_t count, int threads, const Tick& tick,
                 const std::function<void(int, std::size_t, std::size_t)>& work);

}  // namespace freeplay
