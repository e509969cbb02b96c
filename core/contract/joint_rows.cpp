// Rules of constraint rows and of the coordinate.
#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "base/angle.h"
#include "contract/joint_contract.h"
#include "contract/joint_words.h"
#include "contract/planar_declaration.h"
#include "contract/slope.h"
#include "freeplay/eigen.h"

namespace freeplay {
namespace {

/// A row of a joint seen from outside: constraint rows first, then the coordinate.
struct AllRows {
  std::vector<double> value, jacobian, nu, gamma;
  std::size_t size() const { return value.size(); }
  double times(std::size_t row, const Twelve& v) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < 12; ++i) sum += jacobian[12 * row + i] * v[i];
    return sum;
  }
};

AllRows all_rows(const JointProbe& probe, const JointMoment& moment) {
  ProbedRows rows = probe.rows(moment);
  AllRows all{rows.phi, rows.jacobian, rows.nu, rows.gamma};
  if (probe.layout().coordinate == Coordinate::none) return all;
  const ProbedCoordinate c = probe.coordinate(moment);
  if (c.jacobian.empty()) return all;
  // s'' = G dV/dt + bias: a row with gamma = -bias.
  all.value.push_back(c.value);
  all.jacobian.insert(all.jacobian.end(), c.jacobian.begin(), c.jacobian.end());
  all.nu.push_back(0.0);
  all.gamma.push_back(-c.bias);
  return all;
}

/// Checks one moment; knows which rows are constraints and which is the coordinate.
class RowCheck {
 public:
  RowCheck(const JointProbe& probe, const JointMoment& moment, Findings& findings)
      : probe_(probe), moment_(moment), findings_(findings), here_(all_rows(probe, moment)) {
    moment_.coordinate = probe.layout().coordinate == Coordinate::none || here_.size() == 0 ? 0.0 : here_.value.back();
  }

  void jacobian() {
    for (const std::size_t component : moving_components(probe_.space())) {
      const auto along = [&](double x) {
        Twelve by{};
        by[component] = x;
        JointMoment there = moment_;
        there.markers = moved(moment_.markers, by);
        return turned_near(all_rows(probe_, there).value);
      };
      const Slope d = slope(along, 0.05, Side::both, sizes_of_terms());
      for (std::size_t r = 0; r < std::min(here_.size(), d.value.size()); ++r) {
        const double given = here_.jacobian[12 * r + component];
        findings_.expect(name(r, "jacobian", "coordinate"),
                         agrees(given, d.value[r], d.error[r], std::max(1.0, std::abs(given))), [&] {
                           return fmt::format("{}, {} (column {}) is {:.9g}, differences give {:.9g}, {}", row_word(r),
                                              twist_word(component), component, given, d.value[r], words_of(moment_));
                         });
      }
    }
  }

  void partial_time() {
    const Slope d = slope(
        [&](double x) {
          JointMoment there = moment_;
          there.t += x;
          return turned_near(all_rows(probe_, there).value);
        },
        0.05, Side::both, sizes_of_terms());
    for (std::size_t r = 0; r < std::min(here_.size(), d.value.size()); ++r) {
      findings_.expect(name(r, "nu", "coordinate"),
                       agrees(here_.nu[r], -d.value[r], d.error[r], std::max(1.0, std::abs(here_.nu[r]))), [&] {
                         return fmt::format("nu of {} is {:.9g}, differences in time give {:.9g}, {}", row_word(r),
                                            here_.nu[r], -d.value[r], words_of(moment_));
                       });
    }
  }

  /// d(G V - nu)/dt = G dV/dt - gamma along an accelerated motion.
  void gamma(const Twelve& acceleration) {
    const MarkerPath path{moment_.markers, acceleration};
    const Slope d = slope(
        [&](double x) {
          JointMoment there = moment_;
          there.t += x;
          there.markers = path.at(x);
          const AllRows rows = all_rows(probe_, there);
          std::vector<double> rate(rows.size());
          for (std::size_t r = 0; r < rate.size(); ++r) rate[r] = rows.times(r, twists(there.markers)) - rows.nu[r];
          return rate;
        },
        0.02, Side::both, sizes_of_rates());
    for (std::size_t r = 0; r < std::min(here_.size(), d.value.size()); ++r) {
      const double given = here_.times(r, acceleration) - here_.gamma[r];
      // Accelerations of 3 m/s^2 and speeds of 1.5 m/s: terms of order 10, more where a row is curved.
      const double scale = std::max({10.0, std::abs(given), std::abs(here_.gamma[r])});
      findings_.expect(name(r, "gamma", "coordinate-bias"), agrees(given, d.value[r], d.error[r], scale), [&] {
        return fmt::format("{} is {:.9g}, differences of G V - nu along an accelerated motion give {:.9g}, {}",
                           gamma_word(r), here_.gamma[r] * gamma_sign(r),
                           (here_.times(r, acceleration) - d.value[r]) * gamma_sign(r), words_of(moment_));
      });
    }
  }

