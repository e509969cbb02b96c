// Example of a joint plugin: a torsional spring and damper between two frames. One file, one class, one table.
#include <cmath>

#include "freeplay/plugin.h"

namespace {

using namespace freeplay;

constexpr Parameter parameters[] = {
    {.name = "stiffness", .unit = "N*m", .minimum = 0.0, .summary = "Torque per angle of twist."},
    {.name = "damping", .unit = "N*m*s", .default_value = 0.0, .minimum = 0.0, .summary = "Torque per speed of twist."},
    {.name = "free_angle", .unit = "rad", .default_value = 0.0, .summary = "Angle without torque."},
};

constexpr Channel channels[] = {{"spring_torque", "N*m"}};

/// Torque on the second body: -(stiffness (s - free_angle) + damping s'), s being the angle of the second frame in the
/// first. The stored energy is stiffness (s - free_angle)^2 / 2.
class TorsionalSpringDamper final : public Joint {
 public:
  explicit TorsionalSpringDamper(const Parameters& p)
      : stiffness_(p.number("stiffness")), damping_(p.number("damping")), free_angle_(p.number("free_angle")) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.coordinate = Coordinate::angle;  // the host reports it, counts its turns and hands it to apply()
    layout.forces = 1;
    layout.channels = channels;
  }

  void coordinate(const JointInput& in, CoordinateRow& out) const override {
    const double *a = in.a->rotation, *b = in.b->rotation;
    out.value = std::atan2(a[0] * b[3] - a[3] * b[0], a[0] * b[0] + a[3] * b[3]);
    out.jacobian[5] = -1.0;
    out.jacobian[11] = 1.0;
  }

  void apply(const JointInput& in, JointForces& out) const override {
    out.wrench_b[5] = torque(in);
    out.wrench_a[5] = -torque(in);
    out.potential = 0.5 * stiffness_ * (in.coordinate - free_angle_) * (in.coordinate - free_angle_);
  }

  void observe(const JointInput& in, Span<const double>, Span<double> values) const override { values[0] = torque(in); }

 private:
  double torque(const JointInput& in) const {
    return -stiffness_ * (in.coordinate - free_angle_) - damping_ * in.coordinate_rate;
  }
  double stiffness_, damping_, free_angle_;
};

}  // namespace

FREEPLAY_PLUGIN(example) {
  static const Component components[] = {
      joint<TorsionalSpringDamper>({.name = "torsional-spring-damper",
                                    .space = Space::planar,
                                    .summary = "Torsional spring and damper between two frames.",
                                    .formula = "torque = -(stiffness (s - free_angle) + damping s')",
                                    .parameters = parameters}),
  };
  return publish(*host, *manifest, "example", "1.0.0", components);
}
