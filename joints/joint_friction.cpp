#include <algorithm>
#include <cmath>

#include "axis_force.h"

namespace freeplay {
namespace {

/// Coulomb friction in a joint, smooth everywhere, for a speed s' along or about its axis:
///   E = F tanh(s'/vs)
class DryFriction {
 public:
  explicit DryFriction(const Parameters& p) : size_(p.number("friction")), vs_(p.number("vs")) {}

  template <class T>
  T effort(const JointInput& in, const T& s, const T& rate) const {
    const double t = std::tanh(space::value_of(rate) / vs_), size = std::max(0.0, in.function(0, size_));
    return space::chained(size * t, 0.0, s, size * (1.0 - t * t) / vs_, rate);
  }
  const char* doubt(const JointInput& in) const {
    return in.function(0, size_) < below_zero ? "The friction is negative here; there is none." : nullptr;
  }
  double stored(double) const { return 0.0; }
  double stored_rate(double, double) const { return 0.0; }

 private:
  double size_, vs_;
};

constexpr Parameter joint_friction_parameters[] = {
    space::axis_kind_parameter,
    {.name = "friction",
     .unit = "kind: N | N*m",
     .minimum = 0.0,
     .summary = "Force or torque of sliding friction; under `forces` also a function of time or of the motion.",
     .variables = "motion"},
    {.name = "vs",
     .unit = "kind: m/s | rad/s",
     .default_value = 1e-3,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Speed that smooths the change of sign."}};

}  // namespace

Component joint_friction() {
  return joint<space::AxisForce<DryFriction>>(
      {.name = "joint-friction",
       .space = Space::both,
       .summary = "Force element: dry friction along or about the axis of a joint.",
       .formula = "effort on the second body -friction tanh(speed/vs), along x of the first frame or about its z.",
       .validity = "Sliding; under load the joint creeps, as the force of rest takes a speed.",
       .references = "Andersson, Soderberg and Bjorklund 2007, Tribol Int 40, 580-587 (coulomb-tanh)",
       .parameters = joint_friction_parameters});
}

}  // namespace freeplay
