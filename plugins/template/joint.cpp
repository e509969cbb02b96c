// my-type: a joint of your own. As it stands, a soft bushing: two points held together by a spring and a damper.
#include <cmath>

#include "freeplay/plugin.h"

namespace {

using namespace freeplay;

// What a model file may say. Units are checked, bounds are checked, `freeplay describe my-type` prints this table.
constexpr Parameter parameters[] = {
    {.name = "stiffness", .unit = "N/m", .minimum = 0.0, .open = Open::minimum, .summary = "Force per distance."},
    {.name = "damping", .unit = "N*s/m", .default_value = 0.0, .minimum = 0.0, .summary = "Force per speed."},
};

// What the joint reports: column joint.NAME.stretch of the results.
constexpr Channel channels[] = {{"stretch", "m"}};

/// Force on the second body at its point b, its reaction on the first body at the same place:
///   F = -(stiffness d + damping d'),  d = b - a [m] in world axes.  Stored energy: stiffness |d|^2 / 2.
/// d' is as the first body sees it: the rate in world axes would do work on a body that turns.
class MyType final : public Joint {
 public:
  explicit MyType(const Parameters& p) : stiffness_(p.number("stiffness")), damping_(p.number("damping")) {}

  // Counts are fixed here, once: rows of constraints, internal variables, history, events, channels.
  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;  // apply() does not read in.t: no run has to look for changes in time
    layout.forces = 1;
    layout.channels = channels;
  }

  // A constraint instead of a force: set layout.constraint_rows and fill phi, jacobian, nu and gamma in constrain().
  void apply(const JointInput& in, JointForces& out) const override {
    double d[2];
    difference(in.b->position, in.a->position, d);
    double rate[2];
    difference(in.b->velocity, in.a->velocity, rate);
    rate[0] += in.a->angular_velocity[2] * d[1];
    rate[1] -= in.a->angular_velocity[2] * d[0];
    for (int i = 0; i < 2; ++i) {
      out.wrench_b[i] = -(stiffness_ * d[i] + damping_ * rate[i]);
      out.wrench_a[i] = -out.wrench_b[i];
    }
    // The reaction acts at b too, so about the first body's own point it has a moment.
    out.wrench_a[5] = d[0] * out.wrench_a[1] - d[1] * out.wrench_a[0];
    out.potential = 0.5 * stiffness_ * (d[0] * d[0] + d[1] * d[1]);
  }

  void observe(const JointInput& in, Span<const double>, Span<double> values) const override {
    double d[2];
    difference(in.b->position, in.a->position, d);
    values[0] = std::hypot(d[0], d[1]);
  }

 private:
  static void difference(const double (&b)[3], const double (&a)[3], double (&d)[2]) {
    for (int i = 0; i < 2; ++i) d[i] = b[i] - a[i];
  }
  double stiffness_, damping_;
};

}  // namespace

FREEPLAY_PLUGIN(my_type) {
  static const Component components[] = {
      joint<MyType>({.name = "my-type",
                     .space = Space::planar,
                     .summary = "Soft bushing between two points.",
                     .formula = "F = -(stiffness d + damping d'), d: from the first point to the second, in its body.",
                     .validity = "Planar models.",
                     .parameters = parameters}),
  };
  return publish(*host, *manifest, "my_type", "0.1.0", components);
}
