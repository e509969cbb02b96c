#include "run/idle_loads.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.h"

namespace freeplay {
namespace {

constexpr int most_columns = 300;   // beyond, loads only count as idle where all rows together hold everything
constexpr double no_pivot = 1e-10;  // of the largest entry of the row
constexpr double no_motion = 1e-8;  // of the free motion that moves it

}  // namespace

ActsOn acts_on(const System& system, const AppliedForce& force) {
  return {system.markers().place(force.marker), ground, force.kind == ForceKind::torque};
}

ActsOn acts_on(const System& system, const JointElement& joint) {
  return {system.markers().place(joint.marker_a), system.markers().place(joint.marker_b), false};
}

ActsOn acts_on(const System& system, const Driver& driver) {
  ActsOn on = acts_on(system, system.model().joints[at(driver.joint)]);
  on.turns = driver.kind == DriverKind::torque;
  return on;
}

IdleLoads::IdleLoads(const System& system) : system_(system) {}

int IdleLoads::add(ActsOn load) {
  const auto same = std::ranges::find(loads_, load, &Load::on);
  if (same != loads_.end()) return static_cast<int>(same - loads_.begin());
  const Layout& layout = system_.layout();
  if (loads_.empty() && layout.nv() <= most_columns) {
    rows_.setZero(layout.nc(), layout.nv());
    pivots_.reserve(at(layout.nc()));
    taken_.resize(at(layout.nv()));
  }
  held_.resize(at(layout.nv()));
  loads_.push_back({load});
  return static_cast<int>(loads_.size()) - 1;
}

// In single positions, as dead points, a free motion may leave a body at rest: what was seen to move does so until the
// rank changes.
void IdleLoads::look(const IndependentRows& rows, const ConstraintValues& e) {
  if (loads_.empty()) return;
  const bool other = rows.rank() != rank_;
  if (other) looks_ = 0, next_look_ = 0, rank_ = rows.rank();
  if (looks_++ < next_look_) return;
  std::ranges::fill(held_, rows.hold_everything() ? char{1} : char{0});
  if (!rows.hold_everything() && rows_.cols() > 0 && rows.is_known()) find_held(e);
  bool any = false;
  for (Load& load : loads_) {
    load.idle = (other || load.idle) && holds(load.on.a, load.on.turns) && holds(load.on.b, load.on.turns);
    any = any || load.idle;
  }
  next_look_ = any ? 2 * looks_ : std::numeric_limits<long>::max();
}

bool IdleLoads::holds(BodyId body, bool turns) const {
  const BodyId place = system_.layout().unknown(body);
  if (place == ground) return true;
  const int count = system_.layout().body_velocities(), last = turns ? (count == 3 ? 1 : 3) : count;
  const auto columns = std::span(held_).subspan(at(place * count), at(count)).last(at(last));
  return std::ranges::all_of(columns, [](char held) { return held != 0; });
}

// Gauss and Jordan, row by row: one that has none but its pivot left holds that column.
void IdleLoads::find_held(const ConstraintValues& e) {
  system_.constraints().jacobian().list(e.jacobian, entries_);
  rows_.setZero();
  const int count = system_.layout().body_velocities(), first_turn = count == 3 ? 2 : 3;
  for (const SparseEntry& entry : entries_) {
    const double unit = entry.col() % count < first_turn ? 1.0 : 1.0 / system_.size();
    rows_(entry.row(), entry.col()) += unit * entry.value();
  }
  std::ranges::fill(taken_, char{0});
  pivots_.clear();
  for (Eigen::Index r = 0; r < rows_.rows(); ++r) {
    auto row = rows_.row(r);
    const double size = row.cwiseAbs().maxCoeff();
    const auto kept = static_cast<Eigen::Index>(pivots_.size());
    for (Eigen::Index k = 0; k < kept; ++k) {
      if (const double part = row[pivots_[static_cast<std::size_t>(k)]]; part != 0.0) row -= part * rows_.row(k);
    }
    Eigen::Index column = 0;
    if (!(row.cwiseAbs().maxCoeff(&column) > no_pivot * size)) continue;
    row /= row[column];
    for (Eigen::Index k = 0; k < kept; ++k) {
      if (const double part = rows_(k, column); part != 0.0) rows_.row(k) -= part * row;
    }
    if (r != kept) rows_.row(kept) = row;
    pivots_.push_back(static_cast<int>(column));
    taken_[at(pivots_.back())] = 1;
  }
  for (std::size_t k = 0; k < pivots_.size(); ++k) {
    bool alone = true;
    for (int c = 0; c < system_.layout().nv(); ++c) {
      alone = alone && (taken_[at(c)] != 0 || !(std::abs(rows_(static_cast<Eigen::Index>(k), c)) > no_motion));
    }
    held_[at(pivots_[k])] = alone ? 1 : 0;
  }
}

}  // namespace freeplay
