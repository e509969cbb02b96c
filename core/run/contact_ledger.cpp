#include "run/contact_ledger.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.h"
#include "component/joint_roles.h"

namespace freeplay {
namespace {
constexpr double not_seen = std::numeric_limits<double>::quiet_NaN();
constexpr double longest_impact = 4.0;   // of the duration of one by the law alone
constexpr double impact_by_depth = 2.9;  // that duration, in greatest penetrations by approach speed
constexpr double least_weight = 1e-300;  // of a stretch whose ends dissipate nothing

double field(std::span<const double> fields, int index) { return index < 0 ? not_seen : fields[at(index)]; }

// By what the joint says or, where it does not, by the penetration that was reached.
double is_impact(double given, double approach_speed, double depth, double duration) {
  if (!std::isnan(given)) return given;
  if (!(approach_speed > 0.0) || std::isnan(depth)) return 0.0;
  return duration <= longest_impact * impact_by_depth * depth / approach_speed ? 1.0 : 0.0;
}
}  // namespace

ContactLedger::ContactLedger(const Joints& joints, const Channels& channels) : all_(joints), channels_(channels) {
  std::size_t most_contacts = 0;
  for (int j = 0; j < joints.count(); ++j) {
    const JointLayout& layout = joints.layout(j);
    const std::size_t contacts = contact_count(layout);
    if (contacts == 0) continue;
    const JointColumns& columns = channels.joints[at(j)];
    OfJoint& joint = joints_.emplace_back(OfJoint{.joint = j,
                                                  .normal = columns.normal_force,
                                                  .friction = columns.friction_force,
                                                  .contacts = std::vector<Contact>(contacts),
                                                  .kinds = {}});
    for (std::size_t i = 0; i < layout.events.size; ++i) {
      EventRole role = event_role(layout, i);
      const std::size_t contact = contact_of(layout, i);
      if (contact >= contacts) role = EventRole::none;
      const Event& event = layout.events[i];
      joint.kinds.push_back({role, contact, field_index(event, "speed"), field_index(event, "duration"),
                             field_index(event, "max_delta"), field_index(event, "impact")});
    }
    most_contacts = std::max(most_contacts, contacts);
  }
  numbers_.resize(3 * most_contacts);
  const std::size_t most_events = at(StepEvents::most_per_step) + 2;
  stretches_.reserve(most_contacts + 2 * most_events);
  ended_.reserve(most_events * joints_.size());
}

// A step without an event: a single contact is on all the time, or off. False where it is neither.
bool ContactLedger::go_on(OfJoint& joint, std::span<const double> row, double lost, double t) const {
  if (joint.contacts.size() != 1 || joint.normal < 0) return false;
  Contact& contact = joint.contacts.front();
  const double normal = row[at(joint.normal)];
  if (!contact.on && normal != 0.0) return false;
  const double friction = joint.friction < 0 ? 0.0 : row[at(joint.friction)];
  contact.at_end = {normal, friction, normal};
  if (contact.on) {
    if (t > contact.normal.last_time()) {
      contact.normal.add(t, normal);
      contact.tangential.add(t, friction);
    }
    contact.lost += lost - joint.lost;
  }
  joint.lost = lost;
  return true;
}

// The forces of every contact at the accepted state. A single contact has those of the joint's channels.
bool ContactLedger::look(OfJoint& joint, std::span<const double> row, const Point& point, const Evaluation& e,
                         Fault& fault) {
  const JointColumns& columns = channels_.joints[at(joint.joint)];
  const auto value = [&](int column) { return column < 0 ? 0.0 : row[at(column)]; };
  for (Contact& contact : joint.contacts) contact.at_start = contact.at_end;
  if (joint.contacts.size() == 1) {
    const double normal = value(columns.normal_force);
    joint.contacts.front().at_end = {normal, value(columns.friction_force), normal};
    return true;
  }
  const std::span numbers = std::span(numbers_).first(3 * joint.contacts.size());
  std::ranges::fill(numbers, not_seen);
  if (!all_.handle(joint.joint)
           .contacts(all_.input(joint.joint, point, e), {numbers.data(), numbers.size()}, fault.message)) {
    fault.kind = Fault::Kind::plugin;
    fault.joint = joint.joint;
    return false;
  }
  const double alike = 1.0 / std::max(1.0, static_cast<double>(std::ranges::count(joint.contacts, true, &Contact::on)));
  for (std::size_t c = 0; c < joint.contacts.size(); ++c) {
    Contact& contact = joint.contacts[c];
    contact.at_end = {numbers[3 * c], numbers[3 * c + 1], std::abs(numbers[3 * c + 2])};
    if (!std::isnan(numbers[3 * c])) continue;
    const double part = contact.on ? alike : 0.0;
    contact.at_end = {part * value(columns.normal_force), part * value(columns.friction_force), part};
  }
  return true;
}

void ContactLedger::open(OfJoint& joint, std::size_t contact, double t) {
  joint.contacts[contact].stretch = stretches_.size();
  stretches_.push_back({contact, t, t, 0.0, -1});
}

void ContactLedger::close(OfJoint& joint, std::size_t contact, double t) {
  stretches_[joint.contacts[contact].stretch].to = t;
}

void ContactLedger::pass(OfJoint& joint, const StepEvents& events, std::size_t happening) {
  const StepEvents::Happening& event = events.happenings()[happening];
  const EventKind& kind = joint.kinds[at(event.event)];
  if (kind.role == EventRole::none) return;
  Contact& contact = joint.contacts[kind.contact];
  const std::span<const double> fields = events.fields(event);
  if (kind.role == EventRole::contact_begin) {
    // What is on at the start of the run has been approached at a speed that is not known.
    contact.approach_speed = started_ ? field(fields, kind.speed) : not_seen;
    contact.begin = event.time;
    if (contact.on) return;  // its end had no event
    contact.on = true;
    contact.normal.begin(event.time, started_ ? 0.0 : contact.at_end.normal, started_);
    contact.tangential.begin(event.time, started_ ? 0.0 : contact.at_end.tangential, started_);
    return open(joint, kind.contact, event.time);
  }
  if (contact.on) {
    contact.normal.add(event.time, 0.0);
    contact.tangential.add(event.time, 0.0);
    close(joint, kind.contact, event.time);
    Stretch& stretch = stretches_[contact.stretch];
    stretch.ended = static_cast<int>(ended_.size());
    stretch.lost_before = contact.lost;
  }
  const double given = field(fields, kind.duration), duration = std::isnan(given) ? event.time - contact.begin : given;
  ended_.push_back(
      {happening,
       {.approach_speed = contact.approach_speed,
        .impulse = contact.normal.value(),
        .tangential_impulse = contact.tangential.value(),
        .energy_lost = 0.0,
        .impact = is_impact(field(fields, kind.impact), contact.approach_speed, field(fields, kind.depth), duration),
        .begin = event.time - duration}});
  contact.on = false;
  contact.approach_speed = not_seen;
  contact.begin = event.time;
  contact.lost = 0.0;
  contact.normal = contact.tangential = {};
}

// What the joint lost in the step, by the stretches in which its contacts were on.
void ContactLedger::share(OfJoint& joint, double lost, double end) {
  const auto weight = [&](const Stretch& stretch) {
    const Contact& contact = joint.contacts[stretch.contact];
    const double first = stretch.from == time_ ? contact.at_start.dissipated : 0.0,
                 last = stretch.to == end ? contact.at_end.dissipated : 0.0;
    return (stretch.to - stretch.from) * (first + last) + least_weight;
  };
  double sum = 0.0;
  for (const Stretch& stretch : stretches_) sum += weight(stretch);
  for (const Stretch& stretch : stretches_) {
    const double part = stretches_.size() == 1 ? lost : lost * (weight(stretch) / sum);
    if (stretch.ended >= 0) {
      ended_[at(stretch.ended)].record.energy_lost = stretch.lost_before + part;
    } else {
      joint.contacts[stretch.contact].lost += part;
    }
  }
}

bool ContactLedger::take_step(std::span<const double> row, std::span<const double> joint_loss, const StepEvents& events,
                              const Point& point, const Evaluation& e, Fault& fault) {
  ended_.clear();
  if (!started_) time_ = point.t;
  const bool quiet = started_ && events.happenings().empty();
  for (OfJoint& joint : joints_) {
    const double lost = joint_loss[at(joint.joint)];
    if (quiet && go_on(joint, row, lost, point.t)) continue;
    if (!look(joint, row, point, e, fault)) return false;
    stretches_.clear();
    for (std::size_t c = 0; c < joint.contacts.size(); ++c) {
      if (joint.contacts[c].on) open(joint, c, time_);
    }
    for (std::size_t i = 0; i < events.happenings().size(); ++i) {
      if (events.happenings()[i].joint == joint.joint) pass(joint, events, i);
    }
    for (std::size_t c = 0; c < joint.contacts.size(); ++c) {
      Contact& contact = joint.contacts[c];
      // A contact may begin without an event where it stood at its zero to rounding.
      if (!contact.on && joint.contacts.size() == 1 && contact.at_end.normal != 0.0) {
        contact.on = true;
        contact.normal.begin(time_, contact.at_start.normal, false);
        contact.tangential.begin(time_, contact.at_start.tangential, false);
        open(joint, c, time_);
      }
      if (!contact.on) continue;
      if (point.t > contact.normal.last_time()) {
        contact.normal.add(point.t, contact.at_end.normal);
        contact.tangential.add(point.t, contact.at_end.tangential);
      }
      close(joint, c, point.t);
    }
    share(joint, lost - joint.lost, point.t);
    joint.lost = lost;
  }
  time_ = point.t;
  started_ = true;
  return true;
}

std::vector<ContactLedger::Open> ContactLedger::open() const {
  std::vector<Open> all;
  for (const OfJoint& joint : joints_) {
    for (std::size_t c = 0; c < joint.contacts.size(); ++c) {
      const Contact& contact = joint.contacts[c];
      if (!contact.on) continue;
      const auto end = std::ranges::find_if(
          joint.kinds, [&](const EventKind& kind) { return kind.role == EventRole::contact_end && kind.contact == c; });
      all.push_back({.joint = joint.joint,
                     .event = end == joint.kinds.end() ? -1 : static_cast<int>(end - joint.kinds.begin()),
                     .record = {.approach_speed = contact.approach_speed,
                                .impulse = contact.normal.value(),
                                .tangential_impulse = contact.tangential.value(),
                                .energy_lost = contact.lost,
                                .impact = not_seen,
                                .begin = contact.begin}});
    }
  }
  return all;
}

const ContactRecord* ContactLedger::ended(std::size_t happening) const {
  const auto found = std::ranges::find(ended_, happening, &Ended::happening);
  return found == ended_.end() ? nullptr : &found->record;
}

}  // namespace freeplay
