#include "assembly/start_branches.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Core>

#include "assembly/even_spread.h"
#include "base/angle.h"
#include "base/index.h"
#include "linear/row_solutions.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Shifts over the size of the model, turns in rad.
constexpr double same_place = 1e-6;    // of two positions
constexpr double other_place = 1e-3;   // positions that differ by less are one, reached on two ways
constexpr double kept = 1e-6;          // a pose that is missed by less is kept
constexpr double equally_near = 0.01;  // of the distance
constexpr double off_the_way = 0.2;    // of its length: what another branch would be beside
constexpr double longest_turn = 0.5;   // in one step towards the rows
constexpr double weight_of_guess = 1e-2;
constexpr int steps_by_weight = 6;
constexpr double curvature_step = 1e-5;    // m or rad
constexpr Eigen::Index most_refined = 12;  // motions that are left free
constexpr Eigen::Index most_columns = 180, columns_for_many = 45, columns_for_some = 90;

VectorXd scaled(const System& system, VectorXd increment) {
  for (int i = 0; i < static_cast<int>(increment.size()); ++i) {
    increment[i] = system.coordinates().is_turn(i) ? wrapped(increment[i]) : increment[i] / system.size();
  }
  return increment;
}

// Of a step: turns count whole, however many.
double length_of(const System& system, const VectorXd& step) {
  double longest = 0.0;
  for (int i = 0; i < static_cast<int>(step.size()); ++i)
    longest = std::max(longest, std::abs(step[i]) / (system.coordinates().is_turn(i) ? 1.0 : system.size()));
  return longest;
}

}  // namespace

StartBranches::StartBranches(ClosedMechanism& mechanism, std::span<const double> guess)
    : mechanism_(mechanism), system_(mechanism.system), given_(mechanism.system), guess_(guess.begin(), guess.end()) {}

bool StartBranches::keeps(const GivenPoses& given, std::span<const double> q) {
  return !given.any() || given.misses(q).lpNorm<Eigen::Infinity>() <= kept;
}

VectorXd StartBranches::difference(std::span<const double> from, std::span<const double> to) const {
  VectorXd out(system_.layout().nv());
  system_.coordinates().difference(from, to, {out.data(), static_cast<std::size_t>(out.size())});
  return out;
}

// Of bodies, and parts of them, for which the file gives no pose.
double StartBranches::from_guess(std::span<const double> q) const {
  const VectorXd away = scaled(system_, difference(guess_, q));
  const int width = system_.layout().body_velocities();
  double sum = 0.0;
  for (int i = 0; i < static_cast<int>(away.size()); ++i) {
    const Body& body = mechanism_.model().bodies[at(i / width)];
    const bool given = system_.coordinates().is_turn(i) ? body.angle || body.rotation : body.position.has_value();
    if (!given) sum += away[i] * away[i];
  }
  return std::sqrt(sum);
}

void StartBranches::add(std::vector<double> q) {
  for (const Position& known : found_) {
    if (scaled(system_, difference(known.q, q)).lpNorm<Eigen::Infinity>() <= other_place) return;
  }
  const double from_given = given_.any() ? given_.misses(q).norm() : 0.0, away = from_guess(q);
  found_.push_back({std::move(q), from_given, away});
}

void StartBranches::add_found() {
  come_nearer();
  refine();
  add({mechanism_.state.q().begin(), mechanism_.state.q().end()});
}

