#include "drawing/map_drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "svg/axis.h"
#include "svg/page.h"

namespace freeplay {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double wide_range = 50.0;  // of values whose levels are powers
constexpr double plot = 620.0, left = 80.0, top = 50.0, legend = 210.0, bottom = 60.0;

using svg::escaped, svg::Point, svg::px;

/// Pieces strung together where their ends meet.
std::vector<std::vector<Point>> joined(const std::vector<std::array<double, 4>>& pieces) {
  std::vector<std::vector<Point>> lines;
  std::vector<char> used(pieces.size(), 0);
  const auto same = [](const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; };
  for (std::size_t first = 0; first < pieces.size(); ++first) {
    if (used[first]) continue;
    used[first] = 1;
    std::vector<Point> line{{pieces[first][0], pieces[first][1]}, {pieces[first][2], pieces[first][3]}};
    for (bool grew = true; grew;) {
      grew = false;
      for (std::size_t i = first + 1; i < pieces.size(); ++i) {
        if (used[i]) continue;
        const Point a{pieces[i][0], pieces[i][1]}, b{pieces[i][2], pieces[i][3]};
        if (same(line.back(), a)) {
          line.push_back(b);
        } else if (same(line.back(), b)) {
          line.push_back(a);
        } else if (same(line.front(), a)) {
          line.insert(line.begin(), b);
        } else if (same(line.front(), b)) {
          line.insert(line.begin(), a);
        } else {
          continue;
        }
        used[i] = 1;
        grew = true;
      }
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

class Drawing {
 public:
  explicit Drawing(const PositionMap& map) : map_(map) {
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
    draw_cells();
    draw_contours();
    draw_singular();
    draw_path();
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

  /// Light for small values, dark for large ones, with room for black lines.
  std::string grey(double v) const {
    const auto above = std::ranges::upper_bound(levels_, v) - levels_.begin();
    const double share = levels_.empty() ? 0.0 : static_cast<double>(above) / static_cast<double>(levels_.size());
    const int tone = static_cast<int>(std::lround(250.0 - 110.0 * share));
    return fmt::format("#{0:02x}{0:02x}{0:02x}", tone);
  }

  // Each point colours the ground around it; rows of one tone are one rectangle.
  void draw_cells() {
    const auto edges = [](const std::vector<double>& axis) {
      std::vector<double> out{axis.front()};
      for (std::size_t i = 1; i < axis.size(); ++i) out.push_back(0.5 * (axis[i - 1] + axis[i]));
      out.push_back(axis.back());
      return out;
    };
    const std::vector<double> ex = edges(map_.x), ey = edges(map_.y);
    body_ += "<g shape-rendering=\"crispEdges\">\n";
    for (std::size_t i = 0; i < map_.x.size(); ++i) {
      for (std::size_t j = 0; j < map_.y.size();) {
        const std::string fill = fill_of(i, j);
        std::size_t end = j + 1;
        while (end < map_.y.size() && fill_of(i, end) == fill) ++end;
        body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n", px(at_x(ex[i])),
                             px(at_y(ey[end])), px(scale_ * (ex[i + 1] - ex[i])), px(scale_ * (ey[end] - ey[j])), fill);
        j = end;
      }
    }
    body_ += "</g>\n";
  }

  std::string fill_of(std::size_t i, std::size_t j) const {
    const MapPoint point = map_.points[i * map_.y.size() + j];
    if (point == MapPoint::unreachable) return "url(#out)";
    return point == MapPoint::singular ? "white" : grey(value(i, j));
  }

  std::string line_of(const std::vector<Point>& points) const {
    std::string d;
    for (std::size_t i = 0; i < points.size(); ++i) {
      d += fmt::format("{}{},{}", i == 0 ? "M" : "L", px(at_x(points[i].x)), px(at_y(points[i].y)));
    }
    return d;
  }

  void draw_contours() {
    std::vector<double> field(map_.values.size(), nan);
    for (std::size_t k = 0; k < field.size(); ++k) {
      if (map_.points[k] == MapPoint::good) field[k] = map_.values[k];
    }
    std::string labels;
    for (const double level : levels_) {
      for (const std::vector<Point>& line : joined(contour(map_.x, map_.y, field, level))) {
        body_ += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"black\" stroke-width=\"0.8\"/>\n", line_of(line));
        if (const Point* place = label_place(line)) {
          labels += fmt::format(
              "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" stroke=\"white\" stroke-width=\"3\" "
              "paint-order=\"stroke\">{:.4g}</text>\n",
              px(at_x(place->x)), px(at_y(place->y) + 4.0), level);
        }
      }
    }
    body_ += labels;
  }

  /// The point of a line that is farthest from the labels so far; none where the line is short or all is taken.
  const Point* label_place(const std::vector<Point>& line) {
    double length = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) {
      length += scale_ * std::hypot(line[i].x - line[i - 1].x, line[i].y - line[i - 1].y);
    }
    if (length < 60.0) return nullptr;
    const Point* best = nullptr;
    double room = 30.0;
    for (const Point& p : line) {
      double nearest =
          std::min({at_x(p.x) - left, left + width_ - at_x(p.x), at_y(p.y) - top, top + height_ - at_y(p.y)}) + 10.0;
      for (const Point& other : labels_) {
        nearest = std::min(nearest, scale_ * std::hypot(p.x - other.x, p.y - other.y));
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
    for (const std::vector<Point>& line : joined(contour(map_.x, map_.y, map_.determinant, 0.0))) {
      body_ +=
          fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"black\" stroke-width=\"2.5\" stroke-dasharray=\"8,4\"/>\n",
                      line_of(line));
      singular_ = true;
    }
  }

  void draw_path() {
    if (map_.path.size() < 2) return;
    std::vector<Point> points;
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
    for (const double x : contour_levels(map_.x.front(), map_.x.back(), false)) {
      body_ += fmt::format(
          "<path d=\"M{0},{1}v5\" stroke=\"black\"/><text x=\"{0}\" y=\"{2}\" text-anchor=\"middle\">{3:.4g}</text>\n",
          px(at_x(x)), px(top + height_), px(top + height_ + 18.0), x + 0.0);
    }
    for (const double y : contour_levels(map_.y.front(), map_.y.back(), false)) {
      body_ += fmt::format(
          "<path d=\"M{0},{1}h-5\" stroke=\"black\"/><text x=\"{2}\" y=\"{3}\" text-anchor=\"end\">{4:.4g}</text>\n",
          px(left), px(at_y(y)), px(left - 9.0), px(at_y(y) + 4.0), y + 0.0);
    }
    body_ += fmt::format(
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">x [m]</text>\n<text transform=\"translate({},{}) "
        "rotate(-90)\" text-anchor=\"middle\">y [m]</text>\n",
        px(left + 0.5 * width_), px(top + height_ + 38.0), px(24.0), px(top + 0.5 * height_));
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
        const double tone = i == 0 ? -std::numeric_limits<double>::infinity() : ends[i - 1];
        body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"22\" height=\"14\" fill=\"{}\" stroke=\"#444\"/>\n",
                             px(x), px(y - 7.0), grey(tone));
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
  std::vector<Point> labels_;
  bool singular_ = false;
  std::string body_;
};

}  // namespace

std::string map_svg(const PositionMap& map) { return Drawing(map).text(); }

std::vector<double> contour_levels(double least, double most, bool logarithmic) {
  std::vector<double> levels;
  if (!(most > least) || !std::isfinite(least) || !std::isfinite(most)) return levels;
  if (logarithmic) {
    for (double power = std::floor(std::log10(least)); power <= std::log10(most); ++power) {
      for (const double digit : {1.0, 2.0, 5.0}) {
        const double level = digit * std::pow(10.0, power);
        if (level > least && level < most) levels.push_back(level);
      }
    }
    while (levels.size() > 12) {
      std::vector<double> fewer;
      for (std::size_t i = 0; i < levels.size(); i += 3) fewer.push_back(levels[i]);
      levels = std::move(fewer);
    }
    return levels;
  }
  return svg::round_numbers(least, most, 7.0);
}

std::vector<std::array<double, 4>> contour(const std::vector<double>& x, const std::vector<double>& y,
                                           const std::vector<double>& values, double level) {
  std::vector<std::array<double, 4>> pieces;
  const auto at = [&](std::size_t i, std::size_t j) { return values[i * y.size() + j] - level; };
  // On an edge the crossing is found from the same end by both cells, so that their pieces meet exactly.
  const auto cross = [&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
    const double a = at(i, j), b = at(k, l), s = a / (a - b);
    return Point{x[i] + s * (x[k] - x[i]), y[j] + s * (y[l] - y[j])};
  };
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    for (std::size_t j = 0; j + 1 < y.size(); ++j) {
      const double corner[4] = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
      if (std::ranges::any_of(corner, [](double v) { return !std::isfinite(v); })) continue;
      const bool up[4] = {corner[0] >= 0.0, corner[1] >= 0.0, corner[2] >= 0.0, corner[3] >= 0.0};
      std::vector<Point> ends;
      if (up[0] != up[1]) ends.push_back(cross(i, j, i + 1, j));
      if (up[1] != up[2]) ends.push_back(cross(i + 1, j, i + 1, j + 1));
      if (up[3] != up[2]) ends.push_back(cross(i, j + 1, i + 1, j + 1));
      if (up[0] != up[3]) ends.push_back(cross(i, j, i, j + 1));
      if (ends.size() == 4) {  // a saddle: the mean decides which corners are connected
        const bool middle = corner[0] + corner[1] + corner[2] + corner[3] >= 0.0;
        // With the first corner's side in the middle, lines cut off corners 1 and 3, else 0 and 2.
        if (middle != up[0]) std::swap(ends[1], ends[3]);
      }
      for (std::size_t k = 0; k + 1 < ends.size(); k += 2) {
        pieces.push_back({ends[k].x, ends[k].y, ends[k + 1].x, ends[k + 1].y});
      }
    }
  }
  return pieces;
}

}  // namespace freeplay