  /// G V = 0 for both markers moving as one rigid body: the pair of forces that a multiplier stands for is balanced.
  /// Rows may stand in the axes of the world, so that this is only so where the constraints hold.
  void balance() {
    if (!close()) return;
    const bool planar = probe_.space() == Space::planar;
    if (planar && probe_.layout().pin != 0) pin();
    for (int motion = 0; motion < 6; ++motion) {
      if (planar && (motion == 2 || motion == 3 || motion == 4)) continue;
      Twelve v{};
      for (const bool second : {false, true}) {
        const MarkerKinematics& m = second ? moment_.markers.b : moment_.markers.a;
        double* twist = v.data() + (second ? 6 : 0);
        twist[motion] = 1.0;
        if (motion < 3) continue;
        const int x = (motion + 1) % 3, y = (motion + 2) % 3;  // e_k x P
        twist[y] = m.position[x];
        twist[x] = -m.position[y];
      }
      for (std::size_t r = 0; r < here_.size(); ++r) {
        const double rate = here_.times(r, v);
        double size = 1.0;
        for (std::size_t i = 0; i < 12; ++i) size += std::abs(here_.jacobian[12 * r + i] * v[i]);
        // Rounding of the terms, and what Newton's rule leaves.
        findings_.expect("constraint-balance", std::abs(rate) <= 1e-12 * size, [&] {
          return fmt::format("{} changes at a rate of {:.3g} when both markers {} as one body, {}", row_word(r), rate,
                             motion < 3 ? "shift" : "turn", words_of(moment_));
        });
      }
    }
  }

  /// Where the rows hold, the origins coincide, and a turn of b about its own changes nothing.
  void pin() {
    const Eigen::Vector3d a = vector3(moment_.markers.a.position), b = vector3(moment_.markers.b.position);
    const double apart = (b - a).head<2>().norm();
    findings_.expect("pin", apart <= 1e-9 * (1.0 + a.norm() + b.norm()), [&] {
      return fmt::format("the rows hold with the origins {:.6g} m apart, {}", apart, words_of(moment_));
    });
    for (std::size_t r = 0; is_row(r) && r < here_.size(); ++r) {
      findings_.expect("pin", std::abs(here_.jacobian[12 * r + 11]) <= 1e-9 * (1.0 + sizes_of_terms()[r]),
                       [&] { return fmt::format("row {} hinders the turn, {}", r, words_of(moment_)); });
    }
  }

  /// Rows and coordinate are those that the layout declares.
  void declared() {
    const JointLayout& layout = probe_.layout();
    if (probe_.space() != Space::planar || here_.size() == 0) return;
    const MarkerKinematics &a = moment_.markers.a, &b = moment_.markers.b;
    const std::vector<DeclaredRow> rows = declared_rows(layout.planar_rows, a, b);
    for (std::size_t r = 0; r < rows.size(); ++r) equals(r, rows[r]);
    if (layout.planar_coordinate == 0 || layout.coordinate == Coordinate::none) return;
    equals(here_.size() - 1, declared_coordinate(layout.coordinate, a, b));
  }