// Gauss and Newton along the motions that the rows leave free, as far as the given poses say where to.
void StartBranches::come_nearer() {
  if (system_.layout().nv() > most_columns || !given_.any()) return;
  const std::span<double> q = mechanism_.state.q();
  for (int iteration = 0; iteration < 30; ++iteration) {
    const VectorXd misses = given_.misses(q);
    if (misses.lpNorm<Eigen::Infinity>() <= same_place) return;
    const MatrixXd free = null_space(mechanism_.position_rows().matrix);
    if (free.cols() == 0) return;
    const VectorXd step = free * least_norm_solution(given_.derivative(q) * free, -misses, 1e-6);
    if (step.lpNorm<Eigen::Infinity>() <= 1e-9) return;
    const std::vector<double> before(q.begin(), q.end());
    bool better = false;
    double length = std::min(1.0, longest_turn / length_of(system_, step));
    for (int halving = 0; halving < 8 && !better; ++halving, length *= 0.5) {
      const VectorXd increment = length * step;
      system_.coordinates().retract(before, {increment.data(), at(static_cast<int>(increment.size()))}, q);
      better = mechanism_.holds(mechanism_.converge()) && given_.misses(q).norm() < (1.0 - 1e-9) * misses.norm();
    }
    if (better) continue;
    std::ranges::copy(before, q.begin());
    return;
  }
}

// Half the derivative of the squared distance from the given poses along the motions `ways`.
VectorXd StartBranches::slope(const MatrixXd& ways) const {
  const std::span<const double> q = mechanism_.state.q();
  return (given_.derivative(q) * ways).transpose() * given_.misses(q);
}

// Newton with the curvature of the motions: poses that are out of reach are missed least where no motion brings a body
// nearer at first order, and Gauss and Newton loses its way there.
void StartBranches::refine() {
  if (system_.layout().nv() > columns_for_some || !given_.any()) return;
  const std::span<double> q = mechanism_.state.q();
  const auto motions = [&] { return null_space(mechanism_.position_rows().matrix); };
  for (int iteration = 0; iteration < 12; ++iteration) {
    const VectorXd misses = given_.misses(q);
    if (misses.lpNorm<Eigen::Infinity>() <= same_place) return;
    const MatrixXd ways = motions();
    if (ways.cols() == 0 || ways.cols() > most_refined) return;
    const VectorXd down = slope(ways);
    if (down.lpNorm<Eigen::Infinity>() <= 1e-9 * misses.norm()) return;
    const std::vector<double> here(q.begin(), q.end());
    const auto go = [&](const VectorXd& increment) {
      system_.coordinates().retract(here, {increment.data(), at(static_cast<int>(increment.size()))}, q);
      return mechanism_.holds(mechanism_.converge());
    };
    MatrixXd curvature(ways.cols(), ways.cols());
    bool known = true;
    for (Eigen::Index k = 0; k < ways.cols() && known; ++k) {
      known = go(curvature_step * ways.col(k));
      const MatrixXd there = motions();
      known = known && there.cols() == ways.cols();
      if (known) curvature.col(k) = (slope(there * (there.transpose() * ways)) - down) / curvature_step;
    }
    std::ranges::copy(here, q.begin());
    if (!known) return;
    const SymmetricModes modes = symmetric_modes(0.5 * (curvature + curvature.transpose()));
    const VectorXd bends = modes.values.cwiseAbs().cwiseMax(1e-9 * modes.values.cwiseAbs().maxCoeff());
    const VectorXd along = modes.vectors.transpose() * down;
    VectorXd step = -(ways * (modes.vectors * along.cwiseQuotient(bends)));
    const double longest = length_of(system_, step);
    if (!(longest > 1e-12)) return;
    step *= std::min(1.0, longest_turn / longest);
    bool better = false;
    for (int halving = 0; halving < 12 && !better; ++halving, step *= 0.5) {
      better = go(step) && given_.misses(q).norm() < misses.norm();
    }
    if (better) continue;
    std::ranges::copy(here, q.begin());
    return;
  }
}

