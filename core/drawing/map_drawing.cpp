#include "drawing/map_drawing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "drawing/contours.h"
#include "svg/axis.h"
#include "svg/page.h"

namespace freeplay {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
constexpr double wide_range = 50.0;  // of values whose levels are powers
constexpr double plot = 620.0, left = 80.0, top = 50.0, legend = 210.0, bottom = 60.0;

using svg::escaped, svg::px;

class MapDrawing {
 public:
  explicit MapDrawing(const PositionMap& map) : map_(map) {
    scale_ = plot / std::max(map.x.back() - map.x.front(), map.y.back() - map.y.front());
    if (!std::isfinite(scale_)) scale_ = 1.0;
    width_ = std::max(scale_ * (map.x.back() - map.x.front()), 1.0);
    height_ = std::max(scale_ * (map.y.back() - map.y.front()), 1.0);
  }

  std::string text() {
    find_levels();
    const double page_width = left + width_ + legend, page_height = top + std::max(height_, 320.0) + bottom;
    body_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
        "font-family=\"sans-serif\" font-size=\"11\">\n<title>{2}</title>\n"
        "<defs><pattern id=\"out\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\" "
        "patternTransform=\"rotate(45)\"><path d=\"M0,0V6\" stroke=\"#888\" stroke-width=\"1\"/></pattern></defs>\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        "<text x=\"{3}\" y=\"{4}\" font-size=\"14\">{2}</text>\n",
        px(page_width), px(page_height), escaped(map_.title), px(left), px(top - 20.0));
    draw_ground();
    draw_singular();
    draw_path();
    body_ += label_text_;
    draw_axes();
    draw_legend();
    return body_ + "</svg>\n";
  }

 private:
  double value(std::size_t i, std::size_t j) const {
    const std::size_t k = i * map_.y.size() + j;
    return map_.points[k] == MapPoint::good ? map_.values[k] : nan;
  }
  double at_x(double x) const { return left + scale_ * (x - map_.x.front()); }
  double at_y(double y) const { return top + height_ - scale_ * (y - map_.y.front()); }

  void find_levels() {
    std::vector<double> good;
    for (std::size_t k = 0; k < map_.values.size(); ++k) {
      if (map_.points[k] == MapPoint::good && std::isfinite(map_.values[k])) good.push_back(map_.values[k]);
    }
    if (good.empty()) return;
    std::ranges::sort(good);
    least_ = good.front();
    most_ = good.back();
    // Near a singular curve values have no end; they would leave nothing for the rest.
    const double bulk = good[std::min(good.size() - 1, good.size() * 97 / 100)];
    levels_ = contour_levels(least_, bulk, least_ > 0.0 && most_ > wide_range * least_);
  }

  /// Light for small values, dark for large ones, with room for black lines: grey, or along cividis, which colour-blind
  /// readers see the same (Nunez, Anderton and Renslow 2018).
  std::string tone(std::size_t step) const {
    const double share = levels_.empty() ? 0.0 : static_cast<double>(step) / static_cast<double>(levels_.size());
    if (!map_.coloured) return fmt::format("#{0:02x}{0:02x}{0:02x}", std::lround(250.0 - 110.0 * share));
    constexpr double scale[][3] = {{254, 232, 56}, {188, 174, 108}, {125, 124, 120}, {67, 78, 108}};
    const double at = 0.85 * share * (std::size(scale) - 1.0);
    const auto from = std::min(static_cast<std::size_t>(at), std::size(scale) - 2);
    const double part = at - static_cast<double>(from);
    const auto mixed = [&](std::size_t k) {
      return std::lround(scale[from][k] * (1.0 - part) + scale[from + 1][k] * part);
    };
    return fmt::format("#{:02x}{:02x}{:02x}", mixed(0), mixed(1), mixed(2));
  }

