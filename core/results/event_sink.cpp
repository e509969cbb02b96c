#include "results/event_sink.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <tuple>

#include "component/joint_roles.h"

namespace freeplay {
namespace {

constexpr struct {
  const char *name, *unit, *long_name;
} contact_columns[] = {
    {"speed", "m/s", "speed along the normal"},
    {"tangential_speed", "m/s", "speed along the wall"},
    {"direction", "rad", "direction of the contact in global axes"},
    {"duration", "s", "duration of the contact"},
    {"max_fn", "N", "largest normal force of the contact"},
    {"max_delta", "m", "largest penetration of the contact"},
    {"steps", "1", "steps of the contact"},
    {"approach_speed", "m/s", "normal speed at which the contact began"},
    {"impulse", "N*s", "impulse of the normal force over the contact"},
    {"tangential_impulse", "N*s", "impulse of the friction force over the contact"},
    {"energy_lost", "J", "energy lost in the contact"},
    {"impact", "1", "1 for an impact, 0 for a lasting contact"},
};

std::size_t place_among(const std::vector<RecordColumn>& columns, std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(columns, name, &RecordColumn::name) - columns.begin());
}

std::size_t place_among(const std::vector<std::string>& words, std::string_view word) {
  return static_cast<std::size_t>(std::ranges::find(words, word) - words.begin());
}

/// The kind of the entry for a contact that is on at the end of a run, by the event that would end it.
std::string open_kind(std::string_view ending) {
  constexpr std::string_view ends = "contact_end";
  if (!ending.ends_with(ends)) return "contact_open";
  return std::string(ending.substr(0, ending.size() - ends.size())) + "contact_open";
}

void add_kind(RecordLayout& layout, const std::string& name) {
  if (place_among(layout.kinds, name) == layout.kinds.size()) layout.kinds.push_back(name);
}

// Behind the kinds of events that happen.
void add_open_kinds(const Model& model, RecordLayout& layout) {
  for (const JointElement& joint : model.joints) {
    for (std::size_t i = 0; i < joint.layout.events.size; ++i) {
      if (event_role(joint.layout, i) == EventRole::contact_end)
        add_kind(layout, open_kind(joint.layout.events[i].name));
    }
  }
}

}  // namespace

void add_event_columns(const Model& model, RecordLayout& layout) {
  const std::string source = "events of joints";
  layout.events = {{"time", "s", "time of the event", source},
                   {"joint", "1", "joint of the event", source},
                   {"kind", "1", "kind of the event", source}};
  for (const auto& column : contact_columns) {
    layout.events.push_back({column.name, column.unit, column.long_name, source});
  }
  for (const JointElement& joint : model.joints) {
    layout.joints.push_back(joint.name);
    for (const Event& event : joint.layout.events) {
      add_kind(layout, std::string(event.name));
      for (const Channel& field : event.fields) {
        if (place_among(layout.events, field.name) < layout.events.size()) continue;
        const std::string type = joint.component != nullptr ? joint.component->description.name : "a joint";
        layout.events.push_back(
            {field.name, field.unit, std::string(field.name) + " of the event", "events of " + type});
      }
    }
  }
  add_open_kinds(model, layout);
}

EventSink::EventSink(const Model& model, const RecordLayout& layout, Take take)
    : numbers_(layout.events.size()), take_(std::move(take)) {
  for (const JointElement& joint : model.joints) {
    auto& events = events_.emplace_back();
    for (const Event& event : joint.layout.events) {
      OfEvent& of = events.emplace_back();
      of.kind = place_among(layout.kinds, event.name);
      of.open_kind = place_among(layout.kinds, open_kind(event.name));
      for (const Channel& field : event.fields) of.place.push_back(place_among(layout.events, field.name));
    }
  }
}

void EventSink::event(const EventRecord& record) { wait(record, false); }

void EventSink::open_contact(const EventRecord& record) { wait(record, true); }

void EventSink::wait(const EventRecord& record, bool open) {
  ContactNumbers contact;
  contact.fill(std::numeric_limits<double>::quiet_NaN());
  if (const ContactRecord* ended = record.contact) {
    contact = {ended->approach_speed, ended->impulse, ended->tangential_impulse, ended->energy_lost, ended->impact};
  }
  waiting_.push_back({record.time, static_cast<std::size_t>(record.joint), static_cast<std::size_t>(record.event),
                      fields_.size(), waiting_.size(), contact, open});
  fields_.insert(fields_.end(), record.fields.begin(), record.fields.end());
}

void EventSink::row(std::span<const double> values) {
  if (!waiting_.empty()) give_until(values[0]);
}

void EventSink::give_until(double time) {
  const auto place = [](const Waiting& event) { return std::tuple(event.time, event.joint, event.order); };
  // By order of arrival last, which a stable sort would give too, but with an allocation.
  std::ranges::sort(waiting_, {}, place);
  const auto later = std::ranges::find_if(waiting_, [&](const Waiting& event) { return event.time > time; });
  for (auto event = waiting_.begin(); event != later; ++event) give(*event);
  waiting_.erase(waiting_.begin(), later);
  if (waiting_.empty()) fields_.clear();
}

void EventSink::give(const Waiting& event) {
  const OfEvent& of = events_[event.joint][event.event];
  std::ranges::fill(numbers_, std::numeric_limits<double>::quiet_NaN());
  numbers_[0] = event.time;
  numbers_[1] = static_cast<double>(event.joint);
  numbers_[2] = static_cast<double>(of.kind);
  if (event.open) numbers_[2] = static_cast<double>(of.open_kind);
  for (std::size_t i = 0; i < of.place.size() && !event.open; ++i) {
    numbers_[of.place[i]] = fields_[event.first_field + i];
  }
  for (std::size_t i = 0; i < contact_numbers; ++i) {
    if (!std::isnan(event.contact[i])) numbers_[of_contact + i] = event.contact[i];
  }
  take_(numbers_);
}

void EventSink::finish() { give_until(std::numeric_limits<double>::infinity()); }

}  // namespace freeplay