// From a start to the rows, by damped steps that count them more and more against the given poses and the start: unlike
// Newton's these do not leap where links are nearly in line.
void StartBranches::approach(std::span<const double> start) {
  const std::span<double> q = mechanism_.state.q();
  std::ranges::copy(start, q.begin());
  const Eigen::Index columns = system_.layout().nv();
  VectorXd scale(columns);
  for (int i = 0; i < static_cast<int>(columns); ++i)
    scale[i] = system_.coordinates().is_turn(i) ? 1.0 : system_.size();
  const auto cost = [&](const ClosedMechanism::Rows& rows, double weight) {
    const double away = weight_of_guess * scaled(system_, difference(start, q)).norm();
    const double given = given_.any() ? given_.misses(q).norm() : 0.0;
    return std::hypot(weight * rows.residual.norm() / system_.size(), given, away);
  };
  ClosedMechanism::Rows rows = mechanism_.position_rows();
  for (const double weight : {1.0, 3.0, 10.0, 30.0, 100.0, 1000.0}) {
    for (int iteration = 0; iteration < steps_by_weight; ++iteration) {
      const MatrixXd j = MatrixXd(rows.matrix) * scale.asDiagonal() * (weight / system_.size());
      MatrixXd normal = j.transpose() * j;
      VectorXd right = -j.transpose() * (rows.residual * (weight / system_.size()));
      const double anchor = weight_of_guess * weight_of_guess;
      normal.diagonal().array() += anchor;
      right -= anchor * scaled(system_, difference(start, q));
      if (given_.any()) {
        const MatrixXd g = given_.derivative(q) * scale.asDiagonal();
        normal += g.transpose() * g;
        right -= g.transpose() * given_.misses(q);
      }
      VectorXd step = symmetric_solution(normal, right);
      const double longest = step.lpNorm<Eigen::Infinity>();
      if (!(longest > 1e-12)) break;
      step *= std::min(1.0, longest_turn / longest);
      step = scale.cwiseProduct(step).eval();
      const std::vector<double> before(q.begin(), q.end());
      const double now = cost(rows, weight);
      bool better = false;
      for (int halving = 0; halving < 6 && !better; ++halving, step *= 0.5) {
        system_.coordinates().retract(before, {step.data(), at(static_cast<int>(columns))}, q);
        rows = mechanism_.position_rows();
        better = cost(rows, weight) < now;
      }
      if (better) continue;
      std::ranges::copy(before, q.begin());
      rows = mechanism_.position_rows();
      break;
    }
  }
}

void StartBranches::add_approached(std::span<const double> start) {
  approach(start);
  if (mechanism_.holds(mechanism_.converge())) add_found();
}

// Bodies without a given angle are turned far, the others a little; each by another angle.
std::vector<double> StartBranches::turned(int seed) const {
  VectorXd increment = VectorXd::Zero(system_.layout().nv());
  const int width = system_.layout().body_velocities();
  for (int i = 0, count = 0; i < static_cast<int>(increment.size()); ++i) {
    if (!system_.coordinates().is_turn(i)) continue;
    const Body& body = mechanism_.model().bodies[at(i / width)];
    const bool given = body.angle || body.rotation;
    increment[i] = (given ? 0.3 : std::numbers::pi) * even_spread(++count, seed);
  }
  std::vector<double> q = guess_;
  system_.coordinates().retract(guess_, {increment.data(), static_cast<std::size_t>(increment.size())}, q);
  return q;
}

// Newton's method alone, as the given pose would draw the body back.
void StartBranches::add_from_half_turns() {
  const bool planar = mechanism_.model().space == Space::planar;
  for (int b = 0; b < static_cast<int>(mechanism_.model().bodies.size()); ++b) {
    const Body& body = mechanism_.model().bodies[at(b)];
    if (!body.angle && !body.rotation) continue;
    for (int axis = planar ? 2 : 0; axis < 3; ++axis) {
      std::ranges::copy(guess_, mechanism_.state.q().begin());
      Pose pose = system_.coordinates().frame_pose(b, guess_);
      for (int i = 0; i < 9; ++i) {
        if (i % 3 != axis) pose.rotation[i] = -pose.rotation[i];
      }
      system_.coordinates().set_frame_pose(b, pose, mechanism_.state.q());
      if (mechanism_.holds(mechanism_.converge())) add_found();
    }
  }
}

