#include "study/table_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/name_pattern.h"
#include "base/suggestion.h"
#include "results/difference_sum.h"
#include "study/table_rows.h"

namespace freeplay {
namespace {

constexpr double empty_cell = std::numeric_limits<double>::quiet_NaN();

/// Columns of reducers of a study, and whether its points failed.
std::vector<std::string> compared_columns(const OpenStudy& study) {
  std::vector<std::string> names;
  for (const StudyColumn& column : study.columns().table) names.push_back(column.name);
  names.emplace_back("exit_code");
  return names;
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

class TableComparer {
 public:
  TableComparer(const ComparedStudy& a, const ComparedStudy& b, const ComparisonRules& rules)
      : a_(a), b_(b), rules_(rules), same_points_(a.study.plan().identity() == b.study.plan().identity()) {}

  Comparison compare() {
    require_columns();
    TableRows first(a_.folder), second(b_.folder);
    pair_columns(first, second);
    for (; second.next();) places_.emplace(key(b_, second.index()), second.place());
    while (first.next()) go_on(first, second);
    note_alone(alone_, first_alone_, a_, b_);
    note_alone(places_.size(), std::nullopt, b_, a_);
    if (result_.rows == 0) refuse_nothing();
    judge();
    return std::move(result_);
  }

 private:
  bool wanted(const std::string& name) const {
    return std::ranges::any_of(rules_.channels, [&](const std::string& pattern) { return matches(pattern, name); });
  }

  void require_columns() const {
    std::vector<std::string> names = compared_columns(a_.study);
    const std::vector<std::string> others = compared_columns(b_.study);
    names.insert(names.end(), others.begin(), others.end());
    for (const std::string& pattern : rules_.channels) {
      if (std::ranges::any_of(names, [&](const std::string& name) { return matches(pattern, name); })) continue;
      const auto nearest = suggestion(pattern, names);
      throw Error(Error::Category::usage, "unknown-channel", fmt::format("no column fits --channels '{}'", pattern), {},
                  nearest ? fmt::format("did you mean '{}'?", *nearest) : "");
    }
  }

  void pair_columns(const TableRows& first, const TableRows& second) {
    const auto place_in = [](const TableRows& table, const std::string& name) {
      return static_cast<std::size_t>(std::ranges::find(table.columns(), name) - table.columns().begin());
    };
    const std::vector<std::string> ours = compared_columns(a_.study), theirs = compared_columns(b_.study);
    for (const std::string& name : ours) {
      if (!wanted(name)) continue;
      if (!has(theirs, name)) {
        note_missing(name, b_);
        continue;
      }
      sums_.emplace_back(name, std::vector{sums_.size() + 1});
      columns_.emplace_back(place_in(first, name), place_in(second, name));
    }
    for (const std::string& name : theirs) {
      if (wanted(name) && !has(ours, name)) note_missing(name, a_);
    }
    row_a_.resize(sums_.size() + 1);
    row_b_.resize(sums_.size() + 1);
  }

  void note_missing(const std::string& name, const ComparedStudy& in) {
    result_.missing.push_back(fmt::format("column '{}' is missing in {}", name, in.folder.string()));
    alone_columns_.push_back({name, empty_cell, empty_cell, empty_cell, empty_cell, false});
  }

  /// The same in both for the same run.
  std::string key(const ComparedStudy& of, std::uint64_t index) const {
    return same_points_ ? fmt::format("{}", index) : of.study.plan().hash(index);
  }

  void go_on(const TableRows& first, TableRows& second) {
    const auto partner = places_.find(key(a_, first.index()));
    if (partner == places_.end()) {
      if (alone_++ == 0) first_alone_ = first.index();
      return;
    }
    second.read(partner->second);
    places_.erase(partner);
    row_a_[0] = row_b_[0] = static_cast<double>(first.index());
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      row_a_[i + 1] = value(first, columns_[i].first);
      row_b_[i + 1] = value(second, columns_[i].second);
      sums_[i].add(row_a_, row_b_);
    }
    ++result_.rows;
  }

  static double value(const TableRows& table, std::size_t column) {
    return column < table.cells().size() ? number_of_cell(table.cells()[column]) : empty_cell;
  }

  void note_alone(std::size_t points, const std::optional<std::uint64_t>& first, const ComparedStudy& in,
                  const ComparedStudy& other) {
    if (points == 0) return;
    result_.aside.push_back(fmt::format("{} points of {}{} are not in {}", points, in.folder.string(),
                                        first ? fmt::format(" (first {})", *first) : "", other.folder.string()));
  }

  [[noreturn]] void refuse_nothing() const {
    throw Error(Error::Category::input, "nothing-in-common",
                fmt::format("no point of '{}' is a point of '{}': nothing can be compared", a_.folder.string(),
                            b_.folder.string()),
                {}, "a point is the same where its model, the files that this reads and all settings are");
  }

  void judge() {
    std::vector<double> weights;
    for (const DifferenceSum& sum : sums_) {
      result_.channels.push_back(sum.difference(result_.rows, rules_));
      weights.push_back(weight(result_.channels.back().largest, sum.allowed(rules_)));
    }
    for (Difference& alone : alone_columns_) {
      result_.channels.push_back(std::move(alone));
      weights.push_back(std::numeric_limits<double>::infinity());
    }
    result_.channels = worst_first(result_.channels, weights);
  }

  const ComparedStudy& a_;
  const ComparedStudy& b_;
  const ComparisonRules& rules_;
  const bool same_points_;
  std::unordered_multimap<std::string, std::uint64_t> places_;  // rows of b that have no partner yet
  std::vector<DifferenceSum> sums_;
  std::vector<std::pair<std::size_t, std::size_t>> columns_;  // in the tables of a and b, by sum
  std::vector<double> row_a_, row_b_;
  std::vector<Difference> alone_columns_;
  std::size_t alone_ = 0;
  std::optional<std::uint64_t> first_alone_;
  Comparison result_;
};

}  // namespace

Comparison compare_tables(const ComparedStudy& a, const ComparedStudy& b, const ComparisonRules& rules) {
  return TableComparer(a, b, rules).compare();
}

}  // namespace freeplay
