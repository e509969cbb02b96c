#include "study/picture.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/number_text.h"
#include "format/study_axis.h"
#include "study/percentile_ranks.h"
#include "study/picture_page.h"
#include "study/table_columns.h"
#include "study/tornado.h"

namespace freeplay {
namespace {

constexpr double interval_confidence = 0.95;

using Pairs = std::vector<std::pair<double, double>>;

/// Value below which a part of the sorted numbers lies, straight between two.
double quantile(const std::vector<double>& sorted, double part) {
  const double place = part * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (place - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

std::vector<std::string> distinct(const std::vector<std::string>& words) {
  std::vector<std::string> names;
  for (const std::string& word : words) {
    if (std::ranges::find(names, word) == names.end()) names.push_back(word);
  }
  return names;
}

class Drawing {
 public:
  Drawing(const OpenStudy& study, const std::filesystem::path& folder, const PictureRequest& request)
      : study_(study), folder_(folder), request_(request) {}

  std::string draw() {
    switch (request_.kind) {
      case PictureRequest::Kind::line:
        return line();
      case PictureRequest::Kind::heat:
        return heat();
      case PictureRequest::Kind::bifurcation:
        return bifurcation();
      case PictureRequest::Kind::histogram:
        return histogram();
      default:
        return tornado();
    }
  }

 private:
  std::string unit_of(const std::string& name) const {
    for (const AxisColumn& column : study_.plan().axis_columns()) {
      if (column.name == name) return column.unit;
    }
    for (const StudyColumn& column : study_.layout().columns) {
      if (column.name == name) return column.unit;
    }
    return "";
  }
  bool has_words(const std::string& name) const {
    if (name == "model" || name == "direction") return true;
    return std::ranges::any_of(study_.plan().axis_columns(),
                               [&](const AxisColumn& column) { return column.name == name && column.words; });
  }
  std::string title(const std::string& words) const { return fmt::format("{}: {}", study_.plan().name(), words); }
  const std::string& needed(const std::string& name, const char* key) const {
    if (!name.empty()) return name;
    throw Error(Error::Category::input, "missing-key", fmt::format("plot '{}' needs `{}`", request_.name, key));
  }
  TableColumns table(std::vector<std::string> names) const {
    if (!request_.by.empty()) names.push_back(request_.by);
    names.emplace_back("index");
    return TableColumns(folder_ / "study.csv", names);
  }
  std::vector<std::string> families(const TableColumns& columns) const {
    return request_.by.empty() ? std::vector<std::string>(columns.rows()) : columns.words(request_.by);
  }
  /// In a legend.
  std::vector<std::string> shown(const std::vector<std::string>& names) const {
    return request_.by.empty() ? std::vector<std::string>() : names;
  }
  /// The column as places along a scale.
  std::pair<PictureScale, std::vector<double>> scale_of(const TableColumns& columns, const std::string& name) const {
    if (!has_words(name)) {
      std::vector<double> values = columns.numbers(name);
      return {PictureScale(name, values, unit_of(name), svg::Fit::exact), std::move(values)};
    }
    PictureScale scale(name, distinct(columns.words(name)));
    std::vector<double> values;
    for (const std::string& word : columns.words(name)) values.push_back(scale.value_of(word));
    return {std::move(scale), std::move(values)};
  }

  std::string line() const {
    const std::string& y_name = needed(request_.y.empty() ? request_.value : request_.y, "y");
    const TableColumns columns = table({needed(request_.x, "x"), y_name});
    const auto [scale, x] = scale_of(columns, request_.x);
    const std::vector<double> y = columns.numbers(y_name), index = columns.numbers("index");
    const std::vector<std::string> family = families(columns), names = distinct(family);
    PicturePage page(title(fmt::format("{} over {}", y_name, request_.x)), scale,
                     PictureScale(y_name, y, unit_of(y_name), svg::Fit::round), shown(names));
    for (std::size_t s = 0; s < names.size(); ++s) {
      std::map<double, std::vector<double>> by_x;
      std::vector<PictureMark> marks;
      for (std::size_t i = 0; i < y.size(); ++i) {
        if (family[i] != names[s] || !std::isfinite(y[i]) || !std::isfinite(x[i])) continue;
        by_x[x[i]].push_back(y[i]);
        marks.push_back({x[i], y[i], static_cast<std::uint64_t>(index[i])});
      }
      Pairs middle, band, upper;
      for (auto& entry : by_x) {
        std::ranges::sort(entry.second);
        middle.emplace_back(entry.first, quantile(entry.second, 0.5));
        band.emplace_back(entry.first, quantile(entry.second, 0.25));
        upper.emplace_back(entry.first, quantile(entry.second, 0.75));
      }
      band.insert(band.end(), upper.rbegin(), upper.rend());
      page.band(band, s);
      page.line(middle, s);
      page.marks(marks, s, 2.2);
    }
    return page.text();
  }

  /// Edges half way to the neighbours, by value.
  static std::map<double, std::pair<double, double>> edges(const std::vector<double>& values) {
    std::set<double> sorted;
    for (const double value : values) {
      if (std::isfinite(value)) sorted.insert(value);
    }
    const std::vector<double> all(sorted.begin(), sorted.end());
    std::map<double, std::pair<double, double>> result;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double before = i > 0 ? all[i - 1] : i + 1 < all.size() ? 2.0 * all[i] - all[i + 1] : all[i] - 1.0;
      const double after = i + 1 < all.size() ? all[i + 1] : i > 0 ? 2.0 * all[i] - all[i - 1] : all[i] + 1.0;
      result[all[i]] = {0.5 * (before + all[i]), 0.5 * (all[i] + after)};
    }
    return result;
  }

  std::string heat() const {
    const std::string& value = needed(request_.value, "value");
    const TableColumns columns = table({needed(request_.x, "x"), needed(request_.y, "y"), value});
    auto [scale_x, x] = scale_of(columns, request_.x);
    auto [scale_y, y] = scale_of(columns, request_.y);
    const std::vector<double> values = columns.numbers(value), index = columns.numbers("index");
    struct Tile {
      double sum = 0.0, count = 0.0;
      std::uint64_t point = 0;
    };
    std::map<std::pair<double, double>, Tile> tiles;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) continue;
      Tile& tile = tiles[{x[i], y[i]}];
      if (tile.count == 0.0) tile.point = static_cast<std::uint64_t>(index[i]);
      tile.sum += values[i];
      tile.count += 1.0;
    }
    const auto x_edges = edges(x), y_edges = edges(y);
    const auto ends = [](const auto& all) {
      std::vector<double> list;
      for (const auto& entry : all) list.insert(list.end(), {entry.second.first, entry.second.second});
      return list;
    };
    if (!has_words(request_.x)) scale_x = PictureScale(request_.x, ends(x_edges), unit_of(request_.x), svg::Fit::exact);
    if (!has_words(request_.y)) scale_y = PictureScale(request_.y, ends(y_edges), unit_of(request_.y), svg::Fit::exact);
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const auto& entry : tiles) {
      least = std::min(least, entry.second.sum / entry.second.count);
      most = std::max(most, entry.second.sum / entry.second.count);
    }
    PicturePage page(title(fmt::format("{} over {} and {}", value, request_.x, request_.y)), scale_x, scale_y);
    if (!tiles.empty()) page.shades(least, most, unit_of(value));
    for (const auto& entry : tiles) {
      const double mean = entry.second.sum / entry.second.count;
      const double dark = most > least ? (mean - least) / (most - least) : 0.5;
      const auto& [from_x, until_x] = x_edges.at(entry.first.first);
      const auto& [from_y, until_y] = y_edges.at(entry.first.second);
      page.tile(from_x, until_x, from_y, until_y, entry.second.point, PicturePage::shade(dark),
                fmt::format("{} {}", value, number_text(mean)));
    }
    return page.text();
  }

