#include "results/comparison.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/name_pattern.h"
#include "base/suggestion.h"
#include "results/difference_sum.h"
#include "results/row_pairs.h"

namespace freeplay {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class Comparer {
 public:
  Comparer(ResultReader& a, ResultReader& b, const ComparisonRules& rules) : a_(a), b_(b), rules_(rules) {}

  Comparison compare() {
    require_channels();
    pair_columns();
    find_places();
    go_through_rows();
    judge_channels();
    judge_places();
    return std::move(result_);
  }

 private:
  bool wanted(const std::string& name) const {
    return std::ranges::any_of(rules_.channels, [&](const std::string& pattern) { return matches(pattern, name); });
  }

  static std::span<const RecordColumn> channels_of(const ResultReader& reader) {
    return std::span(reader.layout().columns).subspan(1);
  }

  void require_channels() const {
    std::vector<std::string> names;
    for (const ResultReader* reader : {&a_, &b_}) {
      for (const RecordColumn& column : channels_of(*reader)) names.push_back(column.name);
    }
    for (const std::string& pattern : rules_.channels) {
      const bool fits = std::ranges::any_of(names, [&](const std::string& name) { return matches(pattern, name); });
      if (fits) continue;
      const auto nearest = suggestion(pattern, names);
      throw Error(Error::Category::usage, "unknown-channel", fmt::format("no channel fits --channels '{}'", pattern),
                  {}, nearest ? fmt::format("did you mean '{}'?", *nearest) : "");
    }
  }

  using Names = std::unordered_map<std::string_view, std::size_t>;  // and where they stand

  static Names names_of(const ResultReader& reader) {
    Names names;
    const std::vector<RecordColumn>& columns = reader.layout().columns;
    for (std::size_t i = 1; i < columns.size(); ++i) names.emplace(columns[i].name, i);
    return names;
  }

  // The columns that both have, in the order of a.
  void pair_columns() {
    first_columns_ = second_columns_ = {0};
    for (const RecordColumn& column : channels_of(a_)) {
      const auto other = second_names_.find(column.name);
      if (other == second_names_.end() || !wanted(column.name)) continue;
      paired_.emplace(column.name, first_columns_.size());
      sums_.emplace_back(column.name, std::vector{first_columns_.size()});
      first_columns_.push_back(first_names_.at(column.name));
      second_columns_.push_back(other->second);
    }
  }

  void find_places() {
    for (const DifferenceSum& sum : sums_) {
      const std::string& name = sum.name();
      if (!name.ends_with(".x") || !(name.starts_with("body.") || name.starts_with("frame."))) continue;
      const std::string stem = name.substr(0, name.size() - 2);
      std::vector<std::size_t> columns;
      for (const char* axis : {".x", ".y", ".z"}) {
        if (const auto found = paired_.find(stem + axis); found != paired_.end()) columns.push_back(found->second);
      }
      const bool in_space = first_names_.contains(stem + ".z");
      if (columns.size() == (in_space ? 3U : 2U)) places_.emplace_back(stem + ".distance", std::move(columns));
    }
  }

  void go_through_rows() {
    RowPairs pairs(a_, first_columns_, b_, second_columns_, rules_.from, rules_.until);
    while (pairs.next()) {
      for (DifferenceSum& sum : sums_) sum.add(pairs.first(), pairs.second());
      for (DifferenceSum& place : places_) place.add(pairs.first(), pairs.second());
    }
    result_.rows = pairs.rows();
    result_.interpolated = pairs.interpolated();
    note_rows(pairs.first_alone(), a_, b_);
    note_rows(pairs.second_alone(), b_, a_);
    if (pairs.rows() == 0) result_.missing.push_back("no rows at common times");
  }

  void note_rows(std::size_t rows, const ResultReader& in, const ResultReader& outside) {
    if (rows == 0) return;
    result_.missing.push_back(
        fmt::format("{} rows of {} lie outside the times of {}", rows, in.file(), outside.file()));
  }

  void judge_channels() {
    std::vector<double> weights;
    for (const DifferenceSum& sum : sums_) {
      result_.channels.push_back(sum.difference(result_.rows, rules_));
      agrees_.push_back(result_.channels.back().agrees);
      weights.push_back(weight(result_.channels.back().largest, sum.allowed(rules_)));
    }
    const auto note_missing = [&](const ResultReader& in, const Names& there, const ResultReader& missing) {
      for (const RecordColumn& column : channels_of(in)) {
        if (!wanted(column.name) || there.contains(column.name)) continue;
        result_.missing.push_back(fmt::format("channel '{}' is missing in {}", column.name, missing.file()));
        result_.channels.push_back({column.name, nan, nan, nan, nan, false});
        weights.push_back(std::numeric_limits<double>::infinity());
      }
    };
    note_missing(a_, second_names_, b_);
    note_missing(b_, first_names_, a_);
    result_.channels = worst_first(result_.channels, weights);
  }

  void judge_places() {
    std::vector<double> weights;
    double squares = 0.0;
    for (const DifferenceSum& place : places_) {
      Difference one = place.difference(result_.rows, rules_);
      one.agrees = std::ranges::all_of(place.columns(), [&](std::size_t column) { return agrees_[column - 1] != 0; });
      squares += place.squares();
      weights.push_back(weight(one.rms, 1.0));
      result_.distances.push_back(std::move(one));
    }
    if (places_.empty()) return;
    const auto apart = [](const Difference& d) { return weight(d.largest, 1.0); };
    result_.distance = *std::ranges::max_element(result_.distances, {}, apart);
    result_.farthest = std::exchange(result_.distance.name, "distances");
    result_.distance.rms = std::sqrt(squares / static_cast<double>(result_.rows * places_.size()));
    result_.distance.agrees = std::ranges::all_of(result_.distances, &Difference::agrees);
    result_.distances = worst_first(result_.distances, weights);
  }

  ResultReader& a_;
  ResultReader& b_;
  const ComparisonRules& rules_;
  const Names first_names_ = names_of(a_), second_names_ = names_of(b_);
  Names paired_;                                             // places in the next lists
  std::vector<std::size_t> first_columns_, second_columns_;  // that both have, time first
  std::vector<DifferenceSum> sums_;                          // of these but time
  std::vector<DifferenceSum> places_;
  std::vector<char> agrees_;  // as sums_
  Comparison result_;
};

}  // namespace

bool Comparison::agree() const {
  return missing.empty() && std::ranges::all_of(channels, [](const Difference& d) { return d.agrees; });
}

Comparison compare(ResultReader& a, ResultReader& b, const ComparisonRules& rules) {
  return Comparer(a, b, rules).compare();
}

}  // namespace freeplay
