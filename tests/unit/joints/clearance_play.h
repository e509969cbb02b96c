// A revolute joint with play on its own: laws, radii, and its share of the state.
#pragma once

#include <array>

#include "joint_probe.h"

namespace freeplay::test {
// Base set: steel pin in a bearing of 5 mm with 0.1 mm of play. K of Hertz, chi = 3(1 - 0.81)/4.
inline constexpr double K = 75062104464.41812, chi = 0.1425, bearing_radius = 0.005, journal_radius = 0.0049, c = 1e-4;

inline ContactForce lankarani_nikravesh(const ContactState& s) {
  const double elastic = K * s.penetration * std::sqrt(s.penetration),
               loss = s.approach_speed > 0.0 ? chi / s.approach_speed : 0.0;
  const double factor = 1.0 + loss * s.rate, potential = 0.4 * elastic * s.penetration;
  if (factor <= 0.0) return {0.0, 0.0, 0.0, potential};
  return {elastic * factor, 1.5 * elastic / s.penetration * factor, elastic * loss, potential};
}
inline FrictionForce ramp(const FrictionState& s, Span<double>) {
  const double mu = 0.1, v0 = 1e-4, v1 = 1e-3, speed = std::abs(s.slip_speed);
  if (speed <= v0) return {};
  const double share = std::copysign(mu * std::min(1.0, (speed - v0) / (v1 - v0)), s.slip_speed);
  return {-share * s.normal_force, -share, speed < v1 ? -mu * s.normal_force / (v1 - v0) : 0.0};
}
/// A bristle z of relative stiffness 2e3 1/m: z' = v - 5e3 |v| z, force -F_N (2e3 z + 0.3 z').
inline FrictionForce bristle(const FrictionState& s, Span<double> rate) {
  const double z = s.internal[0], speed = std::abs(s.slip_speed);
  rate[0] = s.slip_speed - 5e3 * speed * z;
  const double per_force = -(2e3 * z + 0.3 * rate[0]);
  return {per_force * s.normal_force, per_force, -0.3 * (1.0 - std::copysign(5e3, s.slip_speed) * z) * s.normal_force};
}

inline const Component& row() { return joint_row("revolute-clearance"); }

inline ParameterStub radii(std::map<std::string, double> numbers = {{"bearing_radius", bearing_radius},
                                                                    {"journal_radius", journal_radius}}) {
  ParameterStub stub(row());
  for (const auto& [name, value] : numbers) stub.numbers["clearance." + name] = value;
  stub.contact = std::make_shared<FunctionContact>(lankarani_nikravesh);
  return stub;
}
inline ParameterStub with_friction() {
  ParameterStub stub = radii();
  stub.friction = std::make_shared<FunctionFriction>(ramp);
  return stub;
}
inline ParameterStub with_bristle() {
  ParameterStub stub = radii();
  stub.friction = std::make_shared<FunctionFriction>(bristle, 1);
  return stub;
}

/// A clearance joint with its share of z and h.
class Play {
 public:
  explicit Play(const ParameterStub& stub) : contact_(stub.contact), friction_(stub.friction), joint_(row(), stub) {
    joint_.call(&abi::JointTable::declare, &layout);
    z.resize(static_cast<std::size_t>(layout.internal_variables));
    h.resize(static_cast<std::size_t>(layout.history));
  }
  JointInput in(double t = 0.0) const { return input(t, a, b, {z.data(), z.size()}, {h.data(), h.size()}); }
  Span<double> zs() { return {z.data(), z.size()}; }
  Span<double> hs() { return {h.data(), h.size()}; }

  void initialize() {
    const JointInput i = in();
    joint_.call(&abi::JointTable::initialize, &i, zs(), hs());
  }
  void begin_step(double dt, MarkerAccelerations acc = {}, double t = 0.0) {
    const JointInput i = in(t);
    joint_.call(&abi::JointTable::begin_step, &i, &acc, dt, hs());
  }
  std::array<double, 8> on_event(int index, double t) {
    std::array<double, 8> fields{};
    const JointInput i = in(t);
    joint_.call(&abi::JointTable::on_event, index, &i, zs(), hs(), Span<double>(fields.data(), 8));
    return fields;
  }
  void commit(double t) {
    const JointInput i = in(t);
    joint_.call(&abi::JointTable::commit, &i, Span<const double>(), hs());
  }
  struct ProbedEvents {
    double g[2], rate[2];
  };
  ProbedEvents events() const {
    ProbedEvents e{};
    const JointInput i = in();
    joint_.call(&abi::JointTable::events, &i, Span<double>(e.g), Span<double>(e.rate));
    return e;
  }
  std::array<double, 8> observe() const {
    std::array<double, 8> channels{};
    const JointInput i = in();
    joint_.call(&abi::JointTable::observe, &i, Span<const double>(), Span<double>(channels.data(), 8));
    return channels;
  }
  InitialOffset offset(double fx, double fy) const {
    InitialOffset out{};
    const double reaction[] = {fx, fy, 0.0};
    joint_.call(&abi::JointTable::initial_offset, Span<const double>(reaction), &out);
    return out;
  }
  /// [wrench a, wrench b, z'] and, if asked, their derivatives.
  std::vector<double> apply(std::vector<double>* derivatives = nullptr) const {
    std::vector<double> rate(z.size());
    JointForces f{};
    f.internal_rate = {rate.data(), rate.size()};
    if (derivatives) {
      derivatives->assign((12 + z.size()) * (24 + z.size()), 0.0);
      f.derivatives = {derivatives->data(), derivatives->size()};
    }
    const JointInput i = in();
    joint_.call(&abi::JointTable::apply, &i, &f);
    std::vector<double> all(f.wrench_a, f.wrench_a + 6);
    all.insert(all.end(), f.wrench_b, f.wrench_b + 6);
    all.insert(all.end(), rate.begin(), rate.end());
    potential = f.potential;
    return all;
  }
  /// Into contact with the approach speed v0 by a located event at the present markers.
  void touch(double v0) {
    const MarkerKinematics kept_a = a, kept_b = b;
    a = planar_marker(0.0, 0.0, 0.0);
    b = planar_marker(c, 0.0, 0.0, v0);
    on_event(0, 0.0);
    a = kept_a;
    b = kept_b;
  }

  JointLayout layout;
  MarkerKinematics a = planar_marker(0.0, 0.0, 0.0), b = planar_marker(0.0, 0.0, 0.0);
  std::vector<double> z, h;
  mutable double potential = 0.0;

 private:
  // The laws outlive the joint, as they do in a model.
  std::shared_ptr<ContactLaw> contact_;
  std::shared_ptr<FrictionLaw> friction_;
  JointInstance joint_;
};

}  // namespace freeplay::test
