// Comparison: how far two results agree.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "results/reader.h"

namespace freeplay {

struct ComparisonRules {
  double relative = 1e-6, absolute = 1e-12;  ///< |a - b| <= absolute + relative max |a|
  std::vector<std::string> channels{"*"};    ///< patterns; `*` stands for any run of characters
  double from = -std::numeric_limits<double>::infinity(), until = std::numeric_limits<double>::infinity();  ///< [s]
};

/// Of a channel of both results, or of one alone: then all numbers are NaN; or of a place, the vector of some channels,
/// with the lengths of vectors for absolute values.
struct Difference {
  std::string name;
  double largest = 0.0;   ///< largest |a - b|, NaN where one has a number and the other has none, or without rows
  double relative = 0.0;  ///< largest |a - b| over the largest |a|
  double rms = 0.0;       ///< of a - b over the rows
  double at_time = 0.0;   ///< of the largest [s]
  bool agrees = true;     ///< of a place: its channels do
};

struct Comparison {
  std::vector<Difference> channels;  ///< worst first: largest |a - b| over what is allowed
  /// Distances [m] of the bodies and frames whose x and y, and in space z, were compared, largest rms first; their
  /// names are "body.rod.distance", "frame.rod/tip.distance".
  std::vector<Difference> distances;
  Difference distance;               ///< of them all: rms over rows, bodies and frames; the rest of the farthest one
  std::string farthest;              ///< its name; empty without distances
  std::vector<std::string> missing;  ///< sentences: channels or rows that only one of them has
  std::size_t rows = 0;              ///< compared
  bool interpolated = false;         ///< instants differ: b was interpolated linearly
  std::vector<std::string> aside{};  ///< sentences: what is not compared, and is no difference

  bool agree() const;
};

/// Compares a with b at the times of a. Times are the same to 1e-9 of the interval between rows.
/// Throws Error{usage} "unknown-channel" when a pattern fits no channel.
Comparison compare(ResultReader& a, ResultReader& b, const ComparisonRules& rules);

}  // namespace freeplay
