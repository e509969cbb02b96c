// SteppedRun: a run that a script takes from step to step.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "python/ongoing_run.h"

namespace freeplay {

/// For one caller at a time: each function but interrupt() and those that say so needs a Turn.
class SteppedRun {
 public:
  SteppedRun(const std::shared_ptr<const OpenedModel>& model, const RunRequest& request, RunTick tick);

  class Turn {
   public:
    /// `good` where no other thread is at work with it.
    explicit Turn(SteppedRun& run) : run_(run), good_(!run.busy_.exchange(true, std::memory_order_acquire)) {}
    ~Turn() {
      if (good_) run_.busy_.store(false, std::memory_order_release);
    }
    Turn(const Turn&) = delete;
    bool good() const { return good_; }

   private:
    SteppedRun& run_;
    bool good_;
  };

  /// To `goal`; ends the run with its files where it comes to its end. False once it is over. In a process that was
  /// forked from the one that began it, without the files.
  bool advance(const RunGoal& goal);
  /// Ends it where it is, unless it is over.
  void close();
  void interrupt() { run_.interrupt(); }
  /// Throws Error{usage}.
  void set(std::size_t input, double effort);

  /// What another simulation goes on from. Throws Error{usage} once it is over.
  std::string checkpoint();

  /// The kept channels now, whose place in memory stays; `renewed` from now on after every call. Any time.
  const std::vector<double>& row(bool renewed);

  const OngoingRun& run() const { return run_; }
  /// Null until it is over.
  const std::shared_ptr<KeptRun>& ended() const { return ended_; }

 private:
  void require_going();
  void end();

  OngoingRun run_;
  std::shared_ptr<KeptRun> ended_;
  std::vector<double> row_;
  bool known_ = false, renews_ = false;
  std::atomic<bool> busy_{false};
};

}  // namespace freeplay
