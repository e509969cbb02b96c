// The way of a PathFollower through the run: branches kept apart, singular places crossed or noted.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/QR>
#include <fmt/format.h>

#include "base/index.h"
#include "linear/singular_values.h"
#include "system/path_follower.h"

namespace freeplay {
namespace {

constexpr double same_place = 1e-8;  // of solutions that were reached on two ways, relative as all lengths here
constexpr int fewest_pieces = 128;   // of a run
// Of nearness() by the largest on the way so far.
constexpr double close = 0.05;        // where pieces must not leap over a singular place
constexpr double doorstep = 0.02;     // where it is bridged: roundings and the quintic err by 1e-10 there
constexpr double last_step = 1e-4;    // no bridge any closer
constexpr double smooth_way = 1e-10;  // what the quintic may miss of it
constexpr double noted = 0.05;        // where a path came near to a singular place
constexpr double singular = 1e-3;     // where that is why a way ends
constexpr double moved = 0.02;        // rate of a joint that takes part, by the largest
constexpr std::size_t most_names = 3;

/// The least that three equidistant samples of |s| show, where s^2 is a parabola, as beside a zero of s.
double least_of(double left, double middle, double right) {
  const double a = left * left, b = middle * middle, c = right * right;
  const double bend = a - 2.0 * b + c, slope = 0.5 * (c - a);
  double least = std::min({a, b, c});
  if (bend > 0.0 && std::abs(slope) < bend) least = std::min(least, b - 0.5 * slope * slope / bend);
  return std::sqrt(std::max(least, 0.0));
}

}  // namespace

// Pieces grow while their ends lead to the same place half-way, and shrink where they do not.
void PathFollower::find_way() {
  const double start = model_.settings.start, end = model_.settings.end;
  const double longest = (end - start) / fewest_pieces;
  Work work(system_, rows()), other(system_, rows());
  for (double piece = longest; way_.back().t() < end;) {
    const double t = way_.back().t();
    double next = t + piece;
    if (next > end - 1e-3 * piece) next = end;
    if (advance(next, work, other)) {
      piece = std::min(2.0 * piece, longest);
      continue;
    }
    if (bridge(work)) continue;
    piece *= 0.5;
    if (piece >= shortest_path_piece * (end - start)) continue;
    lost_ = t;
    if (near_.back() < std::max(singular * clear_, singular_start)) lost_words_ = words_of_place(edge_at(way_.back()));
    return;
  }
}

bool PathFollower::advance(double next, Work& work, Work& other) {
  MotionFault fault;
  if (solve(next, way_.back(), work, fault) != Found::yes) return false;
  const double left = near_.back(), right = nearness(work);
  if (!certain(way_.back(), work.state, other)) return false;
  const double least = least_of(left, nearness(other), right);
  if (least < close * clear_ && least < 0.5 * left) return false;
  way_.push_back(work.state);
  near_.push_back(right);
  clear_ = std::max(clear_, right);
  if (right > doorstep * clear_) tried_ = 1.0;
  return true;
}

bool PathFollower::certain(const State& left, const State& right, Work& work) {
  const double middle = 0.5 * (left.t() + right.t());
  MotionFault fault;
  if (solve(middle, left, work, fault) != Found::yes) return false;
  const std::vector<double> q(work.state.q().begin(), work.state.q().end());
  return solve(middle, right, work, fault) == Found::yes && distance(q, work.state.q()) <= same_place;
}

// The place is looked for where nearness falls to zero; the far end of the bridge is as far from it as the near one.
bool PathFollower::bridge(Work& work) {
  const double left = near_.back();
  if (way_.size() < 2 || left > doorstep * clear_ || left < last_step * clear_ || left > 0.6 * tried_ * clear_) {
    return false;
  }
  const State from = way_.back();
  const double fall = near_[near_.size() - 2] - left, t = from.t();
  if (!(fall > 0.0)) return false;
  tried_ = left / clear_;
  const double before = t - way_[way_.size() - 2].t();
  MotionFault fault;
  double length = 2.0 * before * left / fall;
  for (int attempt = 0; attempt < 8; ++attempt, length *= 1.5) {
    if (solve(t + length, from, work, fault) != Found::yes) continue;
    const double right = nearness(work);
    if (right < 0.5 * left) continue;
    const State to = work.state;
    PathBridge::End far = end_of_bridge(work);
    if (solve(t, from, work, fault) != Found::yes) return false;
    const PathBridge across(end_of_bridge(work), std::move(far));
    if (!agrees(across, t + 0.25 * length, from, work) || !agrees(across, t + 0.75 * length, to, work)) return false;
    bridges_.push_back(across);
    way_.push_back(to);
    near_.push_back(right);
    tried_ = 1.0;
    return true;
  }
  return false;
}

PathBridge::End PathFollower::end_of_bridge(Work& work) const {
  std::vector<TimeValue> values(model_.drivers.size());
  evaluate_drivers(work, {values.data(), values.size()});
  PathBridge::End end{.t = work.state.t()};
  for (const int d : drivers_)
    end.drivers.push_back({values[at(d)].value, values[at(d)].rate, values[at(d)].acceleration});
  for (int k = 0; k < static_cast<int>(model_.kinematics.size()); ++k) pose_of(k, work, end.frames.emplace_back());
  return end;
}

bool PathFollower::agrees(const PathBridge& bridge, double t, const State& from, Work& work) const {
  MotionFault fault;
  if (solve(t, from, work, fault) != Found::yes) return false;
  const PathBridge::End here = end_of_bridge(work);
  for (std::size_t i = 0; i < drivers_.size(); ++i) {
    const bool turns = model_.drivers[at(drivers_[i])].kind == DriverKind::angle;
    const double off = std::abs(bridge.driver(i, t).value - here.drivers[i].value);
    if (!(off <= smooth_way * (turns ? 1.0 : system_.size()))) return false;
  }
  return true;
}

void PathFollower::note_edges() {
  for (std::size_t i = 0; i < way_.size(); ++i) {
    const double here = near_[i];
    const bool falls = i > 0 && near_[i - 1] < here, rises = i + 1 < way_.size() && near_[i + 1] <= here;
    if (falls || rises || here > noted * clear_) continue;
    const double t = way_[i].t();
    if (std::ranges::any_of(bridges_, [t](const PathBridge& bridge) { return bridge.touches(t); })) continue;
    if (i + 1 == way_.size() && lost_ <= t) continue;
    double least = here;
    const State place = closest(i, least);
    edges_.push_back(edge_at(place));
    // Beside the place the square of nearness grows with that of time.
    std::size_t aside = i;
    const auto far = [&](std::size_t k) { return near_[k] > 2.0 * least; };
    while (aside > 0 && !far(aside)) --aside;
    if (!far(aside)) {
      for (aside = i; aside + 1 < way_.size() && !far(aside);) ++aside;
    }
    const double away = std::abs(way_[aside].t() - place.t());
    edges_.back().width = far(aside) ? least * away / std::sqrt(near_[aside] * near_[aside] - least * least) : away;
  }
}

// The instant around a solution at which nearness is least, by golden section.
State PathFollower::closest(std::size_t place, double& near) const {
  constexpr double golden = 0.6180339887498949;
  constexpr int sections = 40;
  Work work(system_, rows());
  MotionFault fault;
  const auto at_time = [&](double t) {
    return solve(t, nearest(t), work, fault) == Found::yes ? nearness(work) : std::numeric_limits<double>::infinity();
  };
  double from = way_[place > 0 ? place - 1 : 0].t(), to = way_[std::min(place + 1, way_.size() - 1)].t();
  double left = to - golden * (to - from), right = from + golden * (to - from);
  double at_left = at_time(left), at_right = at_time(right);
  for (int i = 0; i < sections; ++i) {
    if (at_left < at_right) {
      to = right, right = left, at_right = at_left;
      left = to - golden * (to - from), at_left = at_time(left);
    } else {
      from = left, left = right, at_left = at_right;
      right = from + golden * (to - from), at_right = at_time(right);
    }
  }
  const double least = at_time(at_left < at_right ? left : right);
  if (!(least < near)) return way_[place];
  near = least;
  return work.state;
}

Eigen::MatrixXd PathFollower::scaled_rows(const Work& work, Eigen::VectorXd& rows, Eigen::VectorXd& columns) const {
  Eigen::MatrixXd scaled = work.solver.matrix;
  columns.resize(scaled.cols());
  for (Eigen::Index c = 0; c < scaled.cols(); ++c) {
    columns[c] = system_.coordinates().is_turn(static_cast<int>(c)) ? 1.0 : system_.size();
  }
  scaled *= columns.asDiagonal();
  rows = scaled.rowwise().norm();
  for (Eigen::Index r = 0; r < scaled.rows(); ++r) {
    rows[r] = rows[r] > 0.0 ? 1.0 / rows[r] : 1.0;
    scaled.row(r) *= rows[r];
  }
  return scaled;
}

double PathFollower::nearness(const Work& work) const {
  Eigen::VectorXd rows, columns;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled_rows(work, rows, columns));
  const auto pivots = qr.matrixQR().diagonal().cwiseAbs();
  return pivots.size() == 0 ? 1.0 : pivots[pivots.size() - 1] / pivots[0];
}