  std::string bifurcation() const {
    const std::string& value = needed(request_.value, "value");
    const TableColumns columns = table({needed(request_.x, "x")});
    const std::vector<std::string> wanted = {"index", "reducer", "value"};
    const TableColumns samples(folder_ / "samples.csv", wanted);
    const auto [scale, x] = scale_of(columns, request_.x);
    const std::vector<double> index = columns.numbers("index"), at = samples.numbers("index"),
                              values = samples.numbers("value");
    const std::vector<std::string>& reducer = samples.words("reducer");
    const std::vector<std::string> family = families(columns), names = distinct(family);
    std::map<double, std::size_t> row_of;
    for (std::size_t i = 0; i < index.size(); ++i) row_of[index[i]] = i;
    std::vector<double> seen;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (reducer[k] == value) seen.push_back(values[k]);
    }
    PicturePage page(title(fmt::format("{} over {}", value, request_.x)), scale,
                     PictureScale(value, seen, unit_of_samples(value), svg::Fit::round), shown(names));
    for (std::size_t s = 0; s < names.size(); ++s) {
      std::vector<PictureMark> marks;
      for (std::size_t k = 0; k < values.size(); ++k) {
        const auto row = reducer[k] == value && std::isfinite(values[k]) ? row_of.find(at[k]) : row_of.end();
        if (row == row_of.end() || family[row->second] != names[s]) continue;
        marks.push_back({x[row->second], values[k], static_cast<std::uint64_t>(at[k])});
      }
      page.marks(marks, s, 1.0);
    }
    return page.text();
  }

  std::string unit_of_samples(const std::string& name) const {
    for (const StudyColumn& column : study_.columns().samples) {
      if (column.name == name) return column.unit;
    }
    return "";
  }

  std::string histogram() const {
    const std::string& value = needed(request_.value.empty() ? request_.y : request_.value, "value");
    const TableColumns columns = table({value});
    const std::vector<double> values = columns.numbers(value), index = columns.numbers("index");
    std::vector<double> sorted;
    for (const double one : values) {
      if (std::isfinite(one)) sorted.push_back(one);
    }
    std::ranges::sort(sorted);
    const PictureScale scale(value, sorted, unit_of(value), svg::Fit::round);
    const auto bins =
        static_cast<std::size_t>(std::clamp(std::ceil(std::sqrt(static_cast<double>(sorted.size()))), 5.0, 60.0));
    const std::vector<std::string> family = families(columns), names = distinct(family);
    std::vector<std::vector<double>> counts(names.size(), std::vector<double>(bins, 0.0));
    std::vector<std::vector<std::uint64_t>> first(names.size(), std::vector<std::uint64_t>(bins, 0));
    double most = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) continue;
      const auto s = static_cast<std::size_t>(std::ranges::find(names, family[i]) - names.begin());
      const auto bin = std::min(bins - 1, static_cast<std::size_t>(scale.at(values[i]) * static_cast<double>(bins)));
      if (counts[s][bin]++ == 0.0) first[s][bin] = static_cast<std::uint64_t>(index[i]);
      most = std::max(most, counts[s][bin]);
    }
    const double room = 1.0 + 0.05 * static_cast<double>(names.size());  // for marks of percentiles
    PicturePage page(title(fmt::format("{} of {} points", value, sorted.size())), scale,
                     PictureScale("points", {0.0, room * most}, "", svg::Fit::round), shown(names));
    const auto edge = [&](double bin) {
      return scale.axis().from + bin / static_cast<double>(bins) * (scale.axis().until - scale.axis().from);
    };
    for (std::size_t s = 0; s < names.size(); ++s) {
      for (std::size_t bin = 0; bin < bins; ++bin) {
        if (counts[s][bin] == 0.0) continue;
        const auto part = [&](std::size_t of) {
          return static_cast<double>(bin) + static_cast<double>(of) / static_cast<double>(names.size());
        };
        page.tile(edge(part(s)), edge(part(s + 1)), 0.0, counts[s][bin], first[s][bin], PicturePage::colour(s),
                  fmt::format("{:g}", counts[s][bin]));
      }
    }
    for (std::size_t s = 0; s < names.size(); ++s) {
      std::vector<double> own;
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (family[i] == names[s] && std::isfinite(values[i])) own.push_back(values[i]);
      }
      std::ranges::sort(own);
      mark_percentiles(page, own, s);
    }
    return page.text();
  }

  /// With the interval of order statistics, where there are points enough for one.
  void mark_percentiles(PicturePage& page, const std::vector<double>& sorted, std::size_t series) const {
    if (sorted.empty()) return;
    for (const double percent : request_.percentiles) {
      const double part = 0.01 * percent;
      const bool inside = part > 0.0 && part < 1.0;
      const auto ranks = inside ? percentile_ranks(sorted.size(), part, interval_confidence) : std::nullopt;
      std::optional<std::pair<double, double>> interval;
      if (ranks) interval = {sorted[ranks->first - 1], sorted[ranks->second - 1]};
      page.upright(quantile(sorted, part), interval, series, fmt::format("{:g} %", percent));
    }
  }

  std::string tornado() const {
    const std::string& value = needed(request_.value.empty() ? request_.y : request_.value, "value");
    return tornado_picture(study_.plan(), folder_ / "study.csv", value, unit_of(value));
  }

  const OpenStudy& study_;
  const std::filesystem::path& folder_;
  const PictureRequest& request_;
};

