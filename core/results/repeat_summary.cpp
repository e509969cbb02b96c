#include "results/repeat_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace freeplay {
namespace {

constexpr const char* parts[] = {"joints", "drivers", "forces", "paths"};

/// Calls `take` with the places and values of the numbers in the parts of a summary that are kept, in order.
template <class Take>
void each_figure(const Json& summary, const Take& take) {
  for (const char* part : parts) {
    if (!summary.contains(part)) continue;
    for (const auto& [element, quantities] : summary[part].items()) {
      for (const auto& [quantity, value] : quantities.items()) {
        if (value.is_number() || value.is_null()) take(part, element, quantity, value);
      }
    }
  }
}

/// Median, range and all of what runs found; null where none did.
Json spread(const std::vector<double>& found, bool whole) {
  Json values = Json::array();
  std::vector<double> known;
  for (const double value : found) {
    values.push_back(whole && std::isfinite(value) ? Json(static_cast<std::int64_t>(value)) : json_number(value));
    if (std::isfinite(value)) known.push_back(value);
  }
  if (known.empty()) return {{"median", nullptr}, {"min", nullptr}, {"max", nullptr}, {"values", std::move(values)}};
  std::ranges::sort(known);
  const std::size_t middle = known.size() / 2;
  const double median = known.size() % 2 == 1 ? known[middle] : 0.5 * (known[middle - 1] + known[middle]);
  return {{"median", median}, {"min", known.front()}, {"max", known.back()}, {"values", std::move(values)}};
}

}  // namespace

RepeatSummary::RepeatSummary(std::size_t runs, std::uint64_t seed, StartChange change)
    : runs_(runs), seed_(seed), change_(change) {}

std::vector<double> RepeatSummary::values_of(const Json& summary) {
  std::vector<double> values;
  each_figure(summary, [&](const char*, const std::string&, const std::string&, const Json& value) {
    values.push_back(value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN());
  });
  return values;
}

void RepeatSummary::add(std::size_t run, std::vector<double> values) {
  ++completed_;
  if (values_.size() <= run) values_.resize(run + 1);
  values_[run] = std::move(values);
}

void RepeatSummary::fail(std::size_t run, int exit_code, const std::string& reason) {
  failures_.push_back({run, exit_code, reason});
}

std::vector<RepeatSummary::Failure> RepeatSummary::sorted_failures() const {
  std::vector<Failure> sorted = failures_;
  std::ranges::sort(sorted, {}, &Failure::run);
  return sorted;
}

Json RepeatSummary::json(const Json& first) const {
  Json failed = Json::array();
  for (const Failure& failure : sorted_failures()) {
    failed.push_back({{"run", failure.run + 1}, {"exit_code", failure.exit_code}, {"reason", failure.reason}});
  }
  Json out = {{"runs", runs_},           {"seed", seed_},
              {"moved", change_.moved},  {"pushed", change_.pushed},
              {"completed", completed_}, {"failed", std::move(failed)}};
  for (const char* part : parts) out[part] = Json::object();
  if (completed_ == 0) return out;
  Json* place = nullptr;
  const char* last_part = nullptr;
  std::string last_element;
  std::size_t number = 0;
  each_figure(first, [&](const char* part, const std::string& element, const std::string& quantity, const Json& value) {
    if (part != last_part || element != last_element) place = &append(out[part], element, Json::object());
    last_part = part;
    last_element = element;
    std::vector<double> found(values_.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t run = 0; run < found.size(); ++run) {
      if (number < values_[run].size()) found[run] = values_[run][number];
    }
    append(*place, quantity, spread(found, value.is_number_integer()));
    ++number;
  });
  return out;
}

}  // namespace freeplay
