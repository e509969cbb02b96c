// ImpulseError: what steps of one size make of the impulse and the work of a load that depends on the motion.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

namespace freeplay {

struct RunContext;

/// Inside a step a load keeps the form that it has at the begin, and counts as a straight line. Along the motion that
/// the step makes it may be something else, as where a switch changes its side. Of steps that follow each other soon
/// what that leaves out or adds may cancel, and a friction that jumps to and fro about rest is off by one jump, not by
/// all. Its work may be off all the same, as of a load that begins and ends late at a dead centre, where what it acts
/// on turns back in between.
class ImpulseError {
 public:
  /// More than this part of what a load moves is too much.
  static constexpr double allowed_part = 0.03;
  /// The same of the work that goes to and fro.
  static constexpr double allowed_work = 0.05;

  /// `speed`: along the load, of what it acts on.
  void add(double made, double speed) {
    exchanged_ += std::abs(made * speed);
    if (last_ != 0.0 && ++quiet_ > quiet_steps) settled_ += here(), last_ = largest_ = 0.0;
    take(made);
  }
  void add(double made, double exact, double speed) {
    exchanged_ += std::abs(exact * speed);
    work_off_ += (made - exact) * speed;
    last_ += made - exact;
    largest_ = std::max(largest_, std::abs(made - exact));
    quiet_ = 0;
    take(exact);
  }
  double off() const { return settled_ + here(); }
  double moved() const { return high_ - low_; }
  bool counts() const { return off() > allowed_part * moved() || work_counts(); }
  /// Adds a warning and the doubt `unresolved-input` of what is called `element`.
  [[gnu::cold]] void say(RunContext& run, const std::string& element) const;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.sum_, self.low_, self.high_, self.last_, self.largest_, self.quiet_, self.settled_);
    archive(self.work_off_, self.exchanged_);
  }

 private:
  static constexpr int quiet_steps = 10;  ///< after which others do not follow soon
  bool work_counts() const { return std::abs(work_off_) > allowed_work * exchanged_; }
  double here() const { return std::min(std::abs(last_), largest_); }
  void take(double impulse) {
    sum_ += impulse;
    low_ = std::min(low_, sum_), high_ = std::max(high_, sum_);
  }
  double sum_ = 0.0, low_ = 0.0, high_ = 0.0;  // of the impulse
  double last_ = 0.0, largest_ = 0.0;          // off it, in steps that follow each other soon: all, and the largest
  double settled_ = 0.0;                       // before them
  int quiet_ = 0;                              // steps since the last of them
  double work_off_ = 0.0, exchanged_ = 0.0;    // by how much the work is off, and what goes to and fro [J]
};

}  // namespace freeplay
