#include <cmath>

#include "axis_force.h"

namespace freeplay {
namespace {

/// Coulomb friction of constant size in a joint, smooth everywhere, for a speed s' along or about its axis:
///   E = F tanh(s'/vs)
class DryFriction {
 public:
  explicit DryFriction(const Parameters& p) : size_(p.number("friction")), vs_(p.number("vs")) {}

  template <class T>
  T effort(const T& s, const T& rate) const {
    const double t = std::tanh(space::value_of(rate) / vs_);
    return space::chained(size_ * t, 0.0, s, size_ * (1.0 - t * t) / vs_, rate);
  }
  double stored(double) const { return 0.0; }
  double stored_rate(double, double) const { return 0.0; }

 private:
  double size_, vs_;
};

constexpr Parameter joint_friction_parameters[] = {
    space::axis_kind_parameter,
    {.name = "friction", .unit = "kind: N | N*m", .minimum = 0.0, .summary = "Force or torque of sliding friction."},
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
       .summary = "Force element: dry friction of constant size along or about the axis of a joint.",
       .formula = "effort on the second body -friction tanh(speed/vs), along x of the first frame or about its z.",
       .validity = "Sliding; under load the joint creeps, as the force of rest takes a speed.",
       .references = "Andersson, Soderberg and Bjorklund 2007, Tribol Int 40, 580-587 (coulomb-tanh)",
       .parameters = joint_friction_parameters});
}

}  // namespace freeplay
