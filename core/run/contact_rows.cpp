#include "run/contact_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/index.h"
#include "component/joint_roles.h"

namespace freeplay {
namespace {
constexpr std::size_t room = 64;               // rows, and two for each joint
constexpr double same_instant_of_grid = 1e-9;  // of the interval
constexpr double long_ago = -std::numeric_limits<double>::infinity();
}  // namespace

ContactRows::ContactRows(const System& system, const Channels& channels, const Statistics& statistics,
                         bool looks_inside)
    : width_(channels.all().size()),
      time_column_(at(channels.time)),
      statistics_(statistics),
      levels_(system.model().settings.rows_in_contact),
      looks_inside_(looks_inside),
      same_(same_instant_of_grid * system.model().settings.interval),
      last_given_(long_ago),
      last_of_grid_(long_ago),
      last_held_of_grid_(long_ago) {
  if (levels_ == 0) return;
  for (int j = 0; j < static_cast<int>(system.model().joints.size()); ++j) {
    const JointLayout& layout = system.joints().layout(j);
    const JointColumns& columns = channels.joints[at(j)];
    if (columns.normal_force < 0 || contact_count(layout) == 0) continue;
    OfJoint& joint = joints_.emplace_back();
    joint.joint = j;
    joint.normal = columns.normal_force;
    joint.penetration = columns.penetration;
    for (std::size_t i = 0; i < layout.events.size; ++i) {
      const EventRole role = event_role(layout, i);
      joint.kinds.push_back(
          {role == EventRole::contact_begin, role == EventRole::contact_end, field_index(layout.events[i], "speed")});
    }
  }
  largest_.resize(2 * joints_.size());
  values_.resize(largest_.size());
  most_held_ = room + largest_.size();
}

void ContactRows::let_go(int& best) {
  if (best < 0) return;
  Slot& slot = slots_[at(std::exchange(best, -1))];
  if (--slot.best_of > 0 || slot.wanted) return;
  slot.used = false;
  --held_;
}

// What was largest until here becomes a row.
void ContactRows::begin_anew(std::size_t joint) {
  for (std::size_t q = 0; q < 2; ++q) {
    int& best = joints_[joint].best[q];
    if (best >= 0) slots_[at(best)].wanted = true;
    let_go(best);
    largest_[2 * joint + q] = 0.0;
  }
}

void ContactRows::pass(int joint, int event, double time, std::span<const double> fields) {
  const auto found = std::ranges::find(joints_, joint, &OfJoint::joint);
  if (found == joints_.end()) return;
  OfJoint& one = *found;
  const EventKind& kind = one.kinds[at(event)];
  if (!kind.begins && !kind.ends) return;
  begin_anew(static_cast<std::size_t>(found - joints_.begin()));
  one.on = kind.begins;
  touching_ = touching_ || one.on;
  const double speed = kind.begins && kind.speed >= 0 ? fields[at(kind.speed)] : 0.0;
  one.approach = speed > 0.0 ? speed : 0.0;
  one.time = one.middle = time;
  one.depth = one.way = one.passed = 0.0;
}

std::span<const double> ContactRows::values(std::span<const double> row) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    values_[2 * i] = row[at(joints_[i].normal)];
    values_[2 * i + 1] = joints_[i].penetration < 0 ? 0.0 : row[at(joints_[i].penetration)];
  }
  return values_;
}

// The mean speed of a step is taken for that of its middle, and the phase goes on linearly in time. False where no row
// is wanted.
bool ContactRows::go_on(OfJoint& joint, std::span<const double> row) {
  if (joint.penetration < 0 || joint.approach == 0.0 || joint.passed == 1.0) return false;
  const double t = row[time_column_], depth = row[at(joint.penetration)], dt = t - joint.time;
  if (!(dt > 0.0)) return false;
  const double speed = (depth - joint.depth) / dt, middle = joint.time + 0.5 * dt;
  const double way = std::acos(std::clamp(speed / joint.approach, -1.0, 1.0)) / std::numbers::pi;
  const double slope = (way - joint.way) / (middle - joint.middle);
  const double end = std::clamp(way + 0.5 * dt * slope, joint.passed, 1.0), begin = joint.passed;
  joint.time = t;
  joint.depth = depth;
  joint.middle = middle;
  joint.way = way;
  joint.passed = end;
  const double first = std::floor(begin * levels_ + 0.5), last = std::floor(end * levels_ + 0.5);
  if (looks_inside_) {
    for (double level = first; level < last; level += 1.0) {
      wanted_inside_.push_back(((level + 0.5) / levels_ - begin) / (end - begin));
    }
  }
  return last > first;
}

