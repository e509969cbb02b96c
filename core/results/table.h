// ResultTable: rows of a run in memory.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace freeplay {

/// Columns of numbers over time; an empty field is NaN.
struct ResultTable {
  std::vector<std::string> names;           ///< of the columns; the first is "time"
  std::vector<std::vector<double>> values;  ///< by column, all of one length

  const std::vector<double>& time() const { return values.front(); }
  /// Index of a column, or -1.
  int find(std::string_view name) const;
};

}  // namespace freeplay