// Along the motion v of the smallest singular value s, rows change by s e + c e^2/2 along its left vector u, e the way
// and c = -u.gamma(v): the farthest that is reached along u is s^2/2c away. Where there is no such end, as on the axis
// of a turntable, s itself is the distance from the place.
PathEdge PathFollower::edge_at(const State& state) const {
  Work work(system_, rows());
  work.state.assign(state);
  MotionFault fault;
  PathEdge edge{.kinematics = paths_.front().kinematics, .time = state.t(), .distance = 0.0};
  if (!assemble(state.t(), work, fault)) return edge;
  Eigen::VectorXd row_scale, column_scale;
  const SingularValues svd =
      singular_values(scaled_rows(work, row_scale, column_scale), SingularVectors::thin, SingularVectors::thin);
  const Eigen::Index last = svd.sigma.size() - 1;
  const Eigen::VectorXd u = row_scale.asDiagonal() * svd.u.col(last);
  const Eigen::VectorXd v = column_scale.asDiagonal() * svd.v.col(last);
  edge.joints = names_of_moved(v, work);
  const auto along = [&](double factor) {
    for (std::size_t i = 0; i < work.state.v().size(); ++i)
      work.state.v()[i] = factor * v[static_cast<Eigen::Index>(i)];
    double sum = 0.0;
    if (!assemble(state.t(), work, fault)) return sum;
    for (std::size_t i = 0; i < kept_.size(); ++i) sum += u[static_cast<Eigen::Index>(i)] * work.e.gamma[at(kept_[i])];
    for (std::size_t p = 0; p < paths_.size(); ++p) {
      PathPose pose;
      if (!system_.motions().path(paths_[p].kinematics, state.t(), pose, fault)) return sum;
      sum += u[static_cast<Eigen::Index>(kept_.size() + p)] * paths_[p].gamma(system_, work.e, pose);
    }
    return sum;
  };
  const double bend = std::abs(along(1.0) - along(0.0));
  const Eigen::VectorXd of_paths = u.tail(static_cast<Eigen::Index>(paths_.size()));
  Eigen::Index most = 0;
  const double reach = of_paths.cwiseAbs().maxCoeff(&most) > 0.0 ? of_paths.norm() : 0.0;
  edge.kinematics = paths_[static_cast<std::size_t>(most)].kinematics;
  const double lost = svd.sigma[last];
  edge.distance = lost * system_.size();
  if (bend > 0.0 && reach > 0.0) edge.distance = std::min(edge.distance, 0.5 * lost * lost / (bend * reach));
  return edge;
}

