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
#include "results/row_pairs.h"

namespace freeplay {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double length(std::span<const double> vector) {
  return vector.size() == 1   ? std::abs(vector[0])
         : vector.size() == 2 ? std::hypot(vector[0], vector[1])
                              : std::hypot(vector[0], vector[1], vector[2]);
}

/// Adds up how far one channel, or a place of two or three, is apart.
class DifferenceSum {
 public:
  DifferenceSum(std::string name, std::vector<std::size_t> columns) : columns_(std::move(columns)) {
    difference_.name = std::move(name);
  }

  void add(std::span<const double> a, std::span<const double> b) {
    if (std::isnan(difference_.largest)) return;
    double off[3], value[3];
    std::size_t known = 0;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const double x = a[columns_[i]], y = b[columns_[i]];
      const bool nothing = std::isnan(x) && std::isnan(y);
      off[i] = nothing || x == y ? 0.0 : x - y;
      value[i] = nothing ? 0.0 : x;
      known += nothing ? 0 : 1;
    }
    if (known == 0) return;
    size_ = std::fmax(size_, length({value, columns_.size()}));
    const double apart = length({off, columns_.size()});
    squares_ += apart * apart;
    if (!(apart <= difference_.largest)) difference_.largest = apart, difference_.at_time = a.front();
  }

  const std::string& name() const { return difference_.name; }
  double squares() const { return squares_; }
  double allowed(const ComparisonRules& rules) const { return rules.absolute + rules.relative * size_; }
  std::span<const std::size_t> columns() const { return columns_; }

  /// `agrees` as a channel does.
  Difference difference(std::size_t rows, const ComparisonRules& rules) const {
    Difference out = difference_;
    out.relative = out.largest == 0.0 ? 0.0 : out.largest / size_;
    out.rms = std::sqrt(squares_ / static_cast<double>(rows));
    if (rows == 0) out.largest = out.relative = out.at_time = nan;
    out.agrees = out.largest <= allowed(rules);
    return out;
  }

 private:
  Difference difference_;
  std::vector<std::size_t> columns_;
  double size_ = 0.0, squares_ = 0.0;
};

/// Larger is worse; what has no number is worst.
double weight(double amount, double allowed) {
  if (std::isnan(amount)) return std::numeric_limits<double>::infinity();
  return amount == 0.0 ? 0.0 : amount / allowed;
}

std::vector<Difference> worst_first(std::span<const Difference> list, std::span<const double> weights) {
  std::vector<std::size_t> order(list.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, [&](std::size_t i, std::size_t k) { return weights[i] > weights[k]; });
  std::vector<Difference> sorted;
  for (const std::size_t i : order) sorted.push_back(list[i]);
  return sorted;
}

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
