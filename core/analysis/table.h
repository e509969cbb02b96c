// AnalysisTable: the rows of an analysis, as CSV and JSON.
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "base/json_text.h"

namespace freeplay {

/// A number (NaN or infinite: empty), or a word.
using AnalysisCell = std::variant<double, std::string>;

struct AnalysisTable {
  std::vector<std::string> columns;
  std::vector<std::string> units;  ///< of the columns; "1" also of words
  std::vector<std::vector<AnalysisCell>> rows;
  Json summary = Json::object();

  void add_column(std::string name, std::string unit);
  /// `beat` is called now and then; what it throws comes through.
  std::string csv(const std::function<void()>& beat = {}) const;
  /// {"kind", "columns", "rows", "summary"}; rows are lists in column order, null for empty.
  Json json(const std::string& kind) const;
};

}  // namespace freeplay
