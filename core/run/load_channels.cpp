#include "run/load_channels.h"

#include <fmt/format.h>

#include "base/index.h"
#include "model/element_name.h"

namespace freeplay {

// Switches stand in the order of AppliedForces: forces, then efforts, then joints.
LoadChannels::LoadChannels(const System& system)
    : channels_(system.model(), system.layout(), system.markers(), system.joints()) {
  const Model& model = system.model();
  int switches = 0;
  const auto add = [&](const MotionFormulas& formulas, std::string words, bool turns, ActsOn on,
                       const AppliedForce* force = nullptr) {
    if (formulas.empty()) return;
    Load load{&formulas, std::move(words), turns, on, switches, {}, force};
    for (const MotionChannel& channel : formulas.channels) {
      load.units.push_back(channels_.turns(channel) ? 1.0 / system.size() : 1.0);
    }
    loads_.push_back(std::move(load));
    switches += formulas.switches();
  };
  for (const AppliedForce& force : model.forces) {
    add(force.by_motion, fmt::format("force '{}'", force.name), force.kind == ForceKind::torque, acts_on(system, force),
        &force);
  }
  for (const Driver& driver : model.drivers) {
    if (prescribes(driver.kind)) continue;
    add(driver.by_motion, fmt::format("driver '{}'", driver.name),
        system.joints().layout(driver.joint).coordinate == Coordinate::angle, acts_on(system, driver));
  }
  for (const JointElement& joint : model.joints) {
    add(joint.by_motion, written_name(joint), joint.layout.coordinate == Coordinate::angle, acts_on(system, joint));
  }
}

void LoadChannels::follow(const Load& load, std::span<const double> a, const Evaluation& e,
                          std::span<Jet> channels) const {
  for (std::size_t k = 0; k < channels.size(); ++k) {
    const MotionChannel& channel = load.formulas->channels[k];
    channels[k] = {channels_.value(channel, e), channels_.rate(channel, a, e), 0.0};
  }
}

}  // namespace freeplay
