#include "drawing/mechanism_drawing.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "drawing/given_start.h"
#include "drawing/spatial_drawing.h"
#include "svg/page.h"

namespace freeplay {
namespace {

constexpr double width = 900.0, most_height = 1400.0, least_height = 260.0, margin = 70.0;

using svg::length;
using svg::Point;
using svg::px;

class Drawing {
 public:
  Drawing(const System& system, std::span<const double> q) : model_(system.model()), q_(q), given_(system, q) {}

  std::string text() {
    fit();
    for (const BodyId id : given_.moved()) draw_as_given(id);
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) draw_body(static_cast<BodyId>(b));
    for (const JointElement& joint : model_.joints) draw_joint(joint);
    for (const AppliedForce& force : model_.forces) draw_force(force);
    draw_frames();
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) out_.centre(page({q_[3 * b], q_[3 * b + 1]}));
    out_.place_labels({0.0, 0.0, width, height_});
    return svg::head(width, height_, model_.name) + out_.text() +
           svg::scale_bar(scale_, width / 6.0, 20.0, height_ - 14.0) + "</svg>\n";
  }

 private:
  // --- places ----------------------------------------------------------------------------------------------------

  Point world(const Marker& marker) const { return world(marker.body, {marker.position[0], marker.position[1]}); }

  Point world(BodyId id, const Point& p) const { return world(id, p, q_); }

  Point world(BodyId id, const Point& p, std::span<const double> q) const {
    if (id == ground) return p;
    const std::size_t b = static_cast<std::size_t>(id);
    const double angle = q[3 * b + 2], c = std::cos(angle), s = std::sin(angle);
    const Point arm{p.x - model_.bodies[b].com[0], p.y - model_.bodies[b].com[1]};
    return {q[3 * b] + c * arm.x - s * arm.y, q[3 * b + 1] + s * arm.x + c * arm.y};
  }

