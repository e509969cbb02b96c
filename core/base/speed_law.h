// SpeedLaw: the way that a motion with bounded acceleration, or jerk, has gone, as a fraction of the whole.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace freeplay {

/// A motion from rest to rest. Speed grows over `ramp`, is constant, and falls over `ramp`. With `rise` 0 it does so
/// evenly (a trapezoid); else acceleration grows evenly over `rise`, is constant and falls over `rise` (an S-curve of
/// seven parts). All in the unit of what it is a function of, such as s.
struct SpeedLaw {
  double start, end, ramp, rise = 0.0;

  /// What is wrong with which of the four, in that order; none if 2 ramp <= end - start and 2 rise <= ramp, but for
  /// rounding, and the rise of a curved one is positive.
  struct Flaw {
    std::size_t which;
    std::string reason;
  };
  std::optional<Flaw> flaw(bool curved) const;

  /// The fraction as a program for a stack: 0 before the start, 1 after the end.
  enum class Step { minimum, maximum, subtract, multiply, add, argument, constant };
  struct Instruction {
    Step step;
    double constant = 0.0;
  };
  std::vector<Instruction> program() const;
};

}  // namespace freeplay
