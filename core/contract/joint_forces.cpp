// Rules of apply(): balance, energy and derivatives.
#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "component/joint_roles.h"
#include "contract/joint_contract.h"
#include "contract/joint_words.h"
#include "contract/slope.h"
#include "freeplay/eigen.h"

namespace freeplay {
namespace {

using Eigen::Vector3d;

double power(const ProbedForces& f, const MarkerPair& markers) {
  const Twelve v = twists(markers);
  double sum = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i) sum += f.wrench[i] * v[i];
  return sum;
}
double power_size(const ProbedForces& f, const MarkerPair& markers) {
  const Twelve v = twists(markers);
  double sum = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i) sum += std::abs(f.wrench[i] * v[i]);
  return sum;
}

/// The wrenches of a planar joint are what the host reads of them.
void keep_moving(Space space, std::vector<double>& wrench) {
  const std::vector<std::size_t> kept = moving_components(space);
  for (std::size_t i = 0; i < wrench.size(); ++i) {
    if (std::find(kept.begin(), kept.end(), i) == kept.end()) wrench[i] = 0.0;
  }
}

void check_balance(const JointProbe& probe, const JointMoment& moment, ProbedForces f, Findings& findings) {
  keep_moving(probe.space(), f.wrench);
  const Eigen::Map<const Vector3d> fa(&f.wrench[0]), ma(&f.wrench[3]), fb(&f.wrench[6]), mb(&f.wrench[9]);
  const Vector3d pa = vector3(moment.markers.a.position), pb = vector3(moment.markers.b.position);
  const double force = fa.norm() + fb.norm();
  const double torque = force * (pa.norm() + pb.norm()) + ma.norm() + mb.norm();
  const Vector3d resultant = fa + fb, moment_at_origin = pa.cross(fa) + ma + pb.cross(fb) + mb;
  // Arms may be found as differences of radii, which loses a few digits.
  findings.expect("balance", resultant.norm() <= 1e-12 * force, [&] {
    return fmt::format("the forces on a and b leave a resultant of {:.3g} N (force {:.3g} N), {}", resultant.norm(),
                       force, words_of(moment));
  });
  findings.expect("balance", moment_at_origin.norm() <= 1e-10 * torque, [&] {
    return fmt::format("the forces and moments on a and b leave a moment of {:.3g} N m about the world's origin, {}",
                       moment_at_origin.norm(), words_of(moment));
  });
}

/// An upper bound of the speeds that points between the origins of two markers have against each other [m/s].
double fastest(const MarkerPair& markers) {
  const MarkerKinematics &a = markers.a, &b = markers.b;
  const double turning = vector3(a.angular_velocity).norm() + vector3(b.angular_velocity).norm();
  return vector3(a.velocity).norm() + vector3(b.velocity).norm() +
         turning * (vector3(b.position) - vector3(a.position)).norm();
}

/// What the forces would do on the way from the world's origin, and the moments on a turn by 1 rad [J].
double work_of_positions(const ProbedForces& f, const MarkerPair& markers) {
  double force = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < f.wrench.size(); ++i) (i % 6 < 3 ? force : moment) += std::abs(f.wrench[i]);
  return force * (vector3(markers.a.position).norm() + vector3(markers.b.position).norm()) + moment;
}

/// Work done on the bodies comes out of the stored energy: P + dU/dt <= 0, the difference is dissipated.
struct EnergyBalance {
  double done = 0.0, stored = 0.0, error = 0.0, largest = 0.0;  ///< [W]; `error` of `stored`, `largest` power
  // The speed of the surfaces and that of the point of action differ by a penetration times an angular velocity.
  bool holds() const { return done + stored <= 1e-4 * largest + 20.0 * error; }
};
EnergyBalance energy_balance(const JointProbe& probe, const JointMoment& moment, const ProbedForces& f) {
  const MarkerPath path{moment.markers, {}};
  // Forward in time: at a yield point or a stop, what has been and what comes differ. The steps are shorter than the
  // way from one yield point to the other, at which the energy is the same.
  const double reach = 2e-5 / std::max(1.0, fastest(moment.markers));
  const auto forces_at = [&](double x) {
    JointMoment there = moment;
    there.markers = path.at(x);
    return probe.forces(there);
  };
  const auto potential = [&](double x) {
    const ProbedForces values = forces_at(x);
    return values.wrench.empty() ? std::vector<double>{} : std::vector<double>{values.potential};
  };
  // The rounding of the positions and angles counts as the forces make it count: those at rest are the gradients of the
  // energy also where a damper cancels what it pulls with.
  JointMoment rest = moment;
  rest.markers = with_twists(moment.markers, {});
  const double rounded =
      std::max({work_of_positions(f, moment.markers), work_of_positions(probe.forces(rest), moment.markers),
                work_of_positions(forces_at(reach), moment.markers)});
  const Slope stored = slope(potential, reach, Side::above, {rounded});
  if (stored.value.empty() || f.wrench.empty()) return {};
  return {power(f, moment.markers), stored.value[0], stored.error[0], power_size(f, moment.markers)};
}