  void independent() {
    const std::size_t n = static_cast<std::size_t>(probe_.layout().constraint_rows);
    if (n == 0 || here_.size() < n) return;
    const std::vector<std::size_t> columns = moving_components(probe_.space());
    Eigen::MatrixXd g(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t r = 0; r < n; ++r) {
      for (std::size_t c = 0; c < columns.size(); ++c) {
        g(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = here_.jacobian[12 * r + columns[c]];
      }
    }
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(g);
    qr.setThreshold(1e-9);
    findings_.expect("rows-independent", qr.rank() == g.rows(),
                     [&] { return fmt::format("{} rows have the rank {}, {}", n, qr.rank(), words_of(moment_)); });
  }

 private:
  const char* name(std::size_t row, const char* of_row, const char* of_coordinate) const {
    return is_row(row) ? of_row : of_coordinate;
  }
  /// A row is made of lengths, or of squares of lengths: what the largest entry of its Jacobian makes of the distances.
  std::vector<double> sizes_of_terms() const {
    const Eigen::Vector3d a = vector3(moment_.markers.a.position), b = vector3(moment_.markers.b.position);
    std::vector<double> sizes(here_.size(), 0.0);
    for (std::size_t r = 0; r < sizes.size(); ++r) {
      for (std::size_t i = 0; i < 12; ++i) sizes[r] = std::max(sizes[r], std::abs(here_.jacobian[12 * r + i]));
      sizes[r] *= 1.0 + a.norm() + b.norm();
    }
    return sizes;
  }

  /// The same for G V: the largest speed of anything at these distances.
  std::vector<double> sizes_of_rates() const {
    std::vector<double> sizes = sizes_of_terms();
    double fastest = 0.0;
    for (const double v : twists(moment_.markers)) fastest = std::max(fastest, std::abs(v));
    for (double& size : sizes) size *= fastest;
    return sizes;
  }

  void equals(std::size_t row, const DeclaredRow& wanted) {
    const double size = 1.0 + sizes_of_terms()[row], fastest = 1.0 + sizes_of_rates()[row];
    double off = here_.value[row] - wanted.value;
    if (wanted.is_angle) off = without_turns(off);
    bool same = std::abs(off) <= 1e-12 * size && std::abs(here_.nu[row]) <= 1e-12 * fastest &&
                std::abs(here_.gamma[row] - wanted.gamma) <= 1e-12 * fastest * fastest;
    for (std::size_t i = 0; i < 12; ++i) {
      same = same && std::abs(here_.jacobian[12 * row + i] - wanted.jacobian[i]) <= 1e-12 * size;
    }
    findings_.expect("planar-rows", same,
                     [&] { return fmt::format("{} is not what is declared, {}", row_word(row), words_of(moment_)); });
  }

  bool is_row(std::size_t row) const { return static_cast<int>(row) < probe_.layout().constraint_rows; }
  std::string row_word(std::size_t row) const { return is_row(row) ? fmt::format("row {}", row) : "the coordinate"; }
  std::string gamma_word(std::size_t row) const {
    return is_row(row) ? fmt::format("gamma of row {}", row) : "the coordinate's bias";
  }
  double gamma_sign(std::size_t row) const { return is_row(row) ? 1.0 : -1.0; }  // bias = -gamma

  /// Moves marker b until phi = 0, by Newton's rule with the rows' own Jacobian.
  bool close() {
    const auto n = static_cast<Eigen::Index>(probe_.layout().constraint_rows);
    for (int iteration = 0; iteration < 30; ++iteration) {
      const ProbedRows rows = probe_.rows(moment_);
      if (static_cast<Eigen::Index>(rows.phi.size()) != n) return false;
      const Eigen::Map<const Eigen::VectorXd> phi(rows.phi.data(), n);
      if (n == 0 || phi.cwiseAbs().maxCoeff() < 1e-14) {
        here_ = all_rows(probe_, moment_);
        return true;
      }
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, 12, Eigen::RowMajor>;
      Eigen::MatrixXd by_b = Eigen::Map<const RowMajor>(rows.jacobian.data(), n, 12).rightCols<6>();
      if (probe_.space() == Space::planar) by_b.middleCols(2, 3).setZero();
      const Eigen::VectorXd change = by_b.completeOrthogonalDecomposition().solve(-phi);
      const Eigen::Vector3d a = vector3(moment_.markers.a.position), b = vector3(moment_.markers.b.position);
      if (change.norm() <= 1e-15 * (1.0 + a.norm() + b.norm())) {  // no nearer place has numbers of its own
        here_ = all_rows(probe_, moment_);
        return true;
      }
      Twelve by{};
      for (std::size_t i = 0; i < 6; ++i) by[6 + i] = change[static_cast<Eigen::Index>(i)];
      moment_.markers = moved(moment_.markers, by);
    }
    return false;
  }

  /// Rows that hold an angle jump by a whole turn somewhere. Angles stay within two turns; what is larger is a length.
  std::vector<double> turned_near(std::vector<double> values) const {
    for (std::size_t r = 0; r < std::min(values.size(), here_.size()); ++r) {
      const double jump = values[r] - here_.value[r];
      const bool angle = std::abs(values[r]) < 12.6 && std::abs(here_.value[r]) < 12.6;
      if (angle && std::abs(jump) > 3.0) values[r] -= whole_turn * std::round(jump / whole_turn);
    }
    return values;
  }

  const JointProbe& probe_;
  JointMoment moment_;
  Findings& findings_;
  AllRows here_;
};

}  // namespace

void check_rows(const JointProbe& probe, const std::vector<JointMoment>& moments, RandomNumbers& random,
                Findings& findings) {
  if (probe.layout().constraint_rows == 0 && probe.layout().coordinate == Coordinate::none) return;
  for (const JointMoment& moment : moments) {
    RowCheck check(probe, moment, findings);
    check.declared();
    check.jacobian();
    check.partial_time();
    check.gamma(random_twelve(probe.space(), random, 3.0));
    check.independent();
    check.balance();
  }
}

}  // namespace freeplay
