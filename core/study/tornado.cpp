#include "study/tornado.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/number_text.h"
#include "study/picture_page.h"
#include "study/rank_correlation.h"
#include "study/table_columns.h"

namespace freeplay {
namespace {

struct Bar {
  std::string name;
  double from, until;
};

class Tornado {
 public:
  Tornado(const StudyPlan& plan, const std::filesystem::path& file, const std::string& value)
      : plan_(plan), columns_(file, names(plan, value)), values_(columns_.numbers(value)) {}

  /// Of random axes.
  std::vector<Bar> ranks() const {
    const std::vector<std::string> combinations = this->combinations();
    std::vector<Bar> bars;
    for (const AxisColumn& column : plan_.axis_columns()) {
      if (!column.random) continue;
      const double rank = rank_correlation(columns_.numbers(column.name), values_, combinations);
      bars.push_back({column.name, std::min(0.0, rank), std::max(0.0, rank)});
    }
    return bars;
  }

  /// Of the others.
  std::vector<Bar> ranges() const {
    std::vector<Bar> bars;
    for (const AxisColumn& column : plan_.axis_columns()) {
      if (!column.random) add_range(column.name, bars);
    }
    return bars;
  }

 private:
  static std::vector<std::string> names(const StudyPlan& plan, const std::string& value) {
    std::vector<std::string> names{value};
    for (const AxisColumn& column : plan.axis_columns()) names.push_back(column.name);
    if (plan.has_model_column()) names.emplace_back("model");
    return names;
  }

  /// What a row has besides its random numbers: correlations are within it.
  std::vector<std::string> combinations() const {
    std::vector<std::string> combinations(values_.size());
    const auto add = [&](const std::string& name) {
      for (std::size_t i = 0; i < values_.size(); ++i) combinations[i] += columns_.words(name)[i] + ",";
    };
    for (const AxisColumn& column : plan_.axis_columns()) {
      if (!column.random) add(column.name);
    }
    if (plan_.has_model_column()) add("model");
    return combinations;
  }

  /// Does the row set no axis, as the first one of a star?
  bool sets_nothing(std::size_t row) const {
    return std::ranges::all_of(plan_.axis_columns(),
                               [&](const AxisColumn& column) { return columns_.words(column.name)[row].empty(); });
  }

  void add_range(const std::string& name, std::vector<Bar>& bars) const {
    std::map<std::string, std::pair<double, double>> means;  // sum and count
    const bool star = plan_.section().combine == StudySection::Combine::star;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const std::string& word = columns_.words(name)[i];
      if (!std::isfinite(values_[i]) || (word.empty() && !(star && sets_nothing(i)))) continue;
      means[word].first += values_[i];
      means[word].second += 1.0;
    }
    if (means.empty()) return;
    Bar bar{name, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const auto& entry : means) {
      bar.from = std::min(bar.from, entry.second.first / entry.second.second);
      bar.until = std::max(bar.until, entry.second.first / entry.second.second);
    }
    bars.push_back(bar);
  }

  const StudyPlan& plan_;
  TableColumns columns_;
  std::vector<double> values_;
};

PicturePage page_of(std::vector<Bar> bars, const std::string& title, const std::string& value,
                    const std::string& unit) {
  std::ranges::stable_sort(bars, {}, [](const Bar& bar) { return bar.until - bar.from; });
  std::vector<double> ends;
  std::vector<std::string> words;
  for (const Bar& bar : bars) {
    ends.insert(ends.end(), {bar.from, bar.until});
    words.push_back(bar.name);
  }
  PicturePage page(title, PictureScale(value, ends, unit, svg::Fit::round), PictureScale("axis", words));
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const auto at = static_cast<double>(i);
    page.tile(bars[i].from, bars[i].until, at - 0.35, at + 0.35, 0, PicturePage::colour(0),
              fmt::format("{} {} to {}", bars[i].name, number_text(bars[i].from), number_text(bars[i].until)));
  }
  return page;
}

}  // namespace

std::string tornado_picture(const StudyPlan& plan, const std::filesystem::path& file, const std::string& value,
                            const std::string& unit) {
  const Tornado tornado(plan, file, value);
  const std::vector<Bar> ranks = tornado.ranks(), ranges = tornado.ranges();
  std::vector<PicturePage> pages;
  if (!ranks.empty())
    pages.push_back(page_of(ranks, plan.name() + ": rank correlation with " + value, "rank correlation", ""));
  if (!ranges.empty() || pages.empty())
    pages.push_back(page_of(ranges, plan.name() + ": range of the means of " + value, value, unit));
  return PicturePage::stacked(pages);
}

}  // namespace freeplay