std::string PathFollower::names_of_moved(const Eigen::VectorXd& motion, Work& work) const {
  struct Moved {
    int joint;
    double rate;
  };
  std::vector<Moved> all;
  const int width = system_.layout().body_velocities();
  for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
    const JointElement& joint = model_.joints[at(j)];
    const Coordinate coordinate = system_.joints().layout(j).coordinate;
    if (coordinate == Coordinate::none || joint.gear >= 0) continue;
    double row[12], bias = 0.0, rate = 0.0;
    system_.joints().coordinate_row(j, work.e, row, bias);
    const BodyId bodies[2] = {model_.markers[at(joint.marker_a)].body, model_.markers[at(joint.marker_b)].body};
    for (int k = 0; k < 2; ++k) {
      for (int c = 0; c < width && bodies[k] != ground; ++c) rate += row[width * k + c] * motion[width * bodies[k] + c];
    }
    all.push_back({j, std::abs(rate) / (coordinate == Coordinate::angle ? 1.0 : system_.size())});
  }
  std::ranges::sort(
      all, [](const Moved& a, const Moved& b) { return std::pair(-a.rate, a.joint) < std::pair(-b.rate, b.joint); });
  std::string words;
  for (std::size_t i = 0; i < std::min(all.size(), most_names); ++i) {
    if (all[i].rate < moved * all.front().rate) break;
    const int j = all[i].joint;
    const double value = work.e.coordinate[at(j)];
    const bool turns = system_.joints().layout(j).coordinate == Coordinate::angle;
    words += fmt::format("{}'{}' (at {:.4g} {})", words.empty() ? "joint " : ", ", model_.joints[at(j)].name,
                         turns ? value * 180.0 / M_PI : value, turns ? "deg" : "m");
  }
  return words;
}

std::string words_of_place(const PathEdge& edge) {
  return fmt::format(
      ": a singular place, {:.2g} m from the edge of what is reached, at {}; keep the path within what is reached, or "
      "lead it smoothly through the place",
      edge.distance, edge.joints);
}

}  // namespace freeplay