void StartBranches::search() {
  const Eigen::Index columns = system_.layout().nv();
  if (columns > most_columns) return;
  const std::vector<double> state(mechanism_.state.q().begin(), mechanism_.state.q().end());
  add_approached(guess_);
  const int seeds = columns <= columns_for_many ? 12 : columns <= columns_for_some ? 4 : 0;
  for (int seed = 0; seed < seeds; ++seed) add_approached(turned(seed));
  if (columns <= columns_for_some) add_from_half_turns();
  const std::size_t mirrors = columns <= columns_for_some ? 6 : 1;
  const std::vector<Position> known(found_.begin(),
                                    found_.begin() + static_cast<std::ptrdiff_t>(std::min(found_.size(), mirrors)));
  for (const Position& one : known) {
    const VectorXd back = -difference(guess_, one.q);
    std::vector<double> mirrored = guess_;
    system_.coordinates().retract(guess_, {back.data(), static_cast<std::size_t>(back.size())}, mirrored);
    add_approached(mirrored);
  }
  std::ranges::copy(state, mechanism_.state.q().begin());
}

bool StartBranches::nearer(const Position& a, const Position& b) const {
  const auto clearly = [](double less, double more) { return less < (1.0 - equally_near) * more - same_place; };
  if (clearly(a.from_given, b.from_given) || clearly(b.from_given, a.from_given)) return a.from_given < b.from_given;
  return clearly(a.from_guess, b.from_guess);
}

const StartBranches::Position& StartBranches::nearest() const {
  const Position* best = &found_.front();
  for (const Position& one : found_) {
    if (nearer(one, *best)) best = &one;
  }
  return *best;
}

// Newton's method may reach a position after whole turns of a body; angles are those nearest to the given ones.
void StartBranches::count_turns_as_guessed() {
  if (mechanism_.model().space != Space::planar) return;
  const std::span<double> q = mechanism_.state.q();
  const std::vector<double> before(q.begin(), q.end());
  for (std::size_t i = 2; i < q.size(); i += 3) {
    const double turn = 2.0 * std::numbers::pi, near = mechanism_.model().bodies[i / 3].angle.value_or(guess_[i]);
    q[i] -= turn * std::round((q[i] - near) / turn);
  }
  if (!mechanism_.holds(mechanism_.position_rows())) std::ranges::copy(before, q.begin());
}

void StartBranches::take_nearest() { take(static_cast<std::size_t>(&nearest() - found_.data())); }

void StartBranches::take(std::size_t i) {
  std::ranges::copy(found_[i].q, mechanism_.state.q().begin());
  count_turns_as_guessed();
  mechanism_.evaluate(term_position | term_velocity);
}

// Places on the straight way, put right by the rows, that stay near it and are as near to what is given.
bool StartBranches::joined(const Position& a, const Position& b) const {
  const std::span<double> q = mechanism_.state.q();
  const std::vector<double> before(q.begin(), q.end());
  VectorXd way = difference(a.q, b.q);
  if (mechanism_.model().space == Space::planar) {  // Newton's method may have counted whole turns
    for (Eigen::Index i = 2; i < way.size(); i += 3) way[i] = wrapped(way[i]);
  }
  const double length = scaled(system_, way).norm();
  bool as_near = true;
  for (const double part : {0.25, 0.5, 0.75}) {
    const VectorXd increment = part * way;
    std::vector<double> aim(q.begin(), q.end());
    system_.coordinates().retract(a.q, {increment.data(), at(static_cast<int>(increment.size()))}, aim);
    std::ranges::copy(aim, q.begin());
    as_near = as_near && mechanism_.holds(mechanism_.converge());
    if (!as_near) break;
    const std::vector<double> there(q.begin(), q.end());
    const double missed = given_.any() ? given_.misses(there).norm() : 0.0;
    as_near = scaled(system_, difference(aim, there)).norm() < off_the_way * length &&
              missed <= (1.0 + equally_near) * std::max(a.from_given, b.from_given) + same_place;
  }
  std::ranges::copy(before, q.begin());
  mechanism_.position_rows();  // what is evaluated is again what stands there
  return as_near;
}

std::optional<std::vector<double>> StartBranches::as_near() const {
  const Position& best = nearest();
  for (const Position& one : found_) {
    if (&one != &best && !nearer(best, one) && !joined(best, one)) return one.q;
  }
  return std::nullopt;
}

}  // namespace freeplay
