// LightLoads: forces and torques that move nothing by as much as positions may err.
#pragma once

#include <algorithm>
#include <cmath>

#include "system/system.h"

namespace freeplay {

/// In a step of the length dt a force moves a mass by force dt^2/mass and makes it faster by force dt/mass, which
/// counts for the rest of the run, or a second. The lightest body counts.
class LightLoads {
 public:
  /// `allowed`: by which positions may err in a step [m].
  LightLoads(const System& system, double allowed) {
    const Model& model = system.model();
    constexpr double none = std::numeric_limits<double>::infinity();
    double mass = none, inertia = none;
    for (const Body& body : model.bodies) {
      if (body.mass > 0.0) mass = std::min(mass, body.mass);
      for (const std::size_t axis : {0u, 4u, 8u}) {
        if (body.inertia[axis] > 0.0) inertia = std::min(inertia, body.inertia[axis]);
      }
    }
    length_ = little * allowed;
    lasting_ = std::max(1.0, model.settings.end - model.settings.start);
    force_ = std::isfinite(mass) ? length_ * mass : 0.0;
    torque_ = std::isfinite(inertia) ? length_ / system.size() * inertia : 0.0;
  }

  double force(double dt) const { return force_ / (dt * std::max(dt, lasting_)); }    ///< [N]
  double torque(double dt) const { return torque_ / (dt * std::max(dt, lasting_)); }  ///< [N m]
  double length() const { return length_; }                                           ///< that does not matter [m]

 private:
  static constexpr double little = 0.01;  // of what positions may err by in a step
  double length_, lasting_, force_, torque_;
};

}  // namespace freeplay
