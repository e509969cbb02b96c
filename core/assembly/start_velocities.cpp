#include "assembly/start_velocities.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "assembly/bare_start.h"
#include "assembly/dead_point.h"
#include "assembly/placing.h"
#include "assembly/play_rows.h"
#include "base/index.h"
#include "linear/row_solutions.h"
#include "linear/stacked_rows.h"
#include "model/element_name.h"
#include "model/force_element.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Eigen::Index most_listed_velocities = 200;  // beyond, what is chosen costs more to list than to find
constexpr double of_racing = 0.1;       // of velocities: less by this is worth what blocks then do not keep
constexpr double share_in_play = 1e-2;  // share of a journal's motion that constraints must leave to it
constexpr double part_free = 1e-6;      // of a direction of unit length: less is rounding
constexpr double kept_part = 1e-9;      // of the largest velocity: a given one that differs by less is kept
constexpr double noticed_way = 1e-9;    // in the whole run, in rad or over the size of the model: less is no speed

class Velocities {
 public:
  Velocities(ClosedMechanism& mechanism, std::span<const double> mass)
      : mechanism_(mechanism),
        system_(mechanism.system),
        model_(mechanism.model()),
        mass_(Eigen::Map<const VectorXd>(mass.data(), system_.layout().nv())) {
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      if (const auto& speed = model_.joints[at(j)].start_speed) leading_.push_back({j, speed->value});
    }
  }

  std::vector<ChosenSpeed> solve_and_list() {
    solve();
    return system_.layout().nv() <= most_listed_velocities ? chosen() : std::vector<ChosenSpeed>{};
  }

  void solve() {
    start_velocities(system_, mechanism_.state.q(), mechanism_.state.v());
    const VectorXd given = velocities();
    solve_least_change(given);
    if (system_.layout().nv() > most_dense_columns) return;
    if (gives_any() && !keeps(given)) keep_what_can_be_kept(given);
  }

 private:
  VectorXd velocities() const { return Eigen::Map<const VectorXd>(mechanism_.state.v().data(), system_.layout().nv()); }
  void set(const VectorXd& v) { std::copy(v.begin(), v.end(), mechanism_.state.v().begin()); }
  void add(const VectorXd& change) {
    for (Eigen::Index i = 0; i < change.size(); ++i) mechanism_.state.v()[static_cast<std::size_t>(i)] += change[i];
  }
  double allowed() const { return 1e-8 * std::max(1.0, velocities().norm()); }

  // All given velocities, and rest for the others, changed least in kinetic energy.
  void solve_least_change(const VectorXd& given) {
    // Repeated because the rate of a coordinate is linear in v only to rounding.
    for (int pass = 0; pass < 3; ++pass) {
      const ClosedMechanism::Rows now = mechanism_.speed_rows(leading_);
      if (now.row.empty()) return;
      add(pass == 0 ? least_weighted_solution(now.matrix, mass_, -now.residual)
                    : least_norm_solution(now.matrix, -now.residual));
    }
    const ClosedMechanism::Rows last = mechanism_.speed_rows(leading_);
    if (last.largest() > allowed() && !yield_in_play(given)) report_contradiction(last, allowed());
    if (std::ranges::count(ranks_, PlayRank::given) > 0 && !play_yields_) spare_runaways(given);
  }

  // Where constraints are redundant but for the play, velocities in it could hold only with the whole mechanism racing.
  void spare_runaways(const VectorXd& given) {
    const VectorXd racing = velocities();
    // Of entries that are 1 for directions and lengths for turns.
    least_in_play_ = share_in_play * std::min(1.0, system_.size()) / std::max(1.0, system_.size());
    if (!yield_in_play(given) || velocities().norm() <= of_racing * racing.norm()) return;
    set(racing);
    play_yields_ = false;
    least_in_play_ = StackedRows::rounding;
  }

  // Redundant constraints that hold without the rows of joints with play leave their journals fewer velocities.
  bool yield_in_play(const VectorXd& given) {
    if (model_.clearance_joints() == 0 || system_.layout().nv() > most_dense_columns) return false;
    play_yields_ = true;
    const VectorXd least = velocities();
    keep_what_can_be_kept(given);
    if (exact_residual(mechanism_.speed_rows(leading_)).norm() <= allowed()) return true;
    set(least);
    return play_yields_ = false;
  }

  void polish() {
    for (int pass = 0; pass < 2; ++pass) {
      const ClosedMechanism::Rows now = mechanism_.speed_rows(leading_);
      if (!now.row.empty()) add(least_norm_solution(exact(now), -exact_residual(now)));
    }
  }

  // What differs from what is wanted by rounding alone does not differ.
  void keep_exactly(const VectorXd& wanted) {
    const double rounding = 1e-13 * velocities().lpNorm<Eigen::Infinity>();
    VectorXd v = velocities();
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      if (std::abs(v[i] - wanted[i]) <= rounding) v[i] = wanted[i] + 0.0;
    }
    set(v);
  }

  bool gives_any() const {
    return !leading_.empty() || std::ranges::any_of(model_.bodies, [](const Body& body) {
      return body.velocity_given || body.angular_velocity_given;
    });
  }

  bool keeps(const VectorXd& given) {
    const MatrixXd rows = given_rows();
    return rows.rows() == 0 || (rows * (velocities() - given)).lpNorm<Eigen::Infinity>() <=
                                   kept_part * std::max(1.0, given.lpNorm<Eigen::Infinity>());
  }

  // --- rows of each rank -------------------------------------------------------------------------------------------

  // Velocities that blocks give hold as constraints do, unless redundant ones leave no room for them.
  std::vector<Eigen::Index> rows_of(const ClosedMechanism::Rows& rows, PlayRank wanted) const {
    std::vector<Eigen::Index> chosen;
    for (std::size_t i = 0; i < rows.row.size(); ++i) {
      PlayRank rank = rows.row[i] < 0 ? PlayRank::constraint : ranks_[at(rows.row[i])];
      if (rank == PlayRank::given && !play_yields_) rank = PlayRank::constraint;
      if (rank == wanted) chosen.push_back(static_cast<Eigen::Index>(i));
    }
    return chosen;
  }
  SparseMatrix exact(const ClosedMechanism::Rows& rows) const {
    return MatrixXd(MatrixXd(rows.matrix)(rows_of(rows, PlayRank::constraint), Eigen::all)).sparseView();
  }
  VectorXd exact_residual(const ClosedMechanism::Rows& rows) const {
    return rows.residual(rows_of(rows, PlayRank::constraint));
  }

  // Rates of what the file gives bodies: of the frame's origin where it gives `linear` alone, of the centre of mass
  // where it gives both, which says the same.
  MatrixXd given_rows() const {
    const int width = system_.layout().body_velocities(), turns = width - linear();
    std::vector<VectorXd> rows;
    for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
      const Body& body = model_.bodies[at(b)];
      for (int c = 0; c < linear() && body.velocity_given; ++c) {
        VectorXd row = VectorXd::Zero(system_.layout().nv());
        row[width * b + c] = 1.0;
        for (int k = 0; k < turns && !body.angular_velocity_given; ++k)
          row[width * b + linear() + k] = arm_rate(b, k, c);
        rows.push_back(std::sqrt(mass_[width * b + c]) * row);
      }
      for (int k = 0; k < turns && body.angular_velocity_given; ++k) {
        VectorXd row = VectorXd::Zero(system_.layout().nv());
        row[width * b + linear() + k] = std::sqrt(std::max(mass_[width * b + linear() + k], 1e-12 * mass_.maxCoeff()));
        rows.push_back(row);
      }
    }
    MatrixXd out(static_cast<Eigen::Index>(rows.size()), system_.layout().nv());
    for (std::size_t i = 0; i < rows.size(); ++i) out.row(static_cast<Eigen::Index>(i)) = rows[i];
    return out;
  }
  int linear() const { return system_.layout().body_velocities() == 3 ? 2 : 3; }

  // Component c of the velocity of a body's origin against its centre of mass at unit rate of its k-th turn.
  double arm_rate(int body, int k, int c) const {
    const Pose frame = system_.coordinates().frame_pose(body, mechanism_.state.q());
    std::vector<double> v(mechanism_.state.v().size(), 0.0);
    v[at(system_.layout().body_velocities() * body + linear() + k)] = 1.0;
    double twist[6];
    system_.coordinates().body_twist(body, mechanism_.state.q(), v, twist);
    const Vector3& com = model_.bodies[at(body)].com;
    double arm[3] = {};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t i = 0; i < 3; ++i) arm[r] -= frame.rotation[3 * r + i] * com[i];
    }
    const double* w = twist + 3;
    const double rate[3] = {w[1] * arm[2] - w[2] * arm[1], w[2] * arm[0] - w[0] * arm[2],
                            w[0] * arm[1] - w[1] * arm[0]};
    return rate[c];
  }

  // All of it as a change of the given velocities.
  StackedRows ranked(const VectorXd& given) {
    const ClosedMechanism::Rows rows = mechanism_.speed_rows(leading_);
    const MatrixXd all = rows.matrix, own = given_rows();
    const auto in_blocks = rows_of(rows, PlayRank::given), implied = rows_of(rows, PlayRank::implied);
    StackedRows stack(given.size());
    stack.add(all(rows_of(rows, PlayRank::constraint), Eigen::all), -exact_residual(rows));
    stack.add(all(in_blocks, Eigen::all), -rows.residual(in_blocks), least_in_play_);
    stack.add(own, VectorXd::Zero(own.rows()));
    stack.add(all(implied, Eigen::all), -rows.residual(implied), least_in_play_);
    return stack;
  }

  void keep_what_can_be_kept(const VectorXd& given) {
    const VectorXd least = velocities();
    set(given);
    StackedRows stack = ranked(given);
    const MatrixXd energy = mass_.cwiseMax(1e-12 * mass_.maxCoeff()).cwiseSqrt().asDiagonal();
    stack.add(energy, VectorXd::Zero(given.size()));
    add(stack.solution());
    polish();
    keep_exactly(given);
    // Where rounding takes part, near a singular position, the plain rule is surer.
    if (!(exact_residual(mechanism_.speed_rows(leading_)).norm() <= allowed())) set(least);
  }

  // Speeds of joints that nothing determines but the least kinetic energy, and of bodies that these say nothing of.
  std::vector<ChosenSpeed> chosen() {
    const MatrixXd free = ranked(velocities()).free();
    if (free.cols() == 0) return {};
    std::vector<ClosedMechanism::Lead> joints;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      if (is_force_element(joint) || joint.gear >= 0 || joint.ideal_layout().coordinate == Coordinate::none) continue;
      joints.push_back({j, 0.0});
    }
    const ClosedMechanism::Rows rows = mechanism_.speed_rows(joints);
    const MatrixXd all = rows.matrix;
    std::vector<ChosenSpeed> out;
    std::vector<Eigen::Index> of_joints;
    for (std::size_t i = 0; i < rows.lead.size(); ++i) {
      const auto index = static_cast<Eigen::Index>(i);
      if (rows.lead[i] < 0) continue;
      of_joints.push_back(index);
      if ((all.row(index) * free).norm() <= kept_part * all.row(index).norm()) continue;
      const bool turns = model_.joints[at(rows.lead[i])].ideal_layout().coordinate == Coordinate::angle;
      if (std::abs(rows.residual[index]) <= least_speed(turns)) continue;
      out.push_back({.joint = rows.lead[i], .speed = rows.residual[index]});
    }
    add_bodies(free - free_by(all(of_joints, Eigen::all), free), out);
    return out;
  }

  // Speeds that are not more than rounding, [rad/s] or [m/s].
  double least_speed(bool turns) const {
    const Settings& settings = model_.settings;
    const double unit = turns ? 1.0 : system_.size();
    return std::max(kept_part * velocities().lpNorm<Eigen::Infinity>(),
                    noticed_way * unit / (settings.end - settings.start));
  }

  // The part of the columns of `free` that speeds of `rows` determine.
  static MatrixXd free_by(const MatrixXd& rows, const MatrixXd& free) {
    if (rows.rows() == 0) return MatrixXd::Zero(free.rows(), free.cols());
    const MatrixXd open = null_space(rows * free);
    return free - free * open * open.transpose();
  }

  // Bodies that move though the file leaves their velocity open along `free`.
  void add_bodies(const MatrixXd& free, std::vector<ChosenSpeed>& out) const {
    const VectorXd v = velocities();
    const int width = system_.layout().body_velocities(), lengths = width == 3 ? 2 : 3;
    // Zero where the file gives it, or where it is zero.
    const auto open = [&](int first, int count, bool turns) {
      const double speed = v.segment(first, count).norm();
      return speed > least_speed(turns) && free.middleRows(first, count).norm() > part_free ? speed : 0.0;
    };
    for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
      const double speed = open(width * b, lengths, false), turn = open(width * b + lengths, width - lengths, true);
      if (speed > 0.0 || turn > 0.0) out.push_back({.body = b, .speed = speed, .angular_speed = turn});
    }
  }

  // --- contradictions ----------------------------------------------------------------------------------------------

  // What a row stands for, and how directly the file asks for it: a start speed 2, a driver 1, a joint 0.
  struct Origin {
    int asked = -1;
    std::string words{};
    Location location{};
    int joint = -1;  ///< of an element that is no driver
  };

  // Least squares share a contradiction among all rows that take part; what was asked for is reported before joints.
  [[noreturn]] void report_contradiction(const ClosedMechanism::Rows& rows, double tolerance) const {
    Origin worst;
    double gap = 0.0;
    std::vector<int> joints;  // that take part
    std::vector<std::string> drivers;
    const double least = std::max(tolerance, 1e-6 * rows.largest());
    for (std::size_t i = 0; i < rows.row.size(); ++i) {
      const double missed = std::abs(rows.residual[static_cast<Eigen::Index>(i)]);
      if (missed <= least) continue;
      Origin origin = origin_of(rows.row[i], rows.lead[i]);
      if (origin.asked == 0 && origin.joint >= 0 && std::ranges::count(joints, origin.joint) == 0) {
        joints.push_back(origin.joint);
      }
      if (origin.asked == 1) drivers.push_back(origin.words);
      if (origin.asked < worst.asked || (origin.asked == worst.asked && missed <= gap)) continue;
      gap = missed;
      worst = std::move(origin);
    }
    std::string id = "assembly-failed", text;
    const std::string held = joints.empty() ? "the joints" : joint_names(joints, model_);
    if (std::ranges::any_of(rows.lead, [](int lead) { return lead >= 0; })) {
      text = fmt::format("drivers and start speeds contradict each other: {} cannot have its speed here", worst.words);
      if (!joints.empty()) text += fmt::format("; {} {} not allow it", held, joints.size() == 1 ? "does" : "do");
    } else if (const auto dead = dead_start(system_, mechanism_.state); dead && !dead->stuck) {
      id = "dead-point";
      text = words(*dead, model_);
    } else if (drivers.size() > 1) {
      text = fmt::format("drivers contradict each other: {} cannot all have their speeds here; {} {} not allow it",
                         fmt::join(drivers, " and "), held, joints.size() == 1 ? "does" : "do");
    } else if (worst.asked == 1) {
      text = fmt::format(
          "{} cannot move its joint from here: {} {} it; does each of them hold the bodies that are meant, and do "
          "lengths and angles let the loop move",
          worst.words, held, joints.size() == 1 ? "holds" : "hold");
    } else {
      text = fmt::format("speeds contradict each other: {} cannot follow", worst.words);
    }
    throw Error(Error::Category::input, id, text, worst.location);
  }

  Origin origin_of(int row, int lead) const {
    if (lead >= 0) {
      const JointElement& joint = model_.joints[at(lead)];
      return {2, written_name(joint), joint.start_speed->location};
    }
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
      const Driver& driver = model_.drivers[at(d)];
      if (system_.layout().driver_row(d) == row) {
        return {1, fmt::format("driver '{}'", driver.name), driver.location};
      }
    }
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const Slice slice = system_.layout().rows(j);
      if (row < slice.offset || row >= slice.offset + slice.size) continue;
      return {0, written_name(model_.joints[at(j)]), model_.joints[at(j)].location, j};
    }
    return {0, "a constraint"};
  }

  ClosedMechanism& mechanism_;
  const System& system_;
  const Model& model_;
  const VectorXd mass_;
  const std::vector<PlayRank> ranks_ = play_ranks(mechanism_, gives_velocity);
  double least_in_play_ = StackedRows::rounding;
  bool play_yields_ = false;                    // velocities that blocks give cannot hold as constraints do
  std::vector<ClosedMechanism::Lead> leading_;  // joints with a start speed
};

}  // namespace

std::vector<ChosenSpeed> solve_velocities(ClosedMechanism& mechanism, std::span<const double> mass) {
  return Velocities(mechanism, mass).solve_and_list();
}

void solve_bare_velocities(ClosedMechanism& mechanism, std::span<const double> mass) {
  Velocities(mechanism, mass).solve();
}

}  // namespace freeplay
