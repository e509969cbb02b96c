// Comparison: how far two results agree.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "results/table.h"

namespace freeplay {

struct ComparisonRules {
  double relative = 1e-6, absolute = 1e-12;  ///< |a - b| <= absolute + relative max |a|
  std::vector<std::string> channels{"*"};    ///< patterns; `*` stands for any run of characters
  double from = -std::numeric_limits<double>::infinity(), until = std::numeric_limits<double>::infinity();  ///< [s]
};

/// One channel of both results, or of one alone: then all numbers are NaN.
struct ChannelDifference {
  std::string name;
  double largest = 0.0;   ///< largest |a - b|, NaN where one has a number and the other has none, or without rows
  double relative = 0.0;  ///< largest |a - b| over the largest |a|
  double rms = 0.0;       ///< of a - b over the rows
  double at_time = 0.0;   ///< of the largest [s]
  bool agrees = true;
};

struct Comparison {
  std::vector<ChannelDifference> channels;  ///< worst first: largest |a - b| over what is allowed
  std::vector<std::string> missing;         ///< sentences: channels or rows that only one of them has
  std::size_t rows = 0;                     ///< compared
  bool interpolated = false;                ///< instants differ: b was interpolated linearly

  bool agree() const;
};

/// Compares a with b at the times of a. Times are the same to 1e-9 of the interval between rows.
/// Throws Error{usage} when a pattern fits no channel.
Comparison compare(const ResultTable& a, const ResultTable& b, const ComparisonRules& rules);

}  // namespace freeplay
