#include "assembly/unstable_start.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

#include "assembly/continuation.h"
#include "assembly/row_space.h"
#include "base/index.h"
#include "linear/row_solutions.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double in_balance = 1e-10;                             // force along motions, of all that acts
constexpr double near_balance = 1e-2;                            // the same, within an accuracy of it
constexpr double at_rest = 1e-9;                                 // speed, of the model's size in a run
constexpr double deviation = 1e-5;                               // rad, or of the size of the model
constexpr double least_growth = 3.0;                             // powers of e in the run
constexpr double looked_at[] = {0.0, 0.03, 0.1, 0.3, 0.7, 1.0};  // of the run

class Balance {
 public:
  Balance(const System& system, const State& start) : mechanism_(system), model_(mechanism_.model()) {
    mechanism_.stand_at(system, start);
    evaluate();
    q_.assign(mechanism_.state.q().begin(), mechanism_.state.q().end());
    root_mass_ = VectorXd::Map(mechanism_.system.inertia().mass().data(),
                               static_cast<Eigen::Index>(mechanism_.system.inertia().mass().size()))
                     .cwiseSqrt();
  }

  std::optional<UnstableStart> unstable() {
    if (root_mass_.size() == 0 || !(root_mass_.minCoeff() > 0.0)) return std::nullopt;
    const MatrixXd free = motions();
    if (free.cols() == 0) return std::nullopt;
    const double off = off_balance(free);
    if (!(off <= near_balance)) return std::nullopt;
    const VectorXd push = free.transpose() * loads();
    MatrixXd stiffness(free.cols(), free.cols());
    for (Eigen::Index i = 0; i < free.cols(); ++i) {
      VectorXd ahead, back;
      const double by = deviation * unit(free.col(i));
      if (!forces_at(by * free.col(i), ahead) || !forces_at(-by * free.col(i), back)) return std::nullopt;
      stiffness.col(i) = free.transpose() * (ahead - back) / (2.0 * by);
    }
    const SymmetricModes modes = symmetric_modes(0.5 * (stiffness + stiffness.transpose()));
    const Eigen::Index last = free.cols() - 1;
    const double growth = std::sqrt(std::max(0.0, modes.values[last]));
    if (!(growth * (model_.settings.end - model_.settings.start) > least_growth)) return std::nullopt;
    const VectorXd way = free * modes.vectors.col(last);
    const BodyId body = most_moved(way);
    if (off <= in_balance) return UnstableStart{body, growth};
    const double beside =
        std::abs(modes.vectors.col(last).dot(push)) / (growth * growth * unit(way)) * mechanism_.system.size();
    if (!(beside <= model_.settings.accuracy)) return std::nullopt;
    return UnstableStart{body, growth, beside};
  }

 private:
  void evaluate() { mechanism_.evaluate(term_position | term_velocity | term_force); }

  /// With unit kinetic energy each: columns are orthonormal in velocities times the roots of masses.
  MatrixXd motions() {
    MatrixXd rows = constraint_matrix(mechanism_.system.jacobian(), mechanism_.e);
    rows.array().rowwise() /= root_mass_.transpose().array();
    return null_space(rows);
  }
  /// What acts, by the roots of masses.
  VectorXd loads() const {
    return VectorXd::Map(mechanism_.e.force.data(), root_mass_.size()).cwiseQuotient(root_mass_);
  }

  /// What would move it at the times that are looked at, of all that acts; infinite where nothing does.
  double off_balance(const MatrixXd& free) {
    bool loaded = false;
    double off = 0.0;
    const double start = model_.settings.start, length = model_.settings.end - start;
    for (const double part : looked_at) {
      mechanism_.state.t() = start + part * length;
      evaluate();
      const VectorXd acting = loads();
      if (!(acting.norm() > 0.0)) continue;
      off = std::max(off, (free.transpose() * acting).norm() / acting.norm());
      loaded = true;
    }
    mechanism_.state.t() = start;
    evaluate();
    return loaded ? off : unbounded;
  }

  /// A deviation of so much along a motion is one of 1 rad or of the size of the model.
  double unit(const VectorXd& motion) const {
    double largest = 0.0;
    for (Eigen::Index i = 0; i < motion.size(); ++i) {
      const bool turn = mechanism_.system.coordinates().is_turn(static_cast<int>(i));
      largest = std::max(largest, std::abs(motion[i]) / root_mass_[i] / (turn ? 1.0 : mechanism_.system.size()));
    }
    return 1.0 / largest;
  }

  /// What acts along the motions of a position beside the start. False where it cannot be taken.
  bool forces_at(const VectorXd& by, VectorXd& acting) {
    const VectorXd change = by.cwiseQuotient(root_mass_);
    mechanism_.system.coordinates().retract(q_, {change.data(), static_cast<std::size_t>(change.size())},
                                            mechanism_.state.q());
    const bool good = mechanism_.holds(mechanism_.converge());
    if (good) {
      evaluate();
      const MatrixXd free = motions();
      acting = free * (free.transpose() * loads());
    }
    std::ranges::copy(q_, mechanism_.state.q().begin());
    return good;
  }

  BodyId most_moved(const VectorXd& motion) const {
    const int width = mechanism_.system.layout().body_velocities();
    Eigen::Index most = 0;
    motion.cwiseAbs().maxCoeff(&most);
    return mechanism_.system.layout().body_at(static_cast<int>(most) / width);
  }

  ClosedMechanism mechanism_;
  const Model& model_;
  std::vector<double> q_;
  VectorXd root_mass_;
};

bool moves(const System& system, const State& start) {
  const double length = system.model().settings.end - system.model().settings.start;
  return std::ranges::any_of(start.v(), [&](double v) { return std::abs(v) * length > at_rest * system.size(); });
}

bool moves_by_itself(const Driver& driver) {
  return prescribes(driver.kind) && (driver.table || driver.kinematics >= 0 || driver.value.depends_on_time() ||
                                     driver.kind == DriverKind::velocity);
}

// Forces of which nothing says how they depend on time, as of some plugins, are left to the run.
bool has_unknown_times(const System& system) {
  for (int j = 0; j < static_cast<int>(system.model().joints.size()); ++j) {
    const JointLayout& layout = system.joints().layout(j);
    if (layout.forces != 0 && layout.time_scale == 0.0) return true;
  }
  return false;
}

}  // namespace

std::optional<UnstableStart> unstable_start(const System& system, const State& start) {
  if (system.layout().nv() > most_followed_velocities || moves(system, start)) return std::nullopt;
  if (std::ranges::any_of(system.model().drivers, moves_by_itself) || has_unknown_times(system)) return std::nullopt;
  try {
    return Balance(system, start).unstable();
  } catch (const Error&) {
    return std::nullopt;  // what has no value at some time is reported when a run meets it
  }
}

std::string words_of(const UnstableStart& start) {
  const std::string grows =
      fmt::format("a deviation would grow tenfold in {:.2g} s", std::numbers::ln10 / start.growth);
  const std::string why =
      start.beside > 0.0
          ? fmt::format(
                "it is {:.2g} m beside it, less than the accuracy, and {}; errors of steps decide when and where "
                "it goes: start farther beside it, ask for more accuracy, or give it a speed",
                start.beside, grows)
          : fmt::format(
                "what acts moves it neither way, and {}; it stays there or rounding decides where it goes: start "
                "beside it, or give it a speed",
                grows);
  return "starts at rest in an unstable equilibrium: " + why;
}

}  // namespace freeplay
