#include "run/watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/index.h"
#include "model/element_name.h"
#include "model/whole_mass.h"
#include "run/reach.h"

namespace freeplay {
namespace {
constexpr double look_again = 1.21;  // where the square of a force has grown so much since the last look
constexpr double unmoved = 1e-6;     // of the clearance
constexpr double nearly_deepest = 0.25;
constexpr double good_part = 0.3;   // of the largest force in the run
constexpr double by_elastic = 2.5;  // of force times depth to what is stored, of K delta^1.5
}  // namespace

void SingularPassage::add(double regularity, double t, RunExtremes& seen) {
  if (regularity < seen.least_regularity) seen.least_regularity = regularity, seen.singular_time = t;
  const double root = std::sqrt(std::max(regularity, 0.0));
  if (!(t > last_t_)) {
    last_ = std::min(last_, root);
    return;
  }
  const double slope = (last_ - second_last_) / (last_t_ - second_last_t_);
  const bool through = slope < 0.0 && last_ + slope * (t - last_t_) <= 0.0 && std::min(last_, root) < near;
  if (through || regularity < there) seen.passed_at = std::min(seen.passed_at, root < last_ ? t : last_t_);
  second_last_ = std::exchange(last_, root);
  second_last_t_ = std::exchange(last_t_, t);
}

RunWatch::RunWatch(const System& system, const Channels& channels, bool adaptive)
    : system_(system), channels_(channels), planar_(system.model().space == Space::planar) {
  const Model& model = system.model();
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointLayout& layout = system.joints().layout(j);
    has_rows_.push_back(layout.constraint_rows > 0 && model.joints[at(j)].gear < 0 ? 1 : 0);
    if (!(layout.clearance > 0.0) || channels.joints[at(j)].penetration < 0) continue;
    const bool known = layout.smaller_radius > 0.0;
    const double radius = known ? layout.smaller_radius : trust::radius_by_clearance * layout.clearance;
    // Without a length the contact is taken to be as long as it is wide.
    const double length = layout.contact_length > 0.0 ? layout.contact_length : 2.0 * radius;
    const bool strength_known = known && layout.contact_modulus > 0.0;
    contacts_.push_back({.joint = j,
                         .penetration = channels.joints[at(j)].penetration,
                         .play = layout.clearance,
                         .deepest = layout.clearance + radius,
                         .strongest = strength_known
                                          ? trust::ideal_strength * layout.contact_modulus * 2.0 * radius * length
                                          : unbounded});
  }
  const std::vector<double> reached = reach(model);
  for (int b = 0; b < static_cast<int>(reached.size()); ++b) {
    if (const double far = reached[at(b)]; far < unbounded && far > 0.0)
      reaches_.push_back({b, channels.bodies[at(b)], 1.0 / (far * far)});
  }
  const bool on_ground = is_on_ground(model);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[at(b)];
    const double moment = std::max({body.inertia[0], body.inertia[4], body.inertia[8]});
    const int first = channels.bodies[at(b)];
    const double gyration_squared = on_ground && body.mass > 0.0 ? moment / body.mass : 0.0;
    movers_.push_back({b, first + (planar_ ? 3 : 7), planar_ ? 2 : 3, gyration_squared});
  }
  seen_.size = system.size();
  if (!adaptive) return;
  seen_.noisy.resize(model.joints.size());
  values_aside_.resize(PeakValues(model, channels).size());
}

int RunWatch::add(std::span<const double> row, const Evaluation& e) {
  const Settings& settings = system_.model().settings;
  const double passed = (row[at(channels_.time)] - settings.start) / (settings.end - settings.start);
  const double last = static_cast<double>(RunExtremes::parts - 1);
  const auto part = static_cast<std::size_t>(std::clamp(passed * (last + 1.0), 0.0, last));
  add_energy(row, part);
  add_forces(row, part);
  add_drivers(row, e);
  add_places(row);
  add_speeds(row);
  int found = -1;
  for (Contact& contact : contacts_) {
    const double squared = force_squared(e, contact.joint), depth = row[at(contact.penetration)];
    contact.depth.add(depth);
    contact.due = std::max(contact.due, look_again * squared);
    contact.hardest = std::max(contact.hardest, squared);
    if (depth > 0.0) {
      contact.now.add(squared, depth, e.potential[at(contact.joint)]);
    } else if (contact.now.deepest > 0.0) {
      contact.damped = harder_damped(contact.damped, contact.now);
      contact.now = {};
    }
    const bool senseless = depth > contact.deepest || squared > contact.strongest * contact.strongest;
    if (senseless && found < 0) found = contact.joint;
  }
  return found;
}

