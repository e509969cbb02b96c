// Joints that an author might write from the headers alone, each using something that the built-in types do not.
#include <algorithm>
#include <cmath>

#include "freeplay/plugin.h"

namespace {

using namespace freeplay;

double angle_between(const JointInput& in) {
  const double *a = in.a->rotation, *b = in.b->rotation;
  return std::atan2(a[0] * b[3] - a[3] * b[0], a[0] * b[0] + a[3] * b[3]);
}

/// Where marker b stands in the axes h, n of marker a, which turns with w: x = h.d, y = n.d, and their rates.
struct Relative {
  explicit Relative(const JointInput& in)
      : h{in.a->rotation[0], in.a->rotation[3]}, n{in.a->rotation[1], in.a->rotation[4]}, w(in.a->angular_velocity[2]) {
    for (int i = 0; i < 2; ++i) {
      const double d = in.b->position[i] - in.a->position[i], v = in.b->velocity[i] - in.a->velocity[i];
      x += h[i] * d, y += n[i] * d, vx += h[i] * v, vy += n[i] * v;
    }
    dx = vx + w * y, dy = vy - w * x;
  }
  /// The first two rows: those of x and y.
  void fill(ConstraintRows& rows) const {
    for (std::size_t i = 0; i < 2; ++i) {
      rows.jacobian[i] = -h[i], rows.jacobian[6 + i] = h[i];
      rows.jacobian[12 + i] = -n[i], rows.jacobian[18 + i] = n[i];
    }
    rows.jacobian[5] = y, rows.jacobian[17] = -x;
    rows.gamma[0] = -w * (vy + dy), rows.gamma[1] = w * (vx + dx);
  }
  double h[2], n[2], w, x = 0, y = 0, vx = 0, vy = 0, dx = 0, dy = 0;
};

constexpr Parameter wheel_parameters[] = {{.name = "radius", .unit = "m", .summary = "Of the wheel."}};

/// A wheel that rolls on the x axis of the first frame: its row reads the joint's own coordinate.
class RollingWheel final : public Joint {
 public:
  explicit RollingWheel(const Parameters& p) : radius_(p.number("radius")) {}
  void declare(JointLayout& layout) const override {
    layout.coordinate = Coordinate::angle;
    layout.constraint_rows = 2;
  }
  void coordinate(const JointInput& in, CoordinateRow& out) const override {
    out.value = angle_between(in);
    out.jacobian[5] = -1.0;
    out.jacobian[11] = 1.0;
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const Relative r(in);
    r.fill(rows);
    rows.phi[0] = r.x + radius_ * in.coordinate;
    rows.phi[1] = r.y - radius_;
    rows.jacobian[5] -= radius_, rows.jacobian[11] += radius_;
  }

 private:
  double radius_;
};

constexpr Parameter stop_parameters[] = {{.name = "gap", .unit = "m", .summary = "Free way."},
                                         {.name = "stiffness", .unit = "N/m", .summary = "Of the stop."}};
constexpr Channel impacts[] = {{"impacts", "1"}};
constexpr Event stop_events[] = {{"stop_begin", Crossing::rising, 1, {}}, {"stop_end", Crossing::falling, 1, {}}};

/// A stop at x = gap of the first frame that counts its impacts. Its event functions are numbers all the time.
class HardStop final : public Joint {
 public:
  explicit HardStop(const Parameters& p) : gap_(p.number("gap")), stiffness_(p.number("stiffness")) {}
  void declare(JointLayout& layout) const override {
    layout.forces = 1;
    layout.history = 1;
    layout.events = stop_events;
    layout.channels = impacts;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    const Relative r(in);
    const double depth = std::max(0.0, r.x - gap_), force = stiffness_ * depth;
    for (std::size_t i = 0; i < 2; ++i) out.wrench_a[i] = force * r.h[i], out.wrench_b[i] = -force * r.h[i];
    out.wrench_a[5] = -r.y * force;  // the reaction acts where b is
    out.potential = 0.5 * force * depth;
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    const Relative r(in);
    g[0] = g[1] = r.x - gap_;
    rate[0] = rate[1] = r.dx;
  }
  void on_event(int index, const JointInput&, Span<double>, Span<double> history, Span<double>) const override {
    if (index == 0) history[0] += 1.0;
  }
  void observe(const JointInput& in, Span<const double>, Span<double> values) const override {
    values[0] = in.history[0];
  }

 private:
  double gap_, stiffness_;
};

constexpr Parameter pin_parameters[] = {
    {.name = "way", .kind = ParameterKind::function, .unit = "m", .summary = "Place of the pin along x."}};

/// A pin that is moved along x: its rows depend on time, and their force does work.
class MovedPin final : public Joint {
 public:
  explicit MovedPin(const Parameters& p) : way_(p.function("way")) {}
  void declare(JointLayout& layout) const override { layout.constraint_rows = 2; }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const TimeValue way = way_.at(in.t);
    const Relative r(in);
    r.fill(rows);
    rows.phi[0] = r.x - way.value;
    rows.phi[1] = r.y;
    rows.nu[0] = way.rate;
    rows.gamma[0] += way.acceleration;
  }

 private:
  TimeFunction way_;
};

}  // namespace

FREEPLAY_PLUGIN(honest_joints) {
  static const Component components[] = {
      joint<RollingWheel>({.name = "rolling-wheel",
                           .space = Space::planar,
                           .summary = "Wheel on a plane.",
                           .parameters = wheel_parameters}),
      joint<HardStop>(
          {.name = "hard-stop", .space = Space::planar, .summary = "Elastic stop.", .parameters = stop_parameters}),
      joint<MovedPin>(
          {.name = "moved-pin", .space = Space::planar, .summary = "Pin that is moved.", .parameters = pin_parameters}),
  };
  return publish(*host, *manifest, "honest_joints", "1.0.0", components);
}
