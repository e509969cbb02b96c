// EventBracket: lengths of a step between which it ends at an event.
#pragma once

#include <limits>
#include <optional>

#include "run/step_events.h"

namespace freeplay {

/// Newton's step supposes that a step of another length goes the same way. The end of one that errs by nearly what it
/// may moves with its length, so that the step can come back to the same two lengths again and again. The zero lies
/// between the longest that ended before the event and the shortest that ended past it: the chord finds it, where
/// the value at an end that stays is halved each time (regula falsi of Dowell and Jarratt 1971, BIT 11).
class EventBracket {
 public:
  EventBracket() = default;

  /// A step of the length `dt` ended with this value of the event that is hunted.
  void note(const StepEvents::Passage& end, double dt) {
    if (end.joint != joint_ || end.event != event_) *this = EventBracket(end.joint, end.event);
    const bool past = end.value >= 0.0;
    if (last_past_ == past) (past ? value_before_ : value_past_) *= 0.5;
    last_past_ = past;
    (past ? past_ : before_) = dt;
    (past ? value_past_ : value_before_) = end.value;
  }

  /// A length between, at which the value is likely to be `aim`; empty where there are no two sides.
  std::optional<double> inside(double aim) const {
    if (!(before_ < past_) || !(past_ < unknown) || !(before_ > 0.0)) return std::nullopt;
    const double share = (aim - value_before_) / (value_past_ - value_before_);
    return before_ + (share > 0.0 && share < 1.0 ? share : 0.5) * (past_ - before_);
  }

 private:
  EventBracket(int joint, int event) : joint_(joint), event_(event) {}
  static constexpr double unknown = std::numeric_limits<double>::infinity();

  int joint_ = -1, event_ = -1;
  std::optional<bool> last_past_;
  double before_ = 0.0, past_ = unknown;  // lengths of the step [s]
  double value_before_ = 0.0, value_past_ = 0.0;
};

}  // namespace freeplay