void RunWatch::add_energy(std::span<const double> row, std::size_t part) {
  const EnergyColumns& columns = channels_.energy;
  const double kinetic = row[at(columns.kinetic)], residual = std::abs(row[at(columns.residual)]);
  seen_.kinetic.add(kinetic);
  seen_.potential.add(row[at(columns.potential)]);
  seen_.work.add(row[at(columns.work)]);
  seen_.dissipated.add(row[at(columns.dissipated)]);
  seen_.part_kinetic[part] = std::max(seen_.part_kinetic[part], kinetic);
  if (!(residual > seen_.residual)) return;
  if (residual > 2.0 * seen_.residual) seen_.residual_time = row[at(channels_.time)];
  seen_.residual = residual;
}

void RunWatch::add_places(std::span<const double> row) {
  double farthest = seen_.beyond_reach * seen_.beyond_reach;
  for (const Reach& reach : reaches_) {
    const double* place = &row[at(reach.column)];
    const double squared = place[0] * place[0] + place[1] * place[1] + (planar_ ? 0.0 : place[2] * place[2]);
    if (!(squared * reach.inverse_squared > farthest)) continue;
    farthest = squared * reach.inverse_squared;
    seen_.farthest_body = reach.body;
  }
  seen_.beyond_reach = std::sqrt(farthest);
}

