#include <algorithm>
#include <cmath>

#include "freeplay/eigen.h"
#include "honest_components.h"

namespace freeplay::test {
namespace {

using Eigen::Vector3d;

/// Where b is, seen from a, and how that changes.
struct Gap {
  explicit Gap(const JointInput& in)
      : d(vector3(in.b->position) - vector3(in.a->position)),
        rate(vector3(in.b->velocity) - vector3(in.a->velocity)),
        length(d.norm()),
        along(d / length),
        speed(along.dot(rate)) {}
  Vector3d d, rate;
  double length;
  Vector3d along;
  double speed;
};

constexpr Parameter spring_parameters[] = {
    {.name = "stiffness", .unit = "N/m", .default_value = 1e9, .minimum = 0.0, .summary = "Force per length."},
    {.name = "damping", .unit = "N*s/m", .default_value = 0.0, .minimum = 0.0, .summary = "Force per speed."},
    {.name = "free_length", .unit = "m", .default_value = 0.2, .minimum = 0.0, .summary = "Length without force."}};
constexpr Parameter small_spring_parameters[] = {
    {.name = "stiffness", .unit = "N/m", .default_value = 1e-2, .minimum = 0.0, .summary = "Force per length."},
    {.name = "damping", .unit = "N*s/m", .default_value = 1e-5, .minimum = 0.0, .summary = "Force per speed."},
    {.name = "free_length", .unit = "m", .default_value = 1e-6, .minimum = 0.0, .summary = "Length without force."}};
constexpr Parameter large_spring_parameters[] = {
    {.name = "stiffness", .unit = "N/m", .default_value = 3e3, .minimum = 0.0, .summary = "Force per length."},
    {.name = "damping", .unit = "N*s/m", .default_value = 10.0, .minimum = 0.0, .summary = "Force per speed."},
    {.name = "free_length", .unit = "m", .default_value = 1e3, .minimum = 0.0, .summary = "Length without force."}};

/// Force on b: -(stiffness (L - free_length) + damping L') along the line of the origins.
struct Spring final : Joint {
  explicit Spring(const Parameters& p)
      : stiffness(p.number("stiffness")), damping(p.number("damping")), free_length(p.number("free_length")) {}
  void declare(JointLayout& layout) const override { layout.forces = 1; }
  void apply(const JointInput& in, JointForces& out) const override {
    const Gap gap(in);
    const double stretch = gap.length - free_length;
    add_force(in, out, vector3(in.b->position), -(stiffness * stretch + damping * gap.speed) * gap.along);
    out.potential = 0.5 * stiffness * stretch * stretch;
  }
  double stiffness, damping, free_length;
};

/// A stiff torsional spring beside a linear one, by the word `kind`.
constexpr Parameter either_parameters[] = {
    {.name = "stiffness", .unit = "kind: N/m | N*m/rad", .minimum = 0.0, .summary = "Of the kind."},
    {.name = "kind",
     .kind = ParameterKind::choice,
     .default_value = 0.0,
     .choices = "shift|turn",
     .summary = "Which."}};
struct Either final : Joint {
  explicit Either(const Parameters& p) : stiffness(p.number("stiffness")), turns(p.word("kind") == 1) {}
  void declare(JointLayout& layout) const override { layout.forces = 1; }
  void apply(const JointInput& in, JointForces& out) const override {
    if (turns) {
      const double *a = in.a->rotation, *b = in.b->rotation;
      const double s = a[0] * b[3] - a[3] * b[0], c = a[0] * b[0] + a[3] * b[3];
      add_torque(out, Vector3d(0.0, 0.0, -stiffness * s));  // of the energy k (1 - cos)
      out.potential = stiffness * (1.0 - c);
      return;
    }
    const Gap gap(in);
    add_force(in, out, vector3(in.b->position), -stiffness * gap.d);
    out.potential = 0.5 * stiffness * gap.length * gap.length;
  }
  double stiffness;
  bool turns;
};

/// The distance of the origins is `length`: (d.d - length^2)/2 = 0, which has entries of the size of the length.
constexpr Parameter rope_parameters[] = {
    {.name = "length", .unit = "m", .default_value = 1e3, .minimum = 0.0, .open = Open::minimum, .summary = "Kept."}};
constexpr Parameter hair_parameters[] = {
    {.name = "length", .unit = "m", .default_value = 1e-6, .minimum = 0.0, .open = Open::minimum, .summary = "Kept."}};
struct Rope final : Joint {
  explicit Rope(const Parameters& p) : length(p.number("length")) {}
  void declare(JointLayout& layout) const override { layout.constraint_rows = 1; }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const Gap gap(in);
    rows.phi[0] = 0.5 * (gap.d.squaredNorm() - length * length);
    for (int i = 0; i < 3; ++i) {
      rows.jacobian[static_cast<std::size_t>(i)] = -gap.d[i];
      rows.jacobian[static_cast<std::size_t>(6 + i)] = gap.d[i];
    }
    rows.gamma[0] = -gap.rate.squaredNorm();
  }
  bool place(double, Pose& pose) const override {
    pose = {{length, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
    return true;
  }
  double length;
};

/// A slide in the plane whose second origin moves along the x axis of the first as a function of time says.
constexpr Parameter driven_parameters[] = {{.name = "travel",
                                            .kind = ParameterKind::function,
                                            .unit = "m",
                                            .summary = "Position of the second origin along the first x axis."}};
struct Driven final : Joint {
  explicit Driven(const Parameters& p) : travel(p.function("travel")) {}
  void declare(JointLayout& layout) const override { layout.constraint_rows = 1; }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const Gap gap(in);
    const TimeValue wanted = travel.at(in.t);
    const Vector3d x = rotation(*in.a).col(0), turned(-x[1], x[0], 0.0);
    const double w = in.a->angular_velocity[2];
    rows.phi[0] = x.dot(gap.d) - wanted.value;
    for (int i = 0; i < 2; ++i) {
      rows.jacobian[static_cast<std::size_t>(i)] = -x[i];
      rows.jacobian[static_cast<std::size_t>(6 + i)] = x[i];
    }
    rows.jacobian[5] = turned.dot(gap.d);
    rows.nu[0] = wanted.rate;
    rows.gamma[0] = wanted.acceleration + w * w * x.dot(gap.d) - 2.0 * w * turned.dot(gap.rate);
  }
  TimeFunction travel;
};

/// A spring and a damper one behind the other (Maxwell): force k (d - z), z' = (d - z)/tau; tau down to a microsecond.
constexpr Parameter maxwell_parameters[] = {
    {.name = "stiffness", .unit = "N/m", .default_value = 1e6, .minimum = 0.0, .summary = "Of the spring."},
    {.name = "relaxation",
     .unit = "s",
     .default_value = 1e-6,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Time."}};
struct Maxwell final : Joint {
  explicit Maxwell(const Parameters& p) : stiffness(p.number("stiffness")), relaxation(p.number("relaxation")) {}
  void declare(JointLayout& layout) const override {
    layout.forces = 1;
    layout.internal_variables = 3;
    layout.analytic_derivatives = 1;
  }
  void initialize(const JointInput& in, Span<double> z, Span<double>) const override {
    for (std::size_t i = 0; i < 3; ++i) z[i] = in.b->position[i] - in.a->position[i];
  }
  void apply(const JointInput& in, JointForces& out) const override {
    const Vector3d z(in.internal[0], in.internal[1], in.internal[2]);
    const Vector3d d = vector3(in.b->position) - vector3(in.a->position), force = -stiffness * (d - z);
    // At the point of b: the moment on a makes the pair balance.
    add_force(in, out, vector3(in.b->position), force);
    out.potential = 0.5 * stiffness * (d - z).squaredNorm();
    for (std::size_t i = 0; i < 3; ++i) {
      out.internal_rate[i] = (d[static_cast<int>(i)] - z[static_cast<int>(i)]) / relaxation;
    }
    if (out.derivatives.empty()) return;
    const std::size_t width = 27;
    const auto cross = [](const Vector3d& v) {
      Eigen::Matrix3d m;
      m << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0;
      return m;
    };
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    const auto put = [&](std::size_t row, std::size_t column, const Eigen::Matrix3d& m) {
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
          out.derivatives[(row + r) * width + column + c] = m(static_cast<int>(r), static_cast<int>(c));
        }
      }
    };
    const Eigen::Matrix3d k = stiffness * one;
    put(6, 0, k), put(6, 6, -k), put(6, 24, k);
    put(0, 0, -k), put(0, 6, k), put(0, 24, -k);
    // Moment on a: -d x F with F = -k (d - z), so by d: [F]x + k [d]x, by z: -k [d]x.
    const Eigen::Matrix3d by_d = cross(force) + stiffness * cross(d);
    put(3, 0, -by_d), put(3, 6, by_d), put(3, 24, -stiffness * cross(d));
    put(12, 0, -one / relaxation), put(12, 6, one / relaxation), put(12, 24, -one / relaxation);
  }
  double stiffness, relaxation;
};

/// Two plates that are pressed together and rub along x, in the plane: the law's internal variables are the joint's.
constexpr Parameter plates_parameters[] = {
    {.name = "load", .unit = "N", .default_value = 10.0, .minimum = 0.0, .summary = "Presses the plates together."},
    {.name = "friction", .kind = ParameterKind::friction_law, .default_value = optional, .summary = "Between them."}};
struct Plates final : Joint {
  explicit Plates(const Parameters& p)
      : load(p.number("load")), friction(p.friction_law("friction")), variables(friction.internal_variables()) {}
  void declare(JointLayout& layout) const override {
    layout.forces = 1;
    layout.internal_variables = variables;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    // Rubs half way between the origins, so that the moments below go with what the slip says of the turns.
    const double height = in.b->position[1] - in.a->position[1];
    const double turning = in.a->angular_velocity[2] + in.b->angular_velocity[2];
    const double slip = in.b->velocity[0] - in.a->velocity[0] + 0.5 * height * turning;
    const FrictionForce f = friction.evaluate({load, slip, in.internal}, out.internal_rate);
    out.wrench_b[0] = f.tangential;
    out.wrench_a[0] = -f.tangential;
    out.wrench_b[5] = 0.5 * height * f.tangential;
    out.wrench_a[5] = 0.5 * height * f.tangential;
  }
  double load;
  FrictionLawRef friction;
  int variables;
};

/// A buffer at a distance: pushes when the origins come closer, counts its contacts, and keeps the deepest one.
constexpr Channel buffer_fields[] = {{"count", "1"}};
constexpr Event buffer_events[] = {{"touch", Crossing::rising, 1, buffer_fields}, {"part", Crossing::falling, 0, {}}};
constexpr Channel buffer_channels[] = {{"deepest", "m"}};
constexpr Parameter buffer_parameters[] = {
    {.name = "stiffness", .unit = "N/m", .default_value = 1e5, .minimum = 0.0, .summary = "Of the buffer."},
    {.name = "reach", .unit = "m", .default_value = 0.45, .minimum = 0.0, .summary = "Distance at which it begins."}};
struct Buffer final : Joint {
  explicit Buffer(const Parameters& p) : stiffness(p.number("stiffness")), reach(p.number("reach")) {}
  void declare(JointLayout& layout) const override {
    layout.forces = 1;
    layout.history = 2;
    layout.events = buffer_events;
    layout.channels = buffer_channels;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    const Gap gap(in);
    const double depth = reach - gap.length;
    if (depth <= 0.0) return;
    add_force(in, out, vector3(in.b->position), stiffness * depth * gap.along);
    out.potential = 0.5 * stiffness * depth * depth;
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    const Gap gap(in);
    g[0] = g[1] = reach - gap.length;
    rate[0] = rate[1] = -gap.speed;
  }
  void on_event(int index, const JointInput&, Span<double>, Span<double> history, Span<double> fields) const override {
    if (index == 0) fields[0] = ++history[0];
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    history[1] = std::max(history[1], reach - Gap(in).length);
  }
  void observe(const JointInput& in, Span<const double>, Span<double> channels) const override {
    channels[0] = in.history[1];
  }
  double stiffness, reach;
};

/// A spring that yields: force k (L - h) within +-limit on the line of the origins; h follows when a step is accepted.
constexpr Parameter yielding_parameters[] = {
    {.name = "stiffness", .unit = "N/m", .default_value = 1e5, .minimum = 0.0, .open = Open::minimum, .summary = "k."},
    {.name = "limit", .unit = "N", .default_value = 10.0, .minimum = 0.0, .open = Open::minimum, .summary = "Yields."}};
struct Yielding final : Joint {
  explicit Yielding(const Parameters& p) : stiffness(p.number("stiffness")), limit(p.number("limit")) {}
  void declare(JointLayout& layout) const override {
    layout.forces = 1;
    layout.history = 1;
  }
  void initialize(const JointInput& in, Span<double>, Span<double> history) const override {
    history[0] = Gap(in).length;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    const Gap gap(in);
    const double force = std::clamp(stiffness * (gap.length - in.history[0]), -limit, limit);
    add_force(in, out, vector3(in.b->position), -force * gap.along);
    out.potential = 0.5 * force * force / stiffness;
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    const double length = Gap(in).length, most = limit / stiffness;
    history[0] = std::clamp(history[0], length - most, length + most);
  }
  double stiffness, limit;
};

/// F = K delta^n with the damping of a restitution near 1; K is in N/m^n.
constexpr Parameter power_parameters[] = {
    {.name = "stiffness", .unit = "N/m^exponent", .minimum = 0.0, .open = Open::minimum, .summary = "K."},
    {.name = "exponent", .default_value = 1.5, .minimum = 1.0, .maximum = 3.0, .summary = "n."},
    {.name = "loss",
     .default_value = 0.1,
     .minimum = 0.0,
     .maximum = 0.6,
     .summary = "Damping at the approach speed."}};
struct Power final : ContactLaw {
  Power(const Parameters& p, const ContactPair&)
      : k(p.number("stiffness")), n(p.number("exponent")), loss(p.number("loss")) {}
  ContactForce evaluate(const ContactState& s) const override {
    const double elastic = k * std::pow(s.penetration, n), potential = elastic * s.penetration / (n + 1.0);
    const double damping = s.approach_speed > 0.0 ? loss / s.approach_speed : 0.0, factor = 1.0 + damping * s.rate;
    if (factor <= 0.0) return {0.0, 0.0, 0.0, potential};
    return {elastic * factor, n * elastic / s.penetration * factor, elastic * damping, potential};
  }
  double k, n, loss;
};

/// The Dahl model: a bristle of stiffness s0 that yields at mu times the load.
constexpr Parameter dahl_parameters[] = {
    {.name = "mu", .default_value = 0.2, .minimum = 0.0, .open = Open::minimum, .summary = "Coefficient."},
    {.name = "bristle", .unit = "1/m", .default_value = 1e5, .minimum = 0.0, .open = Open::minimum, .summary = "s0."}};
struct Dahl final : FrictionLaw {
  explicit Dahl(const Parameters& p) : mu(p.number("mu")), bristle(p.number("bristle")) {}
  int internal_variables() const override { return 1; }
  FrictionForce evaluate(const FrictionState& s, Span<double> rate) const override {
    rate[0] = s.slip_speed - bristle / mu * std::abs(s.slip_speed) * s.internal[0];
    return {-bristle * s.internal[0] * s.normal_force, -bristle * s.internal[0], 0.0};
  }
  double mu, bristle;
};

/// One implicit step; theta 1/2: with the accelerations of both ends, of order 2; theta 1: of the new end, order 1.
template <int twice_theta>
struct Theta : Integrator {
  explicit Theta(const Parameters&) {}
  void declare(IntegratorLayout& layout) const override {
    const Sizes& n = layout.sizes;
    layout.memory = n.nz;
    layout.scratch = n.nq + 4 * n.nv + n.nz;
    layout.order = twice_theta == 1 ? 2 : 1;
    layout.error_estimate = 1;
    layout.error_order = 2;
  }
  void restart(StateView& state, StageSolver& solver) const override { solver.accelerate(state, state.memory); }
  Attempt attempt(double dt, StateView& to, Span<double> scratch, StageSolver& solver) const override {
    const std::size_t nq = to.q.size, nv = to.v.size, nz = to.z.size;
    const Span<double> q = scratch.part(0, nq), v = scratch.part(nq, nv), d = scratch.part(nq + nv, nv),
                       z = scratch.part(nq + 2 * nv, nz), first = scratch.part(nq + 2 * nv + nz, nv),
                       before = scratch.part(nq + 3 * nv + nz, nv);
    constexpr double fresh = 0.5 * twice_theta, old = 1.0 - fresh;
    const double b = fresh * dt;
    std::copy(to.q.begin(), to.q.end(), q.begin());
    for (std::size_t i = 0; i < nv; ++i) {
      before[i] = to.v[i];
      first[i] = to.v[i] + dt * to.a[i];
      v[i] = to.v[i] + old * dt * to.a[i];
      d[i] = old * dt * to.v[i] + b * v[i];
    }
    for (std::size_t i = 0; i < nz; ++i) z[i] = to.z[i] + old * dt * to.memory[i];
    const Stage stage{*to.t + dt, q, d, v, z, b * b, b, b, ConstraintLevel::position};
    if (solver.solve(stage, to).converged == 0) return {0, 0.0};
    solver.project_velocity(to);
    solver.accelerate(to, to.memory);
    // Against an explicit step in velocity, against the mean of the ends in position: both of second order.
    for (std::size_t i = 0; i < nv; ++i) {
      d[i] = 0.5 * dt * (to.v[i] - before[i]);
      v[i] = to.v[i] - first[i];
    }
    const double error = solver.estimates() ? solver.error_norm(d, v) : 0.0;
    return {1, error};
  }
};

Status publish_honest(const Host* host, Manifest* manifest) noexcept {
  static const Component components[] = {
      joint<Spring>({.name = "stiff-spring", .summary = "Stiff.", .parameters = spring_parameters}),
      joint<Spring>({.name = "small-spring", .summary = "Micrometres.", .parameters = small_spring_parameters}),
      joint<Spring>({.name = "large-spring", .summary = "Kilometres.", .parameters = large_spring_parameters}),
      joint<Either>(
          {.name = "either-spring", .space = Space::planar, .summary = "Either.", .parameters = either_parameters}),
      joint<Rope>({.name = "long-rope", .summary = "A kilometre.", .parameters = rope_parameters}),
      joint<Rope>({.name = "short-hair", .summary = "A micrometre.", .parameters = hair_parameters}),
      joint<Driven>({.name = "driven-slide",
                     .space = Space::planar,
                     .summary = "Follows time.",
                     .parameters = driven_parameters}),
      joint<Maxwell>({.name = "maxwell-element", .summary = "Relaxes.", .parameters = maxwell_parameters}),
      joint<Plates>(
          {.name = "rubbing-plates", .space = Space::planar, .summary = "Rubs.", .parameters = plates_parameters}),
      joint<Buffer>({.name = "end-buffer", .summary = "Has events.", .parameters = buffer_parameters}),
      joint<Yielding>({.name = "yielding-spring", .summary = "Plastic.", .parameters = yielding_parameters}),
      contact_law<Power>({.name = "power-law", .summary = "Any exponent.", .parameters = power_parameters}),
      friction_law<Dahl>({.name = "dahl-bristle", .summary = "A bristle.", .parameters = dahl_parameters}),
      integrator<Theta<1>>({.name = "mean-of-ends", .summary = "Second order, with an estimate."}),
      integrator<Theta<2>>({.name = "new-end", .summary = "First order, with an estimate."})};
  return publish(*host, *manifest, "honest", "1", components);
}

}  // namespace

Registry honest_registry() {
  Registry registry = Registry::with_builtins();
  registry.add(publish_honest, "honest");
  return registry;
}

}  // namespace freeplay::test
