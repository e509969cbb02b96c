// DriveRange: how far the ideal mechanism lets a driven joint move.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "assembly/closed_mechanism.h"
#include "system/state.h"

namespace freeplay {

/// Coordinates [rad or m] between which a joint can move while everything else that holds the mechanism holds; infinite
/// where nothing ends the way: after a whole turn, or after three times the size of the model.
struct DriveRange {
  double from = -std::numeric_limits<double>::infinity(), to = -from;
  bool limited() const { return from > -std::numeric_limits<double>::infinity() || to < -from; }
};

/// Follows the mechanism from its state, where its rows hold with `joint` leading (the last of the leads), both ways
/// in small steps up to where it cannot follow any more, to 1e-6 of a radian or of the model's size. The state stays.
DriveRange drive_range(ClosedMechanism& mechanism);

/// "turn from -97.2 deg to 97.2 deg", "move up to 0.12 m": of a joint of the coordinate.
std::string words(const DriveRange& range, Coordinate coordinate);
/// "97.2 deg" or "0.12 m".
std::string words(double value, Coordinate coordinate);

/// A driver that starts where its joint is at a dead point: with it the rows lose rank there and nowhere around.
struct DeadStart {
  int driver = 0;
  std::vector<int> joints;  ///< whose rows depend on each other there
};

/// Of the ideal mechanism, in the state in which a run of `system` begins.
std::optional<DeadStart> dead_start(const System& system, const State& start);
/// One sentence without full stop.
std::string words(const DeadStart& start, const Model& model);

/// "joints 'A', 'B'": some of them where there are many.
std::string joint_names(std::span<const int> joints, const Model& model);

/// Of a mechanism whose rows do not hold: which of its leading or driven joints would have to stand elsewhere, and in
/// which range, for it to close. The state is lost.
std::optional<std::string> closes_elsewhere(ClosedMechanism& mechanism);

/// Why a run that ended at time `t` could not go on, where a driver asks for a position that the ideal mechanism cannot
/// take: which joint, where, how far the loop then is from closing, and between which values it can be driven, or what
/// holds it where it can be driven nowhere. It ends with its word: "[dead-point]" or "[locked]". Empty where the
/// mechanism could follow. `start` is the state in which the run of `system` began.
std::optional<std::string> why_out_of_reach(const System& system, const State& start, double t);

/// The first time at which a driver asks for a position that the mechanism could not take though all its play were
/// added up twice: from there on contacts are torn apart. Infinite where there is none, and where several drivers move.
double out_of_reach_from(const System& system, const State& start);

}  // namespace freeplay
