// Example of a joint with history that loses energy when a step is accepted: a spring that yields.
#include <algorithm>
#include <cmath>

#include "freeplay/plugin.h"

namespace {

using namespace freeplay;

constexpr Parameter parameters[] = {
    {.name = "stiffness",
     .unit = "N*m",
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Torque per angle of twist."},
    {.name = "yield", .unit = "N*m", .minimum = 0.0, .open = Open::minimum, .summary = "Torque at which it yields."},
    {.name = "set",
     .kind = ParameterKind::list,
     .unit = "rad",
     .default_value = optional,
     .summary = "Angles by which it was bent before, added up.",
     .most = 100},
};

constexpr Channel channels[] = {{"bending_torque", "N*m"}, {"permanent_set", "rad"}};

/// Torque on the second body: -stiffness (s - p), s being the angle of the second frame in the first. Where it is
/// beyond the yield torque at the end of a step, the permanent set p moves until it is not. The stored energy is
/// stiffness (s - p)^2/2, so that this takes some of it, which nothing gives back.
class YieldingSpring final : public Joint {
 public:
  explicit YieldingSpring(const Parameters& p)
      : stiffness_(p.number("stiffness")), most_(p.number("yield") / stiffness_) {
    for (const double angle : p.list("set")) set_ += angle;
  }

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.coordinate = Coordinate::angle;
    layout.history = 1;
    layout.forces = 1;
    layout.channels = channels;
  }
  void coordinate(const JointInput& in, CoordinateRow& out) const override {
    const double *a = in.a->rotation, *b = in.b->rotation;
    out.value = std::atan2(a[0] * b[3] - a[3] * b[0], a[0] * b[0] + a[3] * b[3]);
    out.jacobian[5] = -1.0;
    out.jacobian[11] = 1.0;
  }
  void initialize(const JointInput&, Span<double>, Span<double> history) const override { history[0] = set_; }

  void apply(const JointInput& in, JointForces& out) const override {
    out.wrench_b[5] = torque(in);
    out.wrench_a[5] = -torque(in);
    out.potential = stored(in.coordinate - in.history[0]);
    out.potential_rate = -torque(in) * in.coordinate_rate;
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    const double bend = in.coordinate - history[0], kept = std::clamp(bend, -most_, most_);
    history[0] += bend - kept;
    if (in.dissipated != nullptr) *in.dissipated += stored(bend) - stored(in.coordinate - history[0]);
  }
  void observe(const JointInput& in, Span<const double>, Span<double> values) const override {
    values[0] = torque(in);
    values[1] = in.history[0];
  }

 private:
  double torque(const JointInput& in) const { return -stiffness_ * (in.coordinate - in.history[0]); }
  double stored(double bend) const { return 0.5 * stiffness_ * bend * bend; }
  double stiffness_, most_, set_ = 0.0;  // [N m/rad], [rad], [rad]
};

}  // namespace

FREEPLAY_PLUGIN(yielding_spring) {
  static const Component components[] = {
      joint<YieldingSpring>({.name = "yielding-spring",
                             .space = Space::planar,
                             .summary = "Torsional spring that yields between two frames.",
                             .formula = "torque = -stiffness (s - p), |torque| <= yield at the end of each step",
                             .parameters = parameters}),
  };
  return publish(*host, *manifest, "yielding_spring", "1.0.0", components);
}
