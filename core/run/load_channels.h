// LoadChannels: the loads of a model that depend on the motion, and the channels of their formulas along it.
#pragma once

#include <string>
#include <vector>

#include "base/jet.h"
#include "run/idle_loads.h"
#include "system/motion_channels.h"
#include "system/system.h"

namespace freeplay {

class LoadChannels {
 public:
  [[gnu::cold]] explicit LoadChannels(const System& system);

  struct Load {
    const MotionFormulas* formulas;
    std::string words;  ///< "force 'x'" or "driver 'x'"
    bool turns;         ///< a torque
    ActsOn on;
    int first_switch;                     ///< of its formulas, in Layout::switches
    std::vector<double> units;            ///< by channel: what counts as 1 m, or as 1 m in a second
    const AppliedForce* force = nullptr;  ///< whose components the formulas are, if they are of one
  };
  const std::vector<Load>& loads() const { return loads_; }
  /// Values and rates at an evaluated point (forces or events), for the accelerations `a` of the unknowns.
  void follow(const Load& load, std::span<const double> a, const Evaluation& e, std::span<Jet> channels) const;

 private:
  MotionChannels channels_;
  std::vector<Load> loads_;
};

}  // namespace freeplay
