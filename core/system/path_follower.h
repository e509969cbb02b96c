// PathFollower: the ideal mechanism led by the frames of its paths, for driven joints without a closed form.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "linear/least_squares.h"
#include "system/path_row.h"

namespace freeplay {

/// In the closed mechanism the rows of the drivers of such entries give way to the rows of their paths, and q follows
/// from Phi(q, t) = 0 by Newton's method, v and a from Phi_q v = nu and Phi_q a = gamma. Positions are found once along
/// the whole run, from the assembled start on, at instants so close that the way between two of them is certain. A
/// value at time t is then found from the nearest of them: it depends on t alone, never on earlier calls.
class PathFollower final : public FollowedMotion {
 public:
  /// `closed` at the coordinates `q` with angles counted as in `h` stands on the paths at the start time. Throws
  /// Error{input} "ik-unreachable" when it cannot move along them from there.
  PathFollower(const System& closed, std::span<const double> q, std::span<const double> h);

  std::unique_ptr<FollowedMotion::Work> make_work() const override;
  bool evaluate(double t, Span<TimeValue> out, FollowedMotion::Work& own, MotionFault& fault) const noexcept override;
  bool frame(int kinematics, double t, PathPose& pose, FollowedMotion::Work& own,
             MotionFault& fault) const noexcept override;

 private:
  /// Work space of one solution; `state` is the solution.
  struct Work final : FollowedMotion::Work {
    Work(const System& system, int rows);
    State state;
    Evaluation e;
    LeastSquares solver;
    std::vector<double> right, step, before;
    std::vector<SparseEntry> entries;
  };
  enum class Found { yes, no, fault };

  void find_way();
  bool certain(const State& left, const State& right, Work& work);
  Found solve(double t, const State& from, Work& work, MotionFault& fault) const noexcept;
  bool assemble(double t, Work& work, MotionFault& fault) const noexcept;
  int rows() const { return static_cast<int>(kept_.size() + paths_.size()); }
  double distance(std::span<const double> a, std::span<const double> b) const;
  double scaled(std::span<const double> step) const;
  const State& nearest(double t) const;
  bool reach(double t, Work& work, MotionFault& fault) const noexcept;
  void fail(double t, MotionFault& fault) const noexcept;

  const Model& model_;
  System system_;
  std::vector<int> kept_;    ///< rows of the closed system that stay
  std::vector<int> row_of_;  ///< by row of the closed system: its place in kept_, or -1
  std::vector<PathRow> paths_;
  std::vector<int> drivers_;  ///< that follow
  std::vector<State> way_;    ///< solutions in order of time
  double lost_ = 0.0;         ///< where the way ends before the run does; beyond the run: nowhere
};

}  // namespace freeplay