  /// Points of a body that a joint or a force is at, and its centre of mass.
  std::vector<Point> points_of(BodyId id, std::span<const double> q) const {
    std::vector<Point> points;
    for (const Marker& one : model_.markers) {
      if (one.body == id) points.push_back(world(id, {one.position[0], one.position[1]}, q));
    }
    const std::size_t b = static_cast<std::size_t>(id);
    points.push_back({q[3 * b], q[3 * b + 1]});
    return points;
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
    for (const BodyId id : given_.moved()) {
      const std::vector<Point> points = points_of(id, given_.q());
      all.insert(all.end(), points.begin(), points.end());
    }
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

  void draw_body(BodyId id) {
    std::vector<Point> points = points_of(id, q_);
    for (Point& p : points) p = page(p);
    const std::size_t b = static_cast<std::size_t>(id);
    const std::vector<Point> outline = svg::hull(points);
    out_.shape(
        "<path d=\"{} Z\" fill=\"{}\" fill-opacity=\"0.25\" stroke=\"{}\" stroke-width=\"7\" stroke-opacity=\"0.55\" "
        "stroke-linejoin=\"round\" stroke-linecap=\"round\"/>\n",
        svg::path(outline), svg::tint(id), svg::tint(id));
    for (std::size_t i = 0; i < outline.size(); ++i) out_.shun(outline[i], outline[(i + 1) % outline.size()]);
    out_.label(model_.bodies[b].name, page({q_[3 * b], q_[3 * b + 1]}), "font-weight=\"bold\"");
  }

  /// Where the file gives the pose of a body that stands elsewhere: pale and dashed.
  void draw_as_given(BodyId id) {
    std::vector<Point> points = points_of(id, given_.q());
    for (Point& p : points) p = page(p);
    out_.shape(
        "<path class=\"given\" d=\"{} Z\" fill=\"none\" stroke=\"{}\" stroke-width=\"4\" stroke-opacity=\"0.35\" "
        "stroke-dasharray=\"9 6\" stroke-linejoin=\"round\"/>\n",
        svg::path(svg::hull(points)), svg::tint(id));
  }

  void draw_joint(const JointElement& joint) {
    if (joint.gear >= 0) return draw_gear(joint);
    const Marker &a = marker(joint.marker_a), &b = marker(joint.marker_b);
    const Point from = page(world(a)), to = page(world(b));
    const bool apart = length(to - from) > 6.0;
    const bool slides = joint.ideal_layout.coordinate == Coordinate::position;
    for (const auto& [one, at] : {std::pair(&a, from), std::pair(&b, to)}) {
      if (one->body == ground && !(slides && one == &a && apart)) out_.hatch(at);
    }
    if (joint.layout.constraint_rows == 0 && !joint.has_play) {
      out_.spring(from, to);
      out_.label(joint.name, 0.5 * (from + to), "font-style=\"italic\"");
    } else if (slides) {
      draw_slide(from, to, angle_of(a), angle_of(b), a.body == ground);
      out_.label(joint.name, to, "");
    } else if (apart && joint.ideal_layout.constraint_rows == 1) {
      out_.line(from, to, "stroke=\"black\" stroke-width=\"2\" stroke-dasharray=\"6 3\"");
      out_.label(joint.name, 0.5 * (from + to), "");
    } else {
      draw_pin(joint, to);
      out_.label(joint.name, to, "");
    }
  }

  /// A toothed rim about each of the two joints, and a line between them.
  void draw_gear(const JointElement& joint) {
    const Gear& gear = model_.gears[static_cast<std::size_t>(joint.gear)];
    const Point from = place(gear.first), to = place(gear.second);
    for (const Point& at : {from, to}) {
      out_.circle(at, 12.0, "fill=\"none\" stroke=\"#aa3377\" stroke-width=\"3\" stroke-dasharray=\"2 2\"");
    }
    out_.line(from, to, "stroke=\"#aa3377\" stroke-dasharray=\"6 2 1 2\"");
    out_.label(joint.name, 0.5 * (from + to), "font-style=\"italic\"");
  }

  /// On the page: where a joint moves its second body.
  Point place(int index) const {
    const JointElement& joint = model_.joints[static_cast<std::size_t>(index)];
    return joint.gear >= 0 ? place(model_.gears[static_cast<std::size_t>(joint.gear)].second)
                           : page(world(marker(joint.marker_b)));
  }

  void draw_pin(const JointElement& joint, const Point& at) {
    if (joint.ideal_layout.coordinate == Coordinate::angle) {
      if (joint.has_play) out_.circle(at, 9.0, "fill=\"none\" stroke=\"#cc3311\" stroke-width=\"1.5\"");
      out_.circle(at, 5.5, "fill=\"white\" stroke=\"black\" stroke-width=\"1.5\"");
      return;
    }
    out_.shape("<rect x=\"{}\" y=\"{}\" width=\"9\" height=\"9\" fill=\"black\"/>\n", px(at.x - 4.5), px(at.y - 4.5));
    out_.block(at, 5.0);
  }

  void draw_slide(const Point& from, const Point& to, double along, double turn, bool on_ground) {
    const Point direction{std::cos(along), -std::sin(along)}, normal{direction.y, -direction.x};
    const double reach = std::max(40.0, length(to - from) + 25.0);
    out_.line(from - 30.0 * direction, from + reach * direction, "stroke=\"black\" stroke-width=\"0.8\"");
    if (on_ground) {
      for (double s = -25.0; s < reach; s += 8.0) {
        const Point foot = from + s * direction;
        out_.line(foot, foot - 5.0 * (direction + normal), "stroke=\"black\" stroke-width=\"0.6\"");
      }
    }
    out_.shape(
        "<rect x=\"-11\" y=\"-7\" width=\"22\" height=\"14\" transform=\"translate({} {}) rotate({})\" fill=\"white\" "
        "stroke=\"black\" stroke-width=\"1.5\"/>\n",
        px(to.x), px(to.y), px(-turn * 180.0 / 3.14159265358979323846));
    out_.block(to, 11.0);
  }

  void draw_force(const AppliedForce& force) {
    const Point at = page(world(marker(force.marker)));
    out_.circle(at, 8.0, "fill=\"none\" stroke=\"#ee7733\" stroke-width=\"1.5\" stroke-dasharray=\"2 2\"");
    out_.label(force.name, at, "font-style=\"italic\"");
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
        out_.line(at, at + 14.0 * x, "stroke=\"#cc3311\"");
        out_.line(at, at + 14.0 * y, "stroke=\"#228833\"");
        out_.block(at, 3.0);
      }
      out_.label(one.name, at, "fill=\"#666666\" font-size=\"9\"");
    }
  }

  const Model& model_;
  std::span<const double> q_;
  GivenStart given_;
  double scale_ = 1.0, height_ = least_height;
  Point middle_;
  svg::Page out_;
};

}  // namespace

std::string mechanism_svg(const System& system, std::span<const double> q) {
  if (system.model().space == Space::spatial) return spatial_svg(system, q);
  return Drawing(system, q).text();
}

}  // namespace freeplay
