#include "io/contact_advice.h"

#include <cmath>
#include <string_view>

namespace freeplay {

ContactAdvice::ContactAdvice(const Model& model)
    : from_(model.settings.start + model.settings.discard), per_contact_(model.settings.per_contact) {
  for (const JointElement& joint : model.joints) {
    auto& events = fields_.emplace_back();
    for (const Event& event : joint.layout.events) {
      Fields& fields = events.emplace_back();
      for (std::size_t i = 0; i < event.fields.size; ++i) {
        if (event.fields[i].name == std::string_view("duration")) fields.duration = static_cast<int>(i);
        if (event.fields[i].name == std::string_view("steps")) fields.steps = static_cast<int>(i);
      }
    }
  }
}

void ContactAdvice::event(const EventRecord& record) {
  const Fields& at = fields_[static_cast<std::size_t>(record.joint)][static_cast<std::size_t>(record.event)];
  if (at.duration < 0 || at.steps < 0 || record.time < from_) return;
  const double steps = record.fields[static_cast<std::size_t>(at.steps)];
  const double duration = record.fields[static_cast<std::size_t>(at.duration)];
  if (std::isnan(steps)) return;
  ++ended_;
  fewest_steps_ = std::fmin(fewest_steps_, steps);
  if (steps >= per_contact_) return;
  ++under_resolved_;
  step_ = std::fmin(step_, duration / per_contact_);
}

}  // namespace freeplay
