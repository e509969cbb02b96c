// FigureText: a number of a table with as many digits as mean something.
#pragma once

#include <string>

#include "base/json_text.h"

namespace freeplay {

/// How a number looks where nothing is known against its digits.
struct FigureStyle {
  int digits = 4;
  bool prefixed = false;  ///< with the prefix that leaves one to three digits before the point
};

/// "12.93 N"; "-" where there is none. With a `noise` of the same unit no more digits than it leaves, and from half a
/// per cent on the noise itself: "12.9 +- 0.8 kN".
std::string figure_text(double value, const char* unit, double noise = 0.0, FigureStyle style = {});

/// A number of events, "162" or "160 +- 30", and a part of the time, "71.7 %" or "72 +- 6 %"; noise as the number
/// itself.
std::string count_text(long count, double noise);
std::string share_text(double part, double noise);

/// "12.9 kN (12.0 to 15.6 in 8 runs)" of what repeated runs found: median and range, with the digits that the range
/// leaves, at least three; counts, which have no unit, are whole.
std::string range_text(const Json& spread, const char* unit);

}  // namespace freeplay
