// StudyOutcome: what one point of a study gives.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace freeplay {

/// A column of the table that reducers fill.
struct StudyColumn {
  std::string name, unit;  ///< unit: of SI, "1" without a dimension

  friend bool operator==(const StudyColumn&, const StudyColumn&) = default;
};

/// Of the table, and of the reducers that give many values.
struct StudyColumns {
  std::vector<StudyColumn> table, samples;
};

struct StudyOutcome {
  int exit_code = 0;
  std::string error, message;               ///< message id and text of a failed point, one line without paths or times
  double wall = 0.0, cpu = 0.0, run = 0.0;  ///< [s]; run: stepping alone
  std::vector<double> values{};             ///< one a column; NaN: empty. All are of a failed point
  /// Time [s] and value, a list for each column of StudyColumns::samples.
  std::vector<std::vector<std::pair<double, double>>> samples{};
  std::string start{};  ///< "cold" or "warm" in a chain, else empty
  std::string state{};  ///< after the point, in a chain: letters and digits alone; empty after a failed point
};

}  // namespace freeplay
