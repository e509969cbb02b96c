#include "results/event_sink.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/number_text.h"

namespace freeplay {

EventSink::EventSink(const std::filesystem::path& path, const Model& model)
    : model_(model),
      columns_{"speed", "tangential_speed", "direction", "duration",           "max_fn",      "max_delta",
               "steps", "approach_speed",   "impulse",   "tangential_impulse", "energy_lost", "impact"},
      file_(path) {
  for (const JointElement& joint : model.joints) {
    auto& events = place_.emplace_back();
    for (const Event& event : joint.layout.events) {
      auto& fields = events.emplace_back();
      for (const Channel& field : event.fields) fields.push_back(column(field.name));
    }
  }
  cells_.resize(columns_.size());
  file_.line() += "time,joint,kind";
  for (const std::string& name : columns_) (file_.line() += ',') += name;
  file_.end_line();
}

std::size_t EventSink::column(const std::string& name) {
  const auto found = std::ranges::find(columns_, name);
  const std::size_t index = static_cast<std::size_t>(found - columns_.begin());
  if (found == columns_.end()) columns_.push_back(name);
  return index;
}

void EventSink::event(const EventRecord& record) {
  ContactNumbers contact;
  contact.fill(std::numeric_limits<double>::quiet_NaN());
  if (const ContactRecord* ended = record.contact) {
    contact = {ended->approach_speed, ended->impulse, ended->tangential_impulse, ended->energy_lost, ended->impact};
  }
  waiting_.push_back({record.time, static_cast<std::size_t>(record.joint), static_cast<std::size_t>(record.event),
                      fields_.size(), waiting_.size(), contact});
  fields_.insert(fields_.end(), record.fields.begin(), record.fields.end());
}

void EventSink::row(std::span<const double> values) {
  if (!waiting_.empty()) write_until(values[0]);
  file_.flush_if_due();
}

void EventSink::write_until(double time) {
  const auto place = [](const Waiting& event) { return std::tuple(event.time, event.joint, event.order); };
  // By order of arrival last, which a stable sort would give too, but with an allocation.
  std::ranges::sort(waiting_, {}, place);
  const auto later = std::ranges::find_if(waiting_, [&](const Waiting& event) { return event.time > time; });
  for (auto event = waiting_.begin(); event != later; ++event) write(*event);
  waiting_.erase(waiting_.begin(), later);
  if (waiting_.empty()) fields_.clear();
}

void EventSink::write(const Waiting& event) {
  const JointElement& joint = model_.joints[event.joint];
  std::ranges::fill(cells_, std::numeric_limits<double>::quiet_NaN());
  const std::vector<std::size_t>& place = place_[event.joint][event.event];
  for (std::size_t i = 0; i < place.size(); ++i) cells_[place[i]] = fields_[event.first_field + i];
  for (std::size_t i = 0; i < contact_numbers; ++i) {
    if (!std::isnan(event.contact[i])) cells_[of_contact + i] = event.contact[i];
  }
  std::string& line = file_.line();
  append_number(line, event.time);
  ((line += ',') += joint.name) += ',';
  line += joint.layout.events[event.event].name;
  for (const double cell : cells_) append_number(line += ',', cell);
  file_.end_line();
}

void EventSink::close() {
  write_until(std::numeric_limits<double>::infinity());
  file_.close();
}

}  // namespace freeplay
