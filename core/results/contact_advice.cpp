#include "results/contact_advice.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "component/joint_roles.h"

namespace freeplay {

ContactAdvice::ContactAdvice(const Model& model)
    : from_(model.settings.start + model.settings.discard), per_contact_(model.settings.per_contact) {
  for (const JointElement& joint : model.joints) {
    auto& events = fields_.emplace_back();
    place_.push_back(joint.layout.events.size > 0 ? static_cast<int>(joints_.size()) : -1);
    if (place_.back() >= 0) joints_.emplace_back();
    for (std::size_t i = 0; i < joint.layout.events.size; ++i) {
      const Event& event = joint.layout.events[i];
      const bool begins = event_role(joint.layout, i) == EventRole::contact_begin;
      events.push_back({.duration = field_index(event, "duration"),
                        .steps = field_index(event, "steps"),
                        .force = field_index(event, "max_fn"),
                        .speed = begins ? field_index(event, "speed") : -1});
    }
  }
}

double ContactAdvice::fewest_steps_of_hard() const {
  double fewest = std::numeric_limits<double>::infinity();
  for (const OfJoint& joint : joints_) {
    for (const ByDecade* impacts : {&joint.all, &joint.counted}) {
      const auto none = impacts->rend() - 1;  // the smallest are roundings
      const auto hardest = std::find_if(impacts->rbegin(), none, [](double steps) { return std::isfinite(steps); });
      if (hardest != none) fewest = std::fmin(fewest, *hardest);
    }
  }
  return fewest;
}

void ContactAdvice::event(const EventRecord& record) {
  const Fields& fields = fields_[at(record.joint)][at(record.event)];
  OfJoint& joint = joints_[at(place_[at(record.joint)])];
  if (fields.speed >= 0) joint.speed = std::fmax(joint.speed, record.fields[static_cast<std::size_t>(fields.speed)]);
  if (fields.duration < 0 || fields.steps < 0) return;
  const double steps = record.fields[static_cast<std::size_t>(fields.steps)];
  const double duration = record.fields[static_cast<std::size_t>(fields.duration)];
  if (std::isnan(steps)) return;
  if (fields.force >= 0) {
    const double force = record.fields[static_cast<std::size_t>(fields.force)];
    const double decade = force > 0.0 ? std::floor(std::log10(force)) + 9.0 : 0.0;
    const auto place = static_cast<std::size_t>(std::clamp(decade, 0.0, decades - 1.0));
    joint.all[place] = std::fmin(joint.all[place], steps);
    if (record.time >= from_) joint.counted[place] = std::fmin(joint.counted[place], steps);
  }
  if (record.time < from_) return;
  ++ended_;
  fewest_steps_ = std::fmin(fewest_steps_, steps);
  if (steps >= per_contact_) return;
  ++under_resolved_;
  step_ = std::fmin(step_, duration / per_contact_);
}

}  // namespace freeplay
