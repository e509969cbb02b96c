// StopSearch: when a stop condition of a run is first met.
#pragma once

#include <array>
#include <vector>

#include "run/recorder.h"

namespace freeplay {

/// Under an accuracy steps may be long, and a condition may be met in a part of one alone. So values are looked at
/// inside a step where they may come to the limit, and where they are largest, and the step ends where the condition is
/// first met. Energies that are summed up step by step are known at the ends of steps alone.
class StopSearch {
 public:
  StopSearch(RunContext& run, Recorder& recorder);

  bool any() const { return !conditions_.empty(); }

  /// Before the first step: which conditions hold already. False when the run is over.
  [[gnu::cold]] bool look_at_start();

  /// The part of the step that was just made, before it is accepted, after which a condition is first met; more than 1:
  /// none is. False when the run is over.
  bool first_inside(double& part);
  /// The step that was just made ends where first_inside() said.
  void end_there() { met_ = found_; }

  /// After an accepted step: false when the run is over, with its outcome filled.
  bool go_on();

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.conditions_);
  }

 private:
  static constexpr std::size_t places = 6;  ///< of a step, with its ends
  struct Condition {
    const StopCondition* stop;
    int column;
    bool inside;              ///< its values are known inside steps
    double last_start = 0.0;  ///< by how much the value was past its limit at the start of the last step
    bool has_last = false;
    bool at_start = false;              ///< it held before the first step
    std::array<double, places> past{};  ///< the same in the present one

    double beyond(double value) const { return stop->above ? value - stop->limit : stop->limit - value; }
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.last_start, self.has_last);
    }
  };
  /// A place of a step and by how much a condition is met there.
  struct Place {
    double s, past;
  };

  bool may_be_met(const Condition& condition) const;
  bool look(double s);
  double past(const Condition& condition) const {
    return condition.beyond(row_[static_cast<std::size_t>(condition.column)]);
  }
  bool seek(const Condition& condition, const std::array<double, places>& at, double& part);
  bool seek_top(const Condition& condition, std::array<Place, 3> around, double& part);
  bool narrow(const Condition& condition, Place before, Place after, double& part);
  [[gnu::cold]] void fill_outcome(const Condition& condition, bool located);

  RunContext& run_;
  Recorder& recorder_;
  std::vector<Condition> conditions_;
  std::vector<double> row_;
  int found_ = -1, met_ = -1;
};

}  // namespace freeplay
