// LoadSwitches: on which side the switches of applied forces are, whose formulas depend on the motion.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/index.h"
#include "system/system.h"

namespace freeplay {

/// A formula keeps its form while a step is made: it goes on as it was, beyond a kink, too, and stays smooth. Where
/// steps end at events a side changes at one; else at the end of the step that went over it.
class LoadSwitches {
 public:
  explicit LoadSwitches(const System& system);

  int count() const { return static_cast<int>(events_.size()); }
  /// Their events: located, rising.
  Span<const Event> events() const { return {events_.data(), events_.size()}; }
  /// "force 'x'" or "driver 'x'", of whose formula it is.
  std::string words(int which) const { return system_.forces().applied().words_of_switch(which); }

  /// What a position may err by in a step [m]: what decides a switch passes zero by a small part of that before it is
  /// past it, so that what rests at zero but for rounding stays on its side.
  void allow(double error) { band_ = part_of_error * error; }
  /// A run or a step starts here: how what decides switches is measured.
  void look_from(const Point& start, const Evaluation& e);
  /// The functions of their events [m] and their rates [m/s].
  void functions(const Point& point, std::span<const double> a, const Evaluation& e, std::span<double> g,
                 std::span<double> rate);
  /// The last functions change by so much where the way to their zero does by 1 m: less than 1 where they began to be
  /// steeper.
  double unit(int which) const { return units_[at(which)]; }
  /// By so much [m] what decides a switch may be past its zero, as it is measured there.
  double band() const { return band_; }
  /// Takes the sides of this state into its history. Returns whether other forces act from here on.
  bool renew(State& state, const Evaluation& e);
  void change(int which, State& state) const {
    double& side = state.h()[at(slots_.offset + which)];
    side = -side;
  }

 private:
  static constexpr double part_of_error = 1e-3;

  const System& system_;
  Slice slots_;  ///< in h
  double band_ = 0.0;
  std::vector<Event> events_;
  std::vector<double> room_, scale_, scale_here_, sides_, units_;
  std::vector<char> even_;  ///< what decides it changes with the motion as it does where the step starts
};

}  // namespace freeplay
