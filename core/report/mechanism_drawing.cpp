#include "report/mechanism_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_set>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"

namespace freeplay {
namespace {

constexpr double width = 900.0, most_height = 1400.0, least_height = 260.0, margin = 70.0;
constexpr double letter_width = 6.6, letter_height = 12.0;  // of the labels, 11 px

// Tints that stay apart in print; bodies take them in turn.
constexpr const char* tints[] = {"#4477aa", "#cc6677", "#228833", "#ccbb44",
                                 "#66ccee", "#aa3377", "#999933", "#882255"};

struct Point {
  double x = 0.0, y = 0.0;
};

Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y}; }
Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y}; }
Point operator*(double s, const Point& a) { return {s * a.x, s * a.y}; }
double cross(const Point& a, const Point& b) { return a.x * b.y - a.y * b.x; }
double length(const Point& a) { return std::hypot(a.x, a.y); }
bool before(const Point& a, const Point& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

struct Box {
  double left, top, right, bottom;
  bool meets(const Box& o) const { return left < o.right && o.left < right && top < o.bottom && o.top < bottom; }
};

/// Convex hull, counter-clockwise; fewer than three points when all lie on a line.
std::vector<Point> hull(std::vector<Point> points) {
  std::ranges::sort(points, before);
  points.erase(std::unique(points.begin(), points.end(), [](auto& a, auto& b) { return a.x == b.x && a.y == b.y; }),
               points.end());
  if (points.size() < 3) return points;
  std::vector<Point> out;
  for (const bool upper : {false, true}) {
    const std::size_t base = out.size();
    for (const Point& p : points) {
      while (out.size() >= base + 2 && cross(out.back() - out[out.size() - 2], p - out.back()) <= 0.0) out.pop_back();
      out.push_back(p);
    }
    out.pop_back();
    if (!upper) std::ranges::reverse(points);
  }
  return out;
}

/// As text in XML, which knows no control characters.
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

class Drawing {
 public:
  Drawing(const Model& model, std::span<const double> q) : model_(model), q_(q) {}

  std::string text() {
    fit();
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) draw_body(static_cast<BodyId>(b));
    for (const JointElement& joint : model_.joints) draw_joint(joint);
    for (const AppliedForce& force : model_.forces) draw_force(force);
    draw_frames();
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) draw_centre(static_cast<BodyId>(b));
    place_labels();
    return fmt::format(
               "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
               "font-family=\"sans-serif\" font-size=\"11\">\n<title>{2}</title>\n"
               "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
               px(width), px(height_), escaped(model_.name)) +
           shapes_ + labels_ + scale_bar() + "</svg>\n";
  }

 private:
  struct Label {
    std::string text;
    Point at;  ///< on the page, of what it names
    const char* style;
  };

  // --- places ----------------------------------------------------------------------------------------------------

  Point world(const Marker& marker) const { return world(marker.body, {marker.position[0], marker.position[1]}); }

  Point world(BodyId id, const Point& p) const {
    if (id == ground) return p;
    const std::size_t b = static_cast<std::size_t>(id);
    const double angle = q_[3 * b + 2], c = std::cos(angle), s = std::sin(angle);
    const Point arm{p.x - model_.bodies[b].com[0], p.y - model_.bodies[b].com[1]};
    return {q_[3 * b] + c * arm.x - s * arm.y, q_[3 * b + 1] + s * arm.x + c * arm.y};
  }

  double angle_of(const Marker& marker) const {
    return marker.angle + (marker.body == ground ? 0.0 : q_[3 * static_cast<std::size_t>(marker.body) + 2]);
  }
  const Marker& marker(int index) const { return model_.markers[static_cast<std::size_t>(index)]; }

  Point page(const Point& p) const {
    return {width / 2 + scale_ * (p.x - middle_.x), height_ / 2 - scale_ * (p.y - middle_.y)};
  }

  static bool is_com(const Marker& marker) { return marker.name.ends_with("/com"); }
  static bool is_origin(const Marker& marker) { return marker.name.ends_with("/origin"); }

  void fit() {
    std::vector<Point> all;
    for (const Marker& one : model_.frames) {
      if (!is_origin(one) || one.body != ground) all.push_back(world(one));
    }
    for (const Marker& one : model_.markers) all.push_back(world(one));
    Point low{0.0, 0.0}, high{0.0, 0.0};
    if (!all.empty()) low = high = all.front();
    for (const Point& p : all) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    middle_ = 0.5 * (low + high);
    const Point size = high - low;
    const double largest = std::max({size.x, size.y, 1e-9});
    scale_ = (width - 2 * margin) / std::max(size.x, 1e-6 * largest);
    scale_ = std::min(scale_, (most_height - 2 * margin) / std::max(size.y, 1e-6 * largest));
    // A mechanism on one vertical or horizontal line still gets a picture of ordinary proportions.
    scale_ = std::min(scale_, (width - 2 * margin) / largest);
    height_ = std::max(least_height, scale_ * size.y + 2 * margin);
  }

  // --- shapes ----------------------------------------------------------------------------------------------------

  template <class... Values>
  void shape(fmt::format_string<Values...> format, Values&&... values) {
    shapes_ += fmt::format(format, std::forward<Values>(values)...);
  }

  void line(const Point& a, const Point& b, const char* style) {
    shape("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" {}/>\n", px(a.x), px(a.y), px(b.x), px(b.y), style);
  }
  void circle(const Point& at, double radius, const char* style) {
    shape("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", px(at.x), px(at.y), px(radius), style);
    block(at, radius);
  }
  void block(const Point& at, double radius) {
    taken_.push_back({at.x - radius, at.y - radius, at.x + radius, at.y + radius});
  }
  /// Labels rather stay away from the line.
  void shun(const Point& a, const Point& b) {
    const int pieces = std::clamp(static_cast<int>(length(b - a) / 10.0), 1, 200);
    for (int i = 0; i <= pieces; ++i) {
      const Point at = a + (static_cast<double>(i) / pieces) * (b - a);
      shunned_.push_back({at.x - 3, at.y - 3, at.x + 3, at.y + 3});
    }
  }
  void label(std::string text, const Point& at, const char* style) { names_.push_back({std::move(text), at, style}); }

  const char* tint(BodyId id) const { return tints[static_cast<std::size_t>(id) % std::size(tints)]; }

  void draw_body(BodyId id) {
    std::vector<Point> points;
    for (const Marker& one : model_.markers) {
      if (one.body == id) points.push_back(page(world(one)));
    }
    const std::size_t b = static_cast<std::size_t>(id);
    points.push_back(page({q_[3 * b], q_[3 * b + 1]}));
    std::string path;
    for (const Point& p : hull(points)) path += fmt::format("{}{} {}", path.empty() ? "M" : " L", px(p.x), px(p.y));
    shape(
        "<path d=\"{} Z\" fill=\"{}\" fill-opacity=\"0.25\" stroke=\"{}\" stroke-width=\"7\" stroke-opacity=\"0.55\" "
        "stroke-linejoin=\"round\" stroke-linecap=\"round\"/>\n",
        path, tint(id), tint(id));
    const std::vector<Point> outline = hull(points);
    for (std::size_t i = 0; i < outline.size(); ++i) shun(outline[i], outline[(i + 1) % outline.size()]);
    label(model_.bodies[b].name, page({q_[3 * b], q_[3 * b + 1]}), "font-weight=\"bold\"");
  }

  void draw_centre(BodyId id) {
    const std::size_t b = static_cast<std::size_t>(id);
    const Point at = page({q_[3 * b], q_[3 * b + 1]});
    circle(at, 4.0, "fill=\"white\" stroke=\"black\" stroke-width=\"0.8\"");
    shape("<path d=\"M{0} {1} h4 a4 4 0 0 0 -4 -4 z m0 0 h-4 a4 4 0 0 0 4 4 z\" fill=\"black\"/>\n", px(at.x),
          px(at.y));
  }

  void hatch(const Point& at) {
    const double x = at.x, y = at.y + 8.0;
    line({x - 12, y}, {x + 12, y}, "stroke=\"black\"");
    for (int i = -2; i <= 2; ++i)
      line({x + 5.0 * i, y}, {x + 5.0 * i - 4, y + 6}, "stroke=\"black\" stroke-width=\"0.8\"");
    line(at, {x, y}, "stroke=\"black\"");
    taken_.push_back({x - 14, at.y, x + 12, y + 6});
  }

  void draw_joint(const JointElement& joint) {
    if (joint.gear >= 0) return draw_gear(joint);
    const Marker &a = marker(joint.marker_a), &b = marker(joint.marker_b);
    const Point from = page(world(a)), to = page(world(b));
    const bool apart = length(to - from) > 6.0;
    const bool slides = joint.ideal_layout.coordinate == Coordinate::position;
    for (const auto& [one, at] : {std::pair(&a, from), std::pair(&b, to)}) {
      if (one->body == ground && !(slides && one == &a && apart)) hatch(at);
    }
    if (joint.layout.constraint_rows == 0 && !joint.has_play) {
      draw_spring(from, to);
      label(joint.name, 0.5 * (from + to), "font-style=\"italic\"");
    } else if (slides) {
      draw_slide(from, to, angle_of(a), angle_of(b), a.body == ground);
      label(joint.name, to, "");
    } else if (apart && joint.ideal_layout.constraint_rows == 1) {
      line(from, to, "stroke=\"black\" stroke-width=\"2\" stroke-dasharray=\"6 3\"");
      label(joint.name, 0.5 * (from + to), "");
    } else {
      draw_pin(joint, to);
      label(joint.name, to, "");
    }
  }

  /// A toothed rim about each of the two joints, and a line between them.
  void draw_gear(const JointElement& joint) {
    const Gear& gear = model_.gears[static_cast<std::size_t>(joint.gear)];
    const Point from = place(gear.first), to = place(gear.second);
    for (const Point& at : {from, to}) {
      circle(at, 12.0, "fill=\"none\" stroke=\"#aa3377\" stroke-width=\"3\" stroke-dasharray=\"2 2\"");
    }
    line(from, to, "stroke=\"#aa3377\" stroke-dasharray=\"6 2 1 2\"");
    label(joint.name, 0.5 * (from + to), "font-style=\"italic\"");
  }

  /// On the page: where a joint moves its second body.
  Point place(int index) const {
    const JointElement& joint = model_.joints[static_cast<std::size_t>(index)];
    return joint.gear >= 0 ? place(model_.gears[static_cast<std::size_t>(joint.gear)].second)
                           : page(world(marker(joint.marker_b)));
  }

  void draw_pin(const JointElement& joint, const Point& at) {
    if (joint.ideal_layout.coordinate == Coordinate::angle) {
      if (joint.has_play) circle(at, 9.0, "fill=\"none\" stroke=\"#cc3311\" stroke-width=\"1.5\"");
      circle(at, 5.5, "fill=\"white\" stroke=\"black\" stroke-width=\"1.5\"");
      return;
    }
    shape("<rect x=\"{}\" y=\"{}\" width=\"9\" height=\"9\" fill=\"black\"/>\n", px(at.x - 4.5), px(at.y - 4.5));
    block(at, 5.0);
  }

  void draw_slide(const Point& from, const Point& to, double along, double turn, bool on_ground) {
    const Point direction{std::cos(along), -std::sin(along)}, normal{direction.y, -direction.x};
    const double reach = std::max(40.0, length(to - from) + 25.0);
    line(from - 30.0 * direction, from + reach * direction, "stroke=\"black\" stroke-width=\"0.8\"");
    if (on_ground) {
      for (double s = -25.0; s < reach; s += 8.0) {
        const Point foot = from + s * direction;
        line(foot, foot - 5.0 * (direction + normal), "stroke=\"black\" stroke-width=\"0.6\"");
      }
    }
    shape(
        "<rect x=\"-11\" y=\"-7\" width=\"22\" height=\"14\" transform=\"translate({} {}) rotate({})\" fill=\"white\" "
        "stroke=\"black\" stroke-width=\"1.5\"/>\n",
        px(to.x), px(to.y), px(-turn * 180.0 / 3.14159265358979323846));
    block(to, 11.0);
  }

  void draw_spring(const Point& from, const Point& to) {
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

  void draw_force(const AppliedForce& force) {
    const Point at = page(world(marker(force.marker)));
    circle(at, 8.0, "fill=\"none\" stroke=\"#ee7733\" stroke-width=\"1.5\" stroke-dasharray=\"2 2\"");
    label(force.name, at, "font-style=\"italic\"");
  }

  void draw_frames() {
    std::unordered_set<std::string_view> held;
    for (const Marker& one : model_.markers) held.insert(one.name);
    for (const Marker& one : model_.frames) {
      if (is_com(one) || is_origin(one)) continue;
      const Point at = page(world(one));
      const double angle = angle_of(one);
      if (!held.contains(one.name)) {
        const Point x{std::cos(angle), -std::sin(angle)}, y{-std::sin(angle), -std::cos(angle)};
        line(at, at + 14.0 * x, "stroke=\"#cc3311\"");
        line(at, at + 14.0 * y, "stroke=\"#228833\"");
        block(at, 3.0);
      }
      label(one.name, at, "fill=\"#666666\" font-size=\"9\"");
    }
  }

  // --- labels ----------------------------------------------------------------------------------------------------

  /// The first of many places around what it names where a label meets no other and no symbol; the nearest one else.
  void place_labels() {
    // Nobody reads a thousand names; finding room for them would take minutes.
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
          const double cost = crowding(box);
          if (cost < least) least = cost, best = box;
        }
      }
      if (length({(best.left + best.right) / 2 - name.at.x, best.bottom - name.at.y}) > wide / 2 + 30.0) {
        labels_ +=
            fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"#bbbbbb\" stroke-width=\"0.6\"/>\n",
                        px(name.at.x), px(name.at.y), px(std::clamp(name.at.x, best.left, best.right)),
                        px(std::clamp(name.at.y, best.top, best.bottom)));
      }
      labels_ += fmt::format(
          "<text x=\"{}\" y=\"{}\" paint-order=\"stroke\" stroke=\"white\" stroke-width=\"3\" {}>{}</text>\n",
          px(best.left), px(best.bottom - 2.5), name.style, escaped(name.text));
      taken_.push_back(best);
    }
  }

  double crowding(const Box& box) const {
    if (names_.size() > 400) return 0.0;
    double count = 0.0;
    for (const Box& other : taken_) count += box.meets(other) ? 1.0 : 0.0;
    for (const Box& other : shunned_) count += box.meets(other) ? 0.05 : 0.0;
    const bool outside = box.left < 2 || box.right > width - 2 || box.top < 2 || box.bottom > height_ - 2;
    return outside ? count + 10.0 : count;
  }

  /// A length of 1, 2 or 5 times a power of ten that takes about a sixth of the width.
  std::string scale_bar() const {
    const double wanted = width / 6.0 / scale_, decade = std::pow(10.0, std::floor(std::log10(wanted)));
    const double bar = wanted >= 5 * decade ? 5 * decade : wanted >= 2 * decade ? 2 * decade : decade;
    const double y = height_ - 14.0, right = 20.0 + bar * scale_;
    return fmt::format(
        "<path d=\"M20 {0} v6 H{1} v-6\" fill=\"none\" stroke=\"black\"/>\n<text x=\"{2}\" y=\"{3}\">{4:g} m</text>\n",
        px(y - 3), px(right), px(right + 6), px(y + 4), bar);
  }

  const Model& model_;
  std::span<const double> q_;
  double scale_ = 1.0, height_ = least_height;
  Point middle_;
  std::string shapes_, labels_;
  std::vector<Label> names_;
  std::vector<Box> taken_, shunned_;
};

}  // namespace

std::string mechanism_svg(const Model& model, std::span<const double> q) { return Drawing(model, q).text(); }

}  // namespace freeplay
