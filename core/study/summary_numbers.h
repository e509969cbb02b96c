// SummaryNumbers: the numbers of summary.json by their paths.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/json_text.h"
#include "study/reducer_entry.h"

namespace freeplay {

/// Every number and every null of a summary, "joints.leg1.B.max_force"; what differs between runs of one point
/// (`performance`) is left out.
class SummaryNumbers {
 public:
  explicit SummaryNumbers(const Json& summary);

  /// A path, or with `over` a pattern, in which `*` stands for any run of characters. NaN where there is none.
  double number(const std::string& path, const std::optional<ReducerEntry::Over>& over) const;
  bool has(const std::string& path) const;
  /// The path that was probably meant, or empty.
  std::string nearest_to(const std::string& path) const;

 private:
  void add(const std::string& path, const Json& value);

  std::vector<std::pair<std::string, double>> all_;
};

}  // namespace freeplay
