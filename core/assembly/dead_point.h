// DeadStart: a driver that starts at a dead point of its joint.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "system/state.h"
#include "system/system.h"

namespace freeplay {

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

}  // namespace freeplay
