// SlowSteps: what makes steps with error control so short that their run goes on for hours, or for ever.
#pragma once

#include <string>
#include <vector>

#include "run/contact_pace.h"
#include "run/context.h"
#include "run/failure.h"

namespace freeplay {

/// Steps are looked at in blocks of 100 000: how much time do they cover, and how many are still to come at that pace?
/// The first to blame is a joint that asked for most of these steps to be so short, then one whose contact is damped so
/// much that an explicit method cannot take longer ones, then the force or driver that changes most from step to step:
/// what is smooth on the scale of a step changes by a small part of itself.
class SlowSteps {
 public:
  SlowSteps(RunContext& run, RunFailure& failure);

  /// After each accepted step. `limiting`: the joint that asked for no longer one, or -1. False, once the run has
  /// failed: it would not end within 1e11 steps.
  bool pass(int limiting) {
    if (limiting >= 0) joint_ = limiting, ++limited_;
    if (contacts_.any() && !run_.events.happenings().empty()) contacts_.note_begins();
    if (++steps_ <= block - watched) return true;
    watch();
    return steps_ < block || judge();
  }

  /// A sentence about the run, once.
  bool has_notice() const { return !noticed_ && !sentence_.empty(); }
  [[gnu::cold]] std::string take_notice();
  /// Once the run is over.
  [[gnu::cold]] void add_doubt();

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.steps_, self.limited_, self.joint_, self.from_, self.sentence_, self.element_, self.noticed_);
    archive(self.value_, self.limit_, self.changes_, self.contacts_, self.watched_from_);
  }

 private:
  static constexpr long block = 100'000, watched = 16;

  // By size: they run in 16 of 100 000 steps.
  [[gnu::cold]] void watch();
  [[gnu::cold]] void judge_contacts(double mean, double all);
  const char* remedy_for(const ContactPace& pace) const;
  [[gnu::cold]] bool judge();
  struct Blame {
    std::string element, words;
  };
  [[gnu::cold]] Blame blame() const;
  [[gnu::cold]] double change_of(std::size_t load) const;
  [[gnu::cold]] std::string name_of(std::size_t load) const;

  RunContext& run_;
  RunFailure& failure_;
  long steps_ = 0, limited_ = 0;
  int joint_ = -1;
  double from_;                  // where the block begins [s]
  std::vector<double> changes_;  // of joints, drivers and loads: sums over the last steps of the block
  ContactPaces contacts_;
  double watched_from_ = 0.0;         // where the watched steps of the block begin [s]
  double value_ = 0.0, limit_ = 0.0;  // that were judged where the sentence was found
  std::string sentence_, element_;
  bool noticed_ = false;
};

}  // namespace freeplay