void check_energy(const JointProbe& probe, const JointMoment& moment, const ProbedForces& f, Findings& findings) {
  // Internal variables store energy that no joint reports; over a cycle it does not count (check_cycle).
  if (probe.layout().internal_variables > 0) return;
  EnergyBalance balance = energy_balance(probe, moment, f);
  if (!balance.holds() && probe.layout().history > 0) {
    // A history from elsewhere may be one that no step leaves here, such as a force beyond the yield point.
    JointMoment accepted = moment;
    probe.commit(accepted);
    balance = energy_balance(probe, accepted, probe.forces(accepted));
  }
  findings.expect("energy", balance.holds(), [&] {
    return fmt::format(
        "the wrenches do work at {:.6g} W while the stored energy changes at {:.6g} W (error {:.3g} W, "
        "largest power {:.6g} W), {}",
        balance.done, balance.stored, balance.error, balance.largest, words_of(moment));
  });
  if (std::isnan(f.potential_rate)) return;
  const EnergyBalance here = energy_balance(probe, moment, f);
  const double off = std::abs(f.potential_rate - here.stored);
  findings.expect("potential-rate", off <= 1e-4 * std::max(here.largest, std::abs(here.stored)) + 20.0 * here.error,
                  [&] {
                    return fmt::format(
                        "potential_rate is {:.6g} W while the stored energy changes at {:.6g} W (error {:.3g} W), {}",
                        f.potential_rate, here.stored, here.error, words_of(moment));
                  });
}

/// Flat list of what the derivatives are of: wrenches and z'.
std::vector<double> outputs(const ProbedForces& f) {
  std::vector<double> all = f.wrench;
  all.insert(all.end(), f.z_rate.begin(), f.z_rate.end());
  return all;
}

class DerivativeCheck {
 public:
  DerivativeCheck(const JointProbe& probe, const JointMoment& moment, const ProbedForces& f, Findings& findings)
      : probe_(probe), moment_(moment), given_(f.derivatives), nz_(f.z_rate.size()), findings_(findings) {
    const std::vector<double> all = outputs(f);
    for (std::size_t r = 0; r < all.size(); ++r) {
      given_size_[group(r)] = std::max(given_size_[group(r)], std::abs(all[r]));
    }
  }

  void run() {
    for (const std::size_t i : moving_components(probe_.space())) {
      column(i, i % 6 < 3 ? largest_shift() : 0.02, [&](double x, JointMoment& there) {
        Twelve by{};
        by[i] = x;
        there.markers = moved(moment_.markers, by);
      });
      column(12 + i, 0.5, [&](double x, JointMoment& there) {
        Twelve v = twists(moment_.markers);
        v[i] += x;
        there.markers = with_twists(moment_.markers, v);
      });
    }
    for (std::size_t k = 0; k < nz_; ++k) {
      column(24 + k, 0.1, [&](double x, JointMoment& there) { there.z[k] += x; });
    }
  }

