#include "study/summary_numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/name_pattern.h"
#include "base/suggestion.h"

namespace freeplay {
namespace {
constexpr double absent = std::numeric_limits<double>::quiet_NaN();
}  // namespace

SummaryNumbers::SummaryNumbers(const Json& summary) {
  for (const auto& [key, value] : summary.items()) {
    if (key != "performance") add(key, value);
  }
}

void SummaryNumbers::add(const std::string& path, const Json& value) {
  if (value.is_object()) {
    for (const auto& [key, below] : value.items()) add(path + "." + key, below);
  } else if (value.is_number() || value.is_null()) {
    all_.emplace_back(path, value.is_null() ? absent : value.get<double>());
  }
}

double SummaryNumbers::number(const std::string& path, const std::optional<ReducerEntry::Over>& over) const {
  double low = absent, high = absent, sum = 0.0;
  long count = 0;
  for (const auto& [name, value] : all_) {
    if (std::isnan(value) || !(over ? matches(path, name) : path == name)) continue;
    low = std::fmin(low, value);
    high = std::fmax(high, value);
    sum += value;
    ++count;
  }
  if (!over) return high;
  switch (*over) {
    case ReducerEntry::Over::max:
      return high;
    case ReducerEntry::Over::min:
      return low;
    case ReducerEntry::Over::sum:
      return count > 0 ? sum : absent;
    case ReducerEntry::Over::mean:
      break;
  }
  return count > 0 ? sum / static_cast<double>(count) : absent;
}

bool SummaryNumbers::has(const std::string& path) const {
  return std::ranges::any_of(all_, [&](const auto& one) { return matches(path, one.first); });
}

std::string SummaryNumbers::nearest_to(const std::string& path) const {
  std::vector<std::string> names;
  for (const auto& [name, value] : all_) names.push_back(name);
  return nearest(path, names);
}

}  // namespace freeplay