  // Hatched up to half way to the points that are reached, white where those have no value. All of one tone is one
  // path, so that no seams show between its parts.
  void draw_ground() {
    body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n", px(left), px(top),
                         px(width_), px(height_), all_good() ? "white" : "url(#out)");
    if (!all_good()) {
      body_ += fmt::format("<path d=\"{}\" fill=\"white\"/>\n<clipPath id=\"reached\"><path d=\"{}\"/></clipPath>\n",
                           ground_about([](MapPoint point) { return point != MapPoint::unreachable; }),
                           ground_about([](MapPoint point) { return point == MapPoint::good; }));
    }
    const std::vector<double> field = values_to_edge();
    body_ += all_good() ? "<g>\n" : "<g clip-path=\"url(#reached)\">\n";
    for (std::size_t step = 0; step <= levels_.size(); ++step) {
      const double level = step == 0 ? least_ : levels_[step - 1];
      const double next = step < levels_.size() ? levels_[step] : infinity;
      const std::string d = outline(region(map_.x, map_.y, field, level, next));
      if (!d.empty()) body_ += fmt::format("<path d=\"{}\" fill=\"{}\"/>\n", d, tone(step));
    }
    draw_contours(field);
    body_ += "</g>\n";
  }

  template <class Chosen>
  std::string ground_about(const Chosen& chosen) const {
    std::vector<double> field;
    for (const MapPoint point : map_.points) field.push_back(chosen(point) ? 1.0 : -1.0);
    return outline(region(map_.x, map_.y, field, 0.0, infinity));
  }

  bool all_good() const { return std::ranges::count(map_.points, MapPoint::good) == std::ssize(map_.points); }

  /// The values of good points, and of those beside them what carries their slope on: the edge of what is reached
  /// crosses the cells between.
  std::vector<double> values_to_edge() const {
    const int columns = static_cast<int>(map_.x.size()), rows = static_cast<int>(map_.y.size());
    const auto known = [&](int i, int j) {
      const bool inside = i >= 0 && j >= 0 && i < columns && j < rows;
      return inside ? value(static_cast<std::size_t>(i), static_cast<std::size_t>(j)) : nan;
    };
    std::vector<double> field;
    for (int i = 0; i < columns; ++i) {
      for (int j = 0; j < rows; ++j) {
        double sum = 0.0;
        int count = 0;
        for (int side = 0; side < 9; ++side) {
          const int di = side / 3 - 1, dj = side % 3 - 1;
          const double near = known(i + di, j + dj), far = known(i + 2 * di, j + 2 * dj);
          if (!std::isfinite(near)) continue;
          sum += std::isfinite(far) ? 2.0 * near - far : near;
          ++count;
        }
        const double here = known(i, j);
        field.push_back(std::isfinite(here) ? here : count > 0 ? std::clamp(sum / count, least_, most_) : nan);
      }
    }
    return field;
  }

  /// As one path; rectangles above each other are one, for a small file.
  std::string outline(const std::vector<std::vector<svg::Point>>& polygons) const {
    const auto upright = [](const std::vector<svg::Point>& p) {
      return p.size() == 4 && p[0].x == p[3].x && p[1].x == p[2].x && p[0].y == p[1].y && p[2].y == p[3].y;
    };
    std::string d;
    std::vector<svg::Point> strip;
    for (const std::vector<svg::Point>& polygon : polygons) {
      const bool goes_on = upright(strip) && upright(polygon) && strip[3].x == polygon[0].x &&
                           strip[3].y == polygon[0].y && strip[2].x == polygon[1].x;
      if (goes_on) {
        strip[2] = polygon[2];
        strip[3] = polygon[3];
        continue;
      }
      if (!strip.empty()) d += line_of(strip) + "Z";
      strip = polygon;
    }
    return strip.empty() ? d : d + line_of(strip) + "Z";
  }

  std::string line_of(const std::vector<svg::Point>& points) const {
    std::string d;
    for (std::size_t i = 0; i < points.size(); ++i) {
      d += fmt::format("{}{},{}", i == 0 ? "M" : "L", px(at_x(points[i].x)), px(at_y(points[i].y)));
    }
    return d;
  }

  void draw_contours(const std::vector<double>& field) {
    for (const double level : levels_) {
      for (const std::vector<svg::Point>& line : joined(contour(map_.x, map_.y, field, level))) {
        body_ += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"black\" stroke-width=\"0.8\"/>\n", line_of(line));
        if (const svg::Point* place = label_place(line)) {
          label_text_ += fmt::format(
              "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" stroke=\"white\" stroke-width=\"3\" "
              "paint-order=\"stroke\">{:.4g}</text>\n",
              px(at_x(place->x)), px(at_y(place->y) + 4.0), level);
        }
      }
    }
  }

  bool is_good(const svg::Point& p) const {
    const auto nearest = [](const std::vector<double>& axis, double at) {
      return std::lround((at - axis.front()) / (axis.back() - axis.front()) * static_cast<double>(axis.size() - 1));
    };
    return std::isfinite(
        value(static_cast<std::size_t>(nearest(map_.x, p.x)), static_cast<std::size_t>(nearest(map_.y, p.y))));
  }

  /// The point of a line that is farthest from the labels so far, off the path; none where the line is short or all is
  /// taken.
  const svg::Point* label_place(const std::vector<svg::Point>& line) {
    double length = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) {
      length += scale_ * std::hypot(line[i].x - line[i - 1].x, line[i].y - line[i - 1].y);
    }
    if (length < 60.0) return nullptr;
    const svg::Point* best = nullptr;
    double room = 30.0;
    for (const svg::Point& p : line) {
      if (!is_good(p)) continue;
      double nearest =
          std::min({at_x(p.x) - left, left + width_ - at_x(p.x), at_y(p.y) - top, top + height_ - at_y(p.y)}) + 10.0;
      for (const svg::Point& other : labels_) {
        nearest = std::min(nearest, scale_ * std::hypot(p.x - other.x, p.y - other.y));
      }
      for (const auto& other : map_.path) {
        nearest = std::min(nearest, scale_ * std::hypot(p.x - other[0], p.y - other[1]) + 12.0);
      }
      if (nearest > room) room = nearest, best = &p;
    }
    if (best != nullptr) labels_.push_back(*best);
    return best;
  }

  void draw_singular() {
    for (std::size_t i = 0; i < map_.x.size(); ++i) {
      for (std::size_t j = 0; j < map_.y.size(); ++j) {
        if (map_.points[i * map_.y.size() + j] != MapPoint::singular) continue;
        const double x = at_x(map_.x[i]), y = at_y(map_.y[j]);
        body_ += fmt::format("<path d=\"M{},{}l6,6m0,-6l-6,6\" stroke=\"black\" stroke-width=\"1.5\"/>\n", px(x - 3.0),
                             px(y - 3.0));
      }
    }
    if (map_.determinant.empty()) return;
    for (const std::vector<svg::Point>& line : joined(contour(map_.x, map_.y, map_.determinant, 0.0))) {
      body_ +=
          fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"black\" stroke-width=\"2.5\" stroke-dasharray=\"8,4\"/>\n",
                      line_of(line));
      singular_ = true;
    }
  }

  void draw_path() {
    if (map_.path.size() < 2) return;
    std::vector<svg::Point> points;
    for (const auto& p : map_.path) points.push_back({p[0], p[1]});
    const std::string line = line_of(points);
    body_ += fmt::format(
        "<path d=\"{0}\" fill=\"none\" stroke=\"white\" stroke-width=\"5\"/>\n"
        "<path d=\"{0}\" fill=\"none\" stroke=\"#0050a0\" stroke-width=\"2.2\"/>\n"
        "<circle cx=\"{1}\" cy=\"{2}\" r=\"4\" fill=\"#0050a0\" stroke=\"white\"/>\n",
        line, px(at_x(points[0].x)), px(at_y(points[0].y)));
  }

  void draw_axes() {
    body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"black\"/>\n",
                         px(left), px(top), px(width_), px(height_));
    const svg::Axis x = svg::make_axis(map_.x.front(), map_.x.back(), "m", 7.0, svg::Fit::exact);
    const svg::Axis y = svg::make_axis(map_.y.front(), map_.y.back(), "m", 7.0, svg::Fit::exact);
    for (std::size_t i = 0; i < x.ticks.size(); ++i) {
      body_ += fmt::format(
          "<path d=\"M{0},{1}v5\" stroke=\"black\"/><text x=\"{0}\" y=\"{2}\" text-anchor=\"middle\">{3}</text>\n",
          px(at_x(x.ticks[i])), px(top + height_), px(top + height_ + 18.0), x.labels[i]);
    }
    for (std::size_t i = 0; i < y.ticks.size(); ++i) {
      body_ += fmt::format(
          "<path d=\"M{0},{1}h-5\" stroke=\"black\"/><text x=\"{2}\" y=\"{3}\" text-anchor=\"end\">{4}</text>\n",
          px(left), px(at_y(y.ticks[i])), px(left - 9.0), px(at_y(y.ticks[i]) + 4.0), y.labels[i]);
    }
    body_ += fmt::format(
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{} [{}]</text>\n<text transform=\"translate({},{}) "
        "rotate(-90)\" text-anchor=\"middle\">{} [{}]</text>\n",
        px(left + 0.5 * width_), px(top + height_ + 38.0), escaped(map_.x_word), x.unit, px(24.0),
        px(top + 0.5 * height_), escaped(map_.y_word), y.unit);
  }

  void draw_legend() {
    const double x = left + width_ + 24.0;
    double y = top + 12.0;
    const auto words = [&](const std::string& text) {
      body_ += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", px(x + 30.0), px(y + 4.0), escaped(text));
      y += 20.0;
    };
    body_ +=
        fmt::format("<text x=\"{}\" y=\"{}\" font-weight=\"bold\">{}</text>\n", px(x), px(y), escaped(map_.quantity));
    y += 20.0;
    if (std::isfinite(least_)) {
      std::vector<double> ends = levels_;
      for (std::size_t i = ends.size() + 1; i-- > 0;) {
        body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"22\" height=\"14\" fill=\"{}\" stroke=\"#444\"/>\n",
                             px(x), px(y - 7.0), tone(i));
        words(ends.empty() ? fmt::format("{:.4g}", least_)
              : i == 0     ? fmt::format("below {:.4g}", ends[0])
                           : fmt::format("from {:.4g}", ends[i - 1]));
      }
      body_ +=
          fmt::format("<text x=\"{}\" y=\"{}\">smallest {:.4g}</text>\n<text x=\"{}\" y=\"{}\">largest {:.4g}</text>\n",
                      px(x), px(y + 4.0), least_, px(x), px(y + 20.0), most_);
      y += 44.0;
    }
    if (std::ranges::count(map_.points, MapPoint::unreachable) > 0) {
      body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"22\" height=\"14\" fill=\"url(#out)\" stroke=\"#444\"/>\n",
                           px(x), px(y - 7.0));
      words("out of reach");
    }
    if (singular_ || std::ranges::count(map_.points, MapPoint::singular) > 0) {
      body_ += fmt::format("<path d=\"M{},{}h22\" stroke=\"black\" stroke-width=\"2.5\" stroke-dasharray=\"8,4\"/>\n",
                           px(x), px(y));
      words("singular (points: x)");
    }
    if (map_.path.size() >= 2) {
      body_ += fmt::format(
          "<path d=\"M{0},{1}h22\" stroke=\"#0050a0\" stroke-width=\"2.2\"/><circle cx=\"{0}\" cy=\"{1}\" "
          "r=\"4\" fill=\"#0050a0\"/>\n",
          px(x), px(y));
      words("path, from the dot on");
    }
  }

  const PositionMap& map_;
  double scale_ = 1.0, width_ = 1.0, height_ = 1.0, least_ = nan, most_ = nan;
  std::vector<double> levels_;
  std::vector<svg::Point> labels_;
  bool singular_ = false;
  std::string body_, label_text_;
};

}  // namespace

std::string map_svg(const PositionMap& map) { return MapDrawing(map).text(); }

}  // namespace freeplay