 private:
  /// Beyond the end of its play, or of a contact, a joint is another one: it has no force on one side, and on the other
  /// it may have none.
  double largest_shift() const {
    const JointLayout& layout = probe_.layout();
    const double play = layout.clearance;
    const MarkerPair& m = moment_.markers;
    double beyond = play > 0.0 ? std::abs((vector3(m.b.position) - vector3(m.a.position)).norm() - play) : unbounded;
    const std::vector<double> g = probe_.events(moment_).g;
    for (std::size_t i = 0; i < g.size(); ++i) {
      const bool counts = play > 0.0 || event_role(layout, i) != EventRole::none;
      if (counts && std::abs(g[i]) > 1e-9 * play) beyond = std::min(beyond, std::abs(g[i]));
    }
    return std::min(0.02, std::max(0.2 * beyond, 1e-6 * play));
  }
  /// Sizes of what outputs are differences of. A moment is one of products of forces and arms, also where it is zero as
  /// the force goes through the origin.
  std::vector<double> products() const {
    const MarkerPair& m = moment_.markers;
    const double arm =
        (vector3(m.b.position) - vector3(m.a.position)).norm() + std::max(probe_.layout().clearance, 0.0);
    std::vector<double> result(12 + nz_);
    for (std::size_t r = 0; r < 12; ++r)
      if (group(r) == 1) result[r] = given_size_[0] * arm;
    return result;
  }
  /// The same with what forces change by on the way from the world's origin: the rounding of places counts by it.
  std::vector<double> rounded_places() const {
    const double far = vector3(moment_.markers.a.position).norm() + vector3(moment_.markers.b.position).norm();
    std::vector<double> result = products();
    for (std::size_t r = 0; r < result.size(); ++r) {
      for (const std::size_t i : moving_components(probe_.space())) {
        if (i % 6 < 3) result[r] = std::max(result[r], far * std::abs(given_[r * (24 + nz_) + i]));
      }
    }
    return result;
  }
  /// `largest`: first step tried, in m, rad, m/s or rad/s.
  template <class Move>
  void column(std::size_t c, double largest, Move&& move) {
    const Slope d = slope(
        [&](double x) {
          JointMoment there = moment_;
          move(x, there);
          return outputs(probe_.forces(there));
        },
        largest, Side::both, c < 12 ? rounded_places() : products());
    const std::size_t width = 24 + nz_;
    double size[3] = {0.0, 0.0, 0.0};
    for (std::size_t r = 0; r < d.value.size(); ++r) size[group(r)] = std::max(size[group(r)], std::abs(d.value[r]));
    for (std::size_t r = 0; r < d.value.size(); ++r) {
      if (r < 12 && !moves(r)) continue;
      const double given = given_[r * width + c];
      // A derivative that a joint finds by differences itself may be off by 1e-8 of the force, where it should be zero.
      const double scale = std::max(10.0 * size[group(r)], 1e-2 * given_size_[group(r)]);
      findings_.expect("derivatives", agrees(given, d.value[r], d.error[r], scale), [&] {
        return fmt::format("{} by {} (row {}, column {}) is {:.9g}, differences give {:.9g}, {}", force_word(r),
                           input_word(c), r, c, given, d.value[r], words_of(moment_));
      });
    }
  }
  // Forces, moments and rates differ in unit.
  static std::size_t group(std::size_t row) { return row >= 12 ? 2u : row % 6 < 3 ? 0u : 1u; }
  bool moves(std::size_t row) const {
    const std::vector<std::size_t> kept = moving_components(probe_.space());
    return std::find(kept.begin(), kept.end(), row) != kept.end();
  }

  const JointProbe& probe_;
  const JointMoment& moment_;
  const std::vector<double>& given_;
  std::size_t nz_;
  double given_size_[3] = {0.0, 0.0, 0.0};
  Findings& findings_;
};

}  // namespace

void check_forces(const JointProbe& probe, bool passive, const std::vector<JointMoment>& moments, Findings& findings) {
  for (const JointMoment& fresh : moments) {
    JointMoment moment = fresh;
    if (probe.layout().coordinate != Coordinate::none) moment.coordinate = probe.coordinate(moment).value;
    const ProbedForces f = probe.forces(moment, probe.layout().analytic_derivatives != 0);
    if (f.wrench.empty()) return;
    if (probe.layout().forces == 0) {
      const bool silent = std::all_of(f.wrench.begin(), f.wrench.end(), [](double x) { return x == 0.0; });
      findings.expect("declares-sanely", silent,
                      [&] { return "apply() acts, but `forces` is zero, " + words_of(moment); });
      continue;
    }
    check_balance(probe, moment, f, findings);
    if (passive) check_energy(probe, moment, f, findings);
    if (probe.layout().analytic_derivatives != 0) DerivativeCheck(probe, moment, f, findings).run();
    const ProbedForces bare = probe.forces(moment);
    findings.expect("unused-derivatives", same_bits(outputs(bare), outputs(f)),
                    [&] { return "the forces depend on whether derivatives are asked for, " + words_of(moment); });
  }
}

}  // namespace freeplay