double RunWatch::Mover::rim_squared(std::span<const double> row) const {
  const double* w = &row[at(velocity + directions)];
  return gyration_squared * (directions == 2 ? w[0] * w[0] : w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
}

double RunWatch::Mover::speed_squared(std::span<const double> row) const {
  const double* v = &row[at(velocity)];
  return v[0] * v[0] + v[1] * v[1] + (directions == 2 ? 0.0 : v[2] * v[2]);
}

void RunWatch::add_speeds(std::span<const double> row) {
  runaway_ = -1;
  for (const Mover& mover : movers_) {
    const double rim = mover.rim_squared(row);
    if (rim > seen_.rim_squared) seen_.rim_squared = rim, seen_.fastest_rim = mover.body;
    if (rim > trust::fastest_rim * trust::fastest_rim ||
        mover.speed_squared(row) > trust::speed_of_light * trust::speed_of_light) {
      runaway_ = mover.body;
    }
  }
}

void RunWatch::add_forces(std::span<const double> row, std::size_t part) {
  const auto squared = [&](int column) {
    const double* f = &row[at(column)];
    return f[0] * f[0] + f[1] * f[1] + (planar_ ? 0.0 : f[2] * f[2]);
  };
  const auto moment = [&](int column) {
    return planar_ ? row[at(column + 2)] * row[at(column + 2)] : squared(column + 3);
  };
  const double per_arm = 1.0 / (seen_.size * seen_.size);
  const auto load = [&](int column) { return std::max(squared(column), moment(column) * per_arm); };
  double of_rows = 0.0, others = 0.0;
  int joint = -1;
  for (std::size_t j = 0; j < has_rows_.size(); ++j) {
    const double force = squared(channels_.joints[j].force);
    if (has_rows_[j] == 0) {
      others = std::max(others, load(channels_.joints[j].force));
    } else if (force > of_rows) {
      of_rows = force, joint = static_cast<int>(j);
    }
  }
  for (const ForceColumns& force : channels_.forces) others = std::max(others, load(force.force));
  of_rows = std::sqrt(of_rows);
  seen_.applied_force = std::max(seen_.applied_force, std::sqrt(others));
  seen_.part_force[part] = std::max(seen_.part_force[part], of_rows);
  NearForce& of = passage_.is_near() ? seen_.near : passage_.is_beside() ? seen_.beside : seen_.away;
  if (of_rows > of.force) of = {of_rows, row[at(channels_.time)], joint};
  add_change(of_rows);
  if (of_rows > seen_.row_force) {
    seen_.row_force = of_rows;
    seen_.row_force_joint = joint;
    seen_.row_force_time = row[at(channels_.time)];
  }
}

void RunWatch::add_beside(const LargestValues& largest, std::span<const double> farther, double t) {
  const PeakValues& places = largest.places();
  places.of(farther, values_aside_);
  for (std::size_t j = 0; j < has_rows_.size(); ++j) {
    const std::size_t place = places.force(static_cast<int>(j));
    const double force = largest.last()[place];
    if (has_rows_[j] != 0 && force > seen_.noisy[j].force) seen_.noisy[j] = {force, force - values_aside_[place], t};
  }
}

void RunWatch::add_change(double force) {
  const bool close = passage_.is_near() || passage_.is_beside();
  if (close || was_close_) seen_.near_change = std::max(seen_.near_change, std::abs(force - last_force_));
  last_force_ = force;
  was_close_ = close;
}

void RunWatch::add_drivers(std::span<const double> row, const Evaluation& e) {
  const Model& model = system_.model();
  for (std::size_t d = 0; d < model.drivers.size(); ++d) {
    const Driver& driver = model.drivers[d];
    const bool turns = system_.joints().layout(driver.joint).coordinate == Coordinate::angle;
    if (!prescribes(driver.kind)) {
      const double effort = std::abs(row[at(channels_.drivers[d].effort)]);
      seen_.drive_effort = std::max(seen_.drive_effort, turns ? effort / seen_.size : effort);
      continue;
    }
    const double rate = e.motion[d].rate, second = std::abs(e.motion[d].acceleration);
    const double motion = turns ? seen_.size * (second + rate * rate) : second + rate * rate / seen_.size;
    seen_.drive_motion = std::max(seen_.drive_motion, motion);
  }
}

RunWatch::Press RunWatch::harder_damped(const Press& one, const Press& other) {
  const bool damped = std::isfinite(other.by_spring) && other.by_spring > most_damped * by_elastic &&
                      other.depth_then >= nearly_deepest * other.deepest;
  return damped && other.most > one.most ? other : one;
}

double RunWatch::damped_by(int joint) const {
  for (const Contact& contact : contacts_) {
    if (contact.joint != joint) continue;
    const Press damped = harder_damped(contact.damped, contact.now);
    return damped.most >= good_part * good_part * contact.hardest ? damped.by_spring / by_elastic : 0.0;
  }
  return 0.0;
}

bool RunWatch::never_moved(int joint) const {
  const auto contact = std::ranges::find(contacts_, joint, &Contact::joint);
  if (contact == contacts_.end() || !(contact->depth.most < 0.0)) return false;
  return contact->depth.span() <= unmoved * system_.joints().layout(joint).clearance;
}

TrustReason RunWatch::why(int joint, std::span<const double> row) const {
  const auto contact = std::ranges::find(contacts_, joint, &Contact::joint);
  const JointLayout& layout = system_.joints().layout(joint);
  TrustReason reason{.id = {}, .level = Trust::bad, .message = {}};
  reason.element = written_name(system_.model().joints[at(joint)]);
  const double penetration = row[at(contact->penetration)];
  if (penetration > contact->deepest) {
    reason.id = "penetration";
    reason.value = penetration, reason.limit = contact->deepest;
    const char* what = layout.smaller_radius > 0.0 ? "clearance and smaller radius together" : "a thousand clearances";
    reason.message =
        fmt::format("{} at t = {:.9g} s: its surfaces are {:.3g} m deep in each other, more than {} ({:.3g} m)",
                    reason.element, row[at(channels_.time)], penetration, what, contact->deepest);
    return reason;
  }
  const int column = channels_.joints[at(joint)].force;
  const double force = std::hypot(row[at(column)], row[at(column + 1)], planar_ ? 0.0 : row[at(column + 2)]);
  reason.id = "material-strength";
  reason.value = force, reason.limit = contact->strongest;
  reason.message = fmt::format(
      "{} at t = {:.9g} s: a force of {:.3g} N presses with more than a tenth of the elastic "
      "modulus E* = {:.3g} Pa, which no material bears",
      reason.element, row[at(channels_.time)], force, layout.contact_modulus);
  return reason;
}

TrustReason RunWatch::why_runaway(std::span<const double> row) const {
  const auto mover = std::ranges::find(movers_, runaway_, &Mover::body);
  TrustReason reason{.id = "body-speed", .level = Trust::bad, .message = {}};
  reason.element = fmt::format("body '{}'", system_.model().bodies[at(runaway_)].name);
  if (const double speed = std::sqrt(mover->speed_squared(row)); speed > trust::speed_of_light) {
    reason.value = speed, reason.limit = trust::speed_of_light;
    reason.message = fmt::format("{} at t = {:.9g} s: it moves with {:.3g} m/s, faster than light", reason.element,
                                 row[at(channels_.time)], speed);
    return reason;
  }
  reason.value = std::sqrt(mover->rim_squared(row)), reason.limit = trust::fastest_rim;
  reason.message = fmt::format(
      "{} at t = {:.9g} s: it turns with {:.3g} m/s at its radius of gyration, more than twice the speed of sound in "
      "steel",
      reason.element, row[at(channels_.time)], reason.value);
  return reason;
}

}  // namespace freeplay
