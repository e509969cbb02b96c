#include "run/lasting_blows.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace freeplay {
namespace {
constexpr double fall_of_blow = 0.5;  // to which the force falls between a blow and what comes after it

double decade_of_force(double force) { return std::floor(std::log10(std::max(force, 1e-9))); }
}  // namespace

LastingBlows::LastingBlows(const System& system) {
  const Model& model = system.model();
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    if (!(system.joints().layout(static_cast<int>(j)).clearance > 0.0)) continue;
    joints_.push_back({.joint = static_cast<double>(j), .phase = static_cast<double>(Phase::over)});
  }
}

void LastingBlows::add(const Evaluation& e) {
  for (OfJoint& one : joints_) {
    const double* wrench = &e.wrench[12 * static_cast<std::size_t>(one.joint) + 6];
    const bool rests = wrench[0] == 0.0 && wrench[1] == 0.0 && wrench[2] == 0.0;
    const double force = rests ? 0.0 : std::hypot(wrench[0], wrench[1], wrench[2]);
    one.largest = std::max(one.largest, force);
    Phase phase = static_cast<Phase>(static_cast<int>(one.phase));
    if (!(force > 0.0)) {
      phase = Phase::apart;
    } else if (phase == Phase::apart) {
      phase = Phase::rises;
      one.steps = 1.0, one.peak = force;
    } else if (phase == Phase::rises && force >= one.peak) {
      ++one.steps, one.peak = force;
    } else if (phase == Phase::rises || (phase == Phase::falls && force <= one.low)) {
      phase = Phase::falls;
      ++one.steps, one.low = force;
    } else if (phase == Phase::falls) {
      phase = Phase::over;
      const bool harder = decade_of_force(one.peak) > decade_of_force(one.hardest),
                 alike = decade_of_force(one.peak) == decade_of_force(one.hardest);
      if (one.low < fall_of_blow * one.peak && (harder || (alike && one.steps < one.fewest)))
        one.fewest = one.steps, one.hardest = one.peak;
    }
    one.phase = static_cast<double>(phase);
  }
}

LastingBlows::Fewest LastingBlows::fewest() const {
  Fewest out;
  for (const OfJoint& one : joints_) {
    if (!(one.fewest < out.steps) || decade_of_force(one.hardest) < decade_of_force(one.largest)) continue;
    out = {one.fewest, static_cast<int>(one.joint)};
  }
  return out;
}

}  // namespace freeplay
