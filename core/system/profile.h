// Profile: where the time of a run goes. The parts that do the work hold a pointer to one, which is null where it is
// not wanted: then a timer is one comparison, and no clock is read.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>

namespace freeplay {

/// What a run may be doing. Each moment belongs to one phase: that of the innermost timer, but for start, output
/// and events, to which everything belongs that is done for them.
enum class Phase {
  rest,           ///< the loop itself
  start,          ///< accelerations at the start; orders of unknowns and dependent rows are found there
  integrator,     ///< formulas of the method, norms and vectors of the iteration
  assembly,       ///< kinematics, motions of drivers, rows of constraints
  joints,         ///< forces of joints and contacts with their derivatives, what joints keep
  factorization,  ///< matrices filled in and factored
  solution,       ///< solved with their factors
  events,         ///< looked for and recorded
  statistics,     ///< all channels, energy and statistics of every accepted step
  output,         ///< rows: states between steps, channels, handed to the files
};

/// Not for several threads.
class Profile {
 public:
  static constexpr std::size_t phases = 10;

  class Timer {
   public:
    Timer(Profile* profile, Phase phase) : profile_(profile) {
      if (profile_ != nullptr) before_ = profile_->enter(phase);
    }
    ~Timer() {
      if (profile_ != nullptr) profile_->change(before_);
    }
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

   private:
    Profile* profile_;
    Phase before_ = Phase::rest;
  };

  /// Time counts from here on.
  void start() { last_ = Clock::now(); }
  /// Time up to now is counted.
  void stop() { count_time(); }

  double seconds(Phase phase) const { return std::chrono::duration<double>(spent_[index(phase)]).count(); }
  double total() const {
    Clock::duration sum{};
    for (const Clock::duration spent : spent_) sum += spent;
    return std::chrono::duration<double>(sum).count();
  }
  /// How often the phase was entered, by itself or inside of another.
  long count(Phase phase) const { return counts_[index(phase)]; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t index(Phase phase) { return static_cast<std::size_t>(phase); }

  Phase enter(Phase phase) {
    ++counts_[index(phase)];
    const bool keeps_all = phase_ == Phase::start || phase_ == Phase::output || phase_ == Phase::events;
    return keeps_all ? phase_ : change(phase);
  }
  Phase change(Phase phase) {
    const Phase before = phase_;
    if (phase != before) count_time();
    phase_ = phase;
    return before;
  }
  void count_time() {
    const Clock::time_point now = Clock::now();
    spent_[index(phase_)] += now - last_;
    last_ = now;
  }

  std::array<Clock::duration, phases> spent_{};
  std::array<long, phases> counts_{};
  Clock::time_point last_{};
  Phase phase_ = Phase::rest;
};

}  // namespace freeplay
