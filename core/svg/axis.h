// Axis: a range of values along an edge of a picture, with round numbers on it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace freeplay::svg {

/// Distance of round numbers between two values: 1, 2 or 5 times a power of ten, so that there are about `count`.
/// Zero where the values do not differ or are no numbers.
double round_step(double least, double most, double count);
/// Multiples of round_step() from `least` to `most`, both included where they are ones.
std::vector<double> round_numbers(double least, double most, double count);

struct Axis {
  double from = 0.0, until = 1.0;  ///< at its ends
  std::vector<double> ticks;       ///< of the unit without prefix, as the ends
  std::vector<std::string> labels;
  std::string unit;  ///< of the labels, with a prefix; empty for numbers without unit
};

/// How much of an axis a range of values gets.
enum class Fit {
  exact,  ///< from the least value to the largest
  round   ///< out to round numbers
};

/// An axis of values from `least` to `most`; a range around them where they do not differ. The unit "1" is none.
Axis make_axis(double least, double most, std::string_view unit, double ticks, Fit fit);

}  // namespace freeplay::svg
