#include "plot/polar_figure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "base/error.h"
#include "base/suggestion.h"
#include "base/unit_prefix.h"
#include "results/derived_table.h"

namespace freeplay::plot {
namespace {

constexpr double rings = 3.0, room = 1.08;
constexpr int arc_points = 4;        // of a sector
constexpr int label_places = 8;      // around the joint
constexpr double label_width = 0.4;  // half of what a label takes of a ring [rad]

std::size_t place_of(const std::string& word, const std::vector<std::string>& words, const std::string& what,
                     const std::string& file) {
  const auto found = std::ranges::find(words, word);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  const auto nearest = suggestion(word, words);
  if (words.empty()) throw Error(Error::Category::usage, "unknown-name", fmt::format("'{}' has no {}", file, what));
  throw Error(Error::Category::usage, "unknown-name", fmt::format("'{}' has no {} '{}'", file, what, word), {},
              nearest ? fmt::format("did you mean '{}'?", *nearest) : fmt::format("one of {}", fmt::join(words, ", ")));
}

/// The direction in which lines reach least far, of those in which labels of rings may stand.
double free_angle(const std::vector<Line>& lines) {
  double best = 0.0, least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < label_places; ++k) {
    const double angle = std::numbers::pi * (0.5 + 2.0 * k / label_places);
    if (std::abs(std::cos(angle)) > 0.9) continue;  // labels side by side would meet
    double reach = 0.0;
    for (const Line& line : lines) {
      for (const Point& p : line.points) {
        const double away = std::remainder(std::atan2(p.y, p.x) - angle, 2.0 * std::numbers::pi);
        if (std::abs(away) < label_width) reach = std::max(reach, std::hypot(p.x, p.y));
      }
    }
    if (reach < least) least = reach, best = angle;
  }
  return best;
}

/// The outline of sectors as high as their values.
Line outline(const std::vector<double>& values) {
  Line line;
  const double sector = 2.0 * std::numbers::pi / static_cast<double>(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double value = std::isfinite(values[k]) ? values[k] : 0.0;
    for (int i = 0; i <= arc_points; ++i) {
      const double angle = sector * (static_cast<double>(k) + static_cast<double>(i) / arc_points);
      line.points.push_back({value * std::cos(angle), value * std::sin(angle)});
    }
    line.seen.add(sector * (static_cast<double>(k) + 0.5), value);
  }
  if (!line.points.empty()) line.points.push_back(line.points.front());
  line.rows = static_cast<std::int64_t>(values.size());
  return line;
}

}  // namespace

Figure polar_figure(const std::vector<Source>& sources, const FigureRequest& request) {
  Figure figure;
  std::vector<DerivedTable> tables;
  for (const Source& source : sources) {
    figure.names.push_back(source.name);
    tables.push_back(bearing_table(*source.reader));
  }
  std::vector<std::string> words;
  for (const RecordColumn& column : tables[0].columns) words.push_back(column.name);
  words.erase(words.begin(), words.begin() + 2);  // joint and angle
  for (const std::string& word : request.channels) {
    const std::size_t table = 2 + place_of(word, words, "table by bearing sector", sources[0].reader->file());
    Panel panel;
    panel.channel = word;
    panel.unit = tables[0].columns[table].unit;
    panel.title = fmt::format("{} of {} by bearing angle", word, request.joint);
    double largest = 0.0;
    bool known = false;
    for (std::size_t s = 0; s < sources.size(); ++s) {
      const std::vector<std::string>& joints = sources[s].reader->layout().bearings;
      const std::size_t joint = place_of(request.joint, joints, "joint with play", sources[s].reader->file());
      const std::size_t width = tables[s].columns.size(), sectors = tables[s].rows.size() / width / joints.size();
      std::vector<double> values;
      for (std::size_t k = 0; k < sectors; ++k) values.push_back(tables[s].rows[(joint * sectors + k) * width + table]);
      known = known || std::ranges::any_of(values, [](double value) { return std::isfinite(value); });
      panel.lines.push_back(outline(values));
      largest = std::fmax(largest, panel.lines.back().seen.most);
    }
    const bool empty = !(largest > 0.0);
    if (empty) {
      largest = 1.0;
      panel.title += known ? ": 0 in all sectors" : ": not known, the bearing has no 'length'";
    }
    panel.x = panel.y = {-room * largest, room * largest, {0.0}, {""}, ""};
    panel.equal_scales = true;
    const double beside = free_angle(panel.lines);
    for (const double ring : svg::round_numbers(0.0, largest, rings)) {
      const PrefixedUnit to = prefixed_unit(ring, panel.unit == "1" ? "" : panel.unit);
      if (ring > 0.0 && !empty)
        panel.circles.push_back({ring, fmt::format("{:g} {}", ring / to.factor, to.unit), false, beside});
    }
    panel.x_label = "0 deg is to the right; of the whole time that counts";
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

}  // namespace freeplay::plot
