#include "results/repeat_summary.h"

#include <algorithm>
#include <utility>

namespace freeplay {
namespace {

constexpr const char* parts[] = {"joints", "drivers", "forces", "paths"};

/// Median, range and all of what runs found; null where none did.
Json spread(std::vector<Json> values, std::size_t runs) {
  values.resize(runs);
  std::vector<double> known;
  for (const Json& value : values) {
    if (value.is_number()) known.push_back(value.get<double>());
  }
  if (known.empty()) return {{"median", nullptr}, {"min", nullptr}, {"max", nullptr}, {"values", values}};
  std::ranges::sort(known);
  const std::size_t middle = known.size() / 2;
  const double median = known.size() % 2 == 1 ? known[middle] : 0.5 * (known[middle - 1] + known[middle]);
  return {{"median", median}, {"min", known.front()}, {"max", known.back()}, {"values", values}};
}

}  // namespace

RepeatSummary::RepeatSummary(std::size_t runs, std::uint64_t seed, double moved)
    : runs_(runs), seed_(seed), moved_(moved) {}

Json RepeatSummary::figures_of(const Json& summary) {
  Json figures = Json::object();
  for (const char* part : parts) {
    if (summary.contains(part)) figures[part] = summary[part];
  }
  return figures;
}

void RepeatSummary::add(std::size_t run, const Json& figures) {
  ++completed_;
  known_runs_ = std::max(known_runs_, run + 1);
  // Summaries of one model have the same numbers in the same order.
  std::size_t next = 0;
  for (const auto& [part, elements] : figures.items()) {
    for (const auto& [element, quantities] : elements.items()) {
      for (const auto& [quantity, value] : quantities.items()) {
        if (!value.is_number() && !value.is_null()) continue;
        if (next == figures_.size()) figures_.push_back({part, element, quantity, {}});
        std::vector<Json>& values = figures_[next++].values;
        if (values.size() <= run) values.resize(run + 1);
        values[run] = value;
      }
    }
  }
}

void RepeatSummary::fail(std::size_t run, int exit_code, const std::string& reason) {
  failures_.push_back({run, exit_code, reason});
}

std::vector<RepeatSummary::Failure> RepeatSummary::sorted_failures() const {
  std::vector<Failure> sorted = failures_;
  std::ranges::sort(sorted, {}, &Failure::run);
  return sorted;
}

Json RepeatSummary::json() const {
  Json failed = Json::array();
  for (const Failure& failure : sorted_failures()) {
    failed.push_back({{"run", failure.run + 1}, {"exit_code", failure.exit_code}, {"reason", failure.reason}});
  }
  Json out = {
      {"runs", runs_}, {"seed", seed_}, {"moved", moved_}, {"completed", completed_}, {"failed", std::move(failed)}};
  for (const char* part : parts) out[part] = Json::object();
  Json* element = nullptr;
  const Figure* last = nullptr;
  for (const Figure& figure : figures_) {
    if (last == nullptr || last->part != figure.part || last->element != figure.element) {
      element = &append(out[figure.part], figure.element, Json::object());
    }
    append(*element, figure.quantity, spread(figure.values, known_runs_));
    last = &figure;
  }
  return out;
}

}  // namespace freeplay
