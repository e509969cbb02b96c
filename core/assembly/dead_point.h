// DeadStart: a driver that starts at a dead point of its joint. SingularPosition: the same of a mechanism that no
// driver leads.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "system/state.h"
#include "system/system.h"

namespace freeplay {

/// A driver that starts where its joint is at a dead point: with it the rows lose rank there and nowhere around; or
/// there is nothing around, as where the links of a loop are just long enough to close it.
struct DeadStart {
  int driver = 0;
  bool stuck = false;       ///< no way leads away
  std::vector<int> joints;  ///< whose rows depend on each other there
};

/// Of the ideal mechanism, in the state in which a run of `system` begins.
std::optional<DeadStart> dead_start(const System& system, const State& start);
/// One sentence without full stop.
std::string words(const DeadStart& start, const Model& model);

/// A position in which the rows depend on each other and do not beside it, as of links in line.
struct SingularPosition {
  int lead = 0;             ///< a joint that moves away from it
  double part = 0.0;        ///< singular value of the rows that is lost, of what it is beside
  std::vector<int> joints;  ///< whose rows depend on each other there
};

/// Of a mechanism without play, in a state of `system`; every driver holds.
std::optional<SingularPosition> singular_position(const System& system, const State& now);
/// "a singular position, where ...", without full stop.
std::string words(const SingularPosition& position, const Model& model);

/// "joints 'A', 'B'": some of them where there are many.
std::string joint_names(std::span<const int> joints, const Model& model);

}  // namespace freeplay