// The slot of the row, or -1 where it is not kept.
int ContactRows::see(std::span<const double> row) {
  int slot = -1;
  values(row);
  const bool counts = statistics_.counts(row[time_column_]);
  if (counts && !counts_) {
    for (std::size_t i = 0; i < joints_.size(); ++i) begin_anew(i);
  }
  if (!counts && counts_) return slot;  // inside of the step in which statistics began
  counts_ = counts;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (!(values_[i] > largest_[i])) continue;
    largest_[i] = values_[i];
    if (slot < 0) slot = slot_of(row);
    int& best = joints_[i / 2].best[i % 2];
    ++slots_[at(slot)].best_of;
    let_go(best);
    best = slot;
  }
  return slot;
}

void ContactRows::see_end(std::span<const double> row) {
  see(row);
  wanted_inside_.clear();
  touching_ = false;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    touching_ = touching_ || joints_[i].on || values_[2 * i] > 0.0;
    if (go_on(joints_[i], row) && !looks_inside_) slots_[at(slot_of(row))].wanted = true;
  }
}

void ContactRows::see_inside(std::span<const double> row, bool wanted) {
  see(row);
  if (wanted) slots_[at(slot_of(row))].wanted = true;
}

void ContactRows::hold(std::span<const double> row) {
  see(row);
  Slot& slot = slots_[at(slot_of(row))];
  slot.wanted = slot.of_grid = true;
  last_held_of_grid_ = slot.time;
}

// The slot that holds the row already, else one for it.
int ContactRows::slot_of(std::span<const double> row) {
  const double time = row[time_column_];
  auto found = std::ranges::find_if(slots_, [&](const Slot& slot) { return slot.used && slot.time == time; });
  if (found != slots_.end()) return static_cast<int>(found - slots_.begin());
  found = std::ranges::find(slots_, false, &Slot::used);
  const auto index = static_cast<std::size_t>(found - slots_.begin());
  if (found == slots_.end()) {
    slots_.emplace_back();
    numbers_.resize(slots_.size() * width_);
  }
  slots_[index] = {.time = time, .used = true};
  std::ranges::copy(row, numbers(index).begin());
  ++held_;
  return static_cast<int>(index);
}

// No two rows stand at one instant.
void ContactRows::give(double until, double next_of_grid, const Give& give) {
  order_.clear();
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i].used && slots_[i].time <= until) order_.push_back(i);
  }
  std::ranges::sort(order_, {}, [&](std::size_t i) { return slots_[i].time; });
  for (auto i = order_.rbegin(); i != order_.rend(); ++i) {
    Slot& slot = slots_[*i];
    slot.is_next_of_grid = slot.time >= next_of_grid - same_;
    if (slot.of_grid) next_of_grid = slot.time;
  }
  for (const std::size_t i : order_) {
    Slot& slot = slots_[i];
    slot.used = false;
    --held_;
    const bool apart = slot.time > last_given_ && slot.time > last_of_grid_ + same_ && !slot.is_next_of_grid;
    if (!slot.of_grid && !apart) continue;
    last_given_ = slot.time;
    if (slot.of_grid) last_of_grid_ = slot.time;
    give(numbers(i), slot.of_grid);
  }
  for (OfJoint& joint : joints_) {
    for (int& best : joint.best) {
      if (best >= 0 && !slots_[at(best)].used) best = -1;
    }
  }
}

void ContactRows::give_before_row(double time, const Give& give) {
  this->give(time, time, give);
  last_given_ = last_of_grid_ = time;
}

void ContactRows::give_after_step(const Give& give) {
  if (held_ > most_held_) return give_all(give);
  if (last_held_of_grid_ > last_of_grid_) this->give(last_held_of_grid_, unbounded, give);
}

void ContactRows::give_all(const Give& give) { this->give(unbounded, unbounded, give); }

}  // namespace freeplay
