#include "svg/page.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "base/text.h"
#include "base/unit_prefix.h"

namespace freeplay::svg {
namespace {

constexpr double letter_width = 6.6, letter_height = 12.0;  // of the labels, 11 px

constexpr const char* tints[] = {"#4477aa", "#cc6677", "#228833", "#ccbb44",
                                 "#66ccee", "#aa3377", "#999933", "#882255"};

}  // namespace

double length(const Point& a) { return std::hypot(a.x, a.y); }

std::pair<Point, Point> ends_of(const std::vector<Point>& points) {
  Point low{0.0, 0.0}, high{0.0, 0.0};
  if (!points.empty()) low = high = points.front();
  for (const Point& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return {low, high};
}

std::vector<Point> hull(std::vector<Point> points) {
  constexpr double flat = 1e-6;  // twice the area of a corner that rounding alone makes
  const auto before = [](const Point& a, const Point& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); };
  std::ranges::sort(points, before);
  points.erase(std::unique(points.begin(), points.end(), [](auto& a, auto& b) { return a.x == b.x && a.y == b.y; }),
               points.end());
  if (points.size() < 3) return points;
  std::vector<Point> out;
  for (const bool upper : {false, true}) {
    const std::size_t base = out.size();
    for (const Point& p : points) {
      while (out.size() >= base + 2 && cross(out.back() - out[out.size() - 2], p - out.back()) <= flat) out.pop_back();
      out.push_back(p);
    }
    out.pop_back();
    if (!upper) std::ranges::reverse(points);
  }
  return out;
}

std::string path(const std::vector<Point>& points) {
  std::string out;
  for (const Point& p : points) out += fmt::format("{}{} {}", out.empty() ? "M" : " L", px(p.x), px(p.y));
  return out;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : printable(text)) {
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return out;
}

std::string px(double value) {
  const double rounded = std::round(value * 10.0) / 10.0 + 0.0;
  return fmt::format("{:.1f}", rounded);
}

const char* tint(int body) { return tints[static_cast<std::size_t>(body) % std::size(tints)]; }

void Page::line(const Point& a, const Point& b, const char* style) {
  shape("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" {}/>\n", px(a.x), px(a.y), px(b.x), px(b.y), style);
}

void Page::circle(const Point& at, double radius, const char* style) {
  shape("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", px(at.x), px(at.y), px(radius), style);
  block(at, radius);
}

void Page::centre(const Point& at) {
  circle(at, 4.0, "fill=\"white\" stroke=\"black\" stroke-width=\"0.8\"");
  shape("<path d=\"M{0} {1} h4 a4 4 0 0 0 -4 -4 z m0 0 h-4 a4 4 0 0 0 4 4 z\" fill=\"black\"/>\n", px(at.x), px(at.y));
}

void Page::spring(const Point& from, const Point& to) {
  const Point along = to - from;
  const double size = length(along);
  if (size < 1.0) return circle(from, 12.0, "fill=\"none\" stroke=\"#228833\" stroke-dasharray=\"3 2\"");
  const Point normal = (6.0 / size) * Point{-along.y, along.x};
  std::string path = fmt::format("M{} {}", px(from.x), px(from.y));
  constexpr int turns = 8;
  for (int i = 1; i < 2 * turns; ++i) {
    const Point p = from + (0.15 + 0.7 * i / (2.0 * turns)) * along + (i % 2 == 1 ? 1.0 : -1.0) * normal;
    path += fmt::format(" L{} {}", px(p.x), px(p.y));
  }
  shape("<path d=\"{} L{} {}\" fill=\"none\" stroke=\"#228833\" stroke-width=\"1.2\"/>\n", path, px(to.x), px(to.y));
}

void Page::hatch(const Point& at) {
  const double x = at.x, y = at.y + 8.0;
  line({x - 12, y}, {x + 12, y}, "stroke=\"black\"");
  for (int i = -2; i <= 2; ++i)
    line({x + 5.0 * i, y}, {x + 5.0 * i - 4, y + 6}, "stroke=\"black\" stroke-width=\"0.8\"");
  line(at, {x, y}, "stroke=\"black\"");
  taken_.push_back({x - 14, at.y, x + 12, y + 6});
}

void Page::block(const Point& at, double radius) {
  taken_.push_back({at.x - radius, at.y - radius, at.x + radius, at.y + radius});
}

void Page::shun(const Point& a, const Point& b) {
  const int pieces = std::clamp(static_cast<int>(length(b - a) / 10.0), 1, 200);
  for (int i = 0; i <= pieces; ++i) {
    const Point at = a + (static_cast<double>(i) / pieces) * (b - a);
    shunned_.push_back({at.x - 3, at.y - 3, at.x + 3, at.y + 3});
  }
}

void Page::label(std::string text, const Point& at, const char* style) {
  names_.push_back({std::move(text), at, style});
}

// The first of many places around what it names where a label meets no other and no symbol; the nearest one else.
void Page::place_labels(const Box& bounds) {
  // A thousand names cannot be read; finding room for them would take minutes.
  const int rings = names_.size() > 400 ? 1 : 6;
  for (const Label& name : names_) {
    const double wide = letter_width * character_count(name.text);
    Box best{};
    double least = std::numeric_limits<double>::infinity();
    for (int ring = 0; ring < rings && least > 0.0; ++ring) {
      for (int k = 0; k < 12 && least > 0.0; ++k) {
        const double angle = (k * 30.0 - 30.0) * 3.14159265358979323846 / 180.0, out = 12.0 + 13.0 * ring;
        const Point at{name.at.x + out * std::cos(angle), name.at.y + out * std::sin(angle)};
        const double left = at.x + (std::cos(angle) - 1.0) * wide / 2;
        const Box box{left, at.y - letter_height / 2, left + wide, at.y + letter_height / 2};
        const double cost = crowding(box, bounds);
        if (cost < least) least = cost, best = box;
      }
    }
    if (length({(best.left + best.right) / 2 - name.at.x, best.bottom - name.at.y}) > wide / 2 + 30.0) {
      labels_ +=
          fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"#bbbbbb\" stroke-width=\"0.6\"/>\n",
                      px(name.at.x), px(name.at.y), px(std::clamp(name.at.x, best.left, best.right)),
                      px(std::clamp(name.at.y, best.top, best.bottom)));
    }
    labels_ +=
        fmt::format("<text x=\"{}\" y=\"{}\" paint-order=\"stroke\" stroke=\"white\" stroke-width=\"3\" {}>{}</text>\n",
                    px(best.left), px(best.bottom - 2.5), name.style, escaped(name.text));
    taken_.push_back(best);
  }
}

double Page::crowding(const Box& box, const Box& bounds) const {
  if (names_.size() > 400) return 0.0;
  double count = 0.0;
  for (const Box& other : taken_) count += box.meets(other) ? 1.0 : 0.0;
  for (const Box& other : shunned_) count += box.meets(other) ? 0.05 : 0.0;
  const bool outside = box.left < bounds.left + 2 || box.right > bounds.right - 2 || box.top < bounds.top + 2 ||
                       box.bottom > bounds.bottom - 2;
  return outside ? count + 10.0 : count;
}

std::string head(double width, double height, const std::string& title) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n<title>{2}</title>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      px(width), px(height), escaped(title));
}

std::string scale_bar(double scale, double wanted_px, double left, double y) {
  const double wanted = wanted_px / scale, decade = std::pow(10.0, std::floor(std::log10(wanted)));
  const double bar = wanted >= 5 * decade ? 5 * decade : wanted >= 2 * decade ? 2 * decade : decade;
  const double right = left + bar * scale;
  const PrefixedUnit to = prefixed_unit(bar * (1.0 + 1e-9), "m");
  return fmt::format(
      "<path d=\"M{4} {0} v6 H{1} v-6\" fill=\"none\" stroke=\"black\"/>\n<text x=\"{2}\" y=\"{3}\">{5:g} {6}</text>\n",
      px(y - 3), px(right), px(right + 6), px(y + 4), fmt::format("{:g}", left), bar / to.factor, to.unit);
}

}  // namespace freeplay::svg