PictureRequest::Kind kind_of(const std::string& word) {
  using Kind = PictureRequest::Kind;
  return word == "heat"          ? Kind::heat
         : word == "bifurcation" ? Kind::bifurcation
         : word == "histogram"   ? Kind::histogram
         : word == "tornado"     ? Kind::tornado
                                 : Kind::line;
}

}  // namespace

std::vector<PictureRequest> picture_requests(const StudyPlan& plan) {
  std::vector<PictureRequest> requests;
  if (plan.section().plots == nullptr) return requests;
  for (const Node::Entry& entry : plan.section().plots->entries) {
    PictureRequest request;
    request.name = entry.key->text;
    const auto text = [&](const char* key) {
      const Node* node = entry.value->find(key);
      return node == nullptr ? std::string() : node->text;
    };
    request.kind = kind_of(text("kind"));
    request.x = text("x");
    request.y = text("y");
    request.value = text("value");
    request.by = text("by");
    if (const Node* percentiles = entry.value->find("percentiles")) {
      request.percentiles.clear();
      for (const Node* item : percentiles->items) {
        if (const auto percent = constant_quantity(item->text)) request.percentiles.push_back(percent->value);
      }
    }
    requests.push_back(std::move(request));
  }
  return requests;
}

std::string study_picture(const OpenStudy& study, const std::filesystem::path& folder, const PictureRequest& request) {
  return Drawing(study, folder, request).draw();
}

}  // namespace freeplay
