#include "drawing/mechanism_drawing.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <tuple>
#include <unordered_set>
#include <vector>

#include "component/joint_roles.h"
#include "drawing/given_start.h"
#include "drawing/joint_outline.h"
#include "drawing/joint_shapes.h"
#include "drawing/joint_stops.h"
#include "drawing/pitch_radii.h"
#include "drawing/spatial_drawing.h"
#include "svg/page.h"

namespace freeplay {
namespace {

using svg::length;
using svg::px;

class MechanismDrawing {
 public:
  MechanismDrawing(const System& system, const MechanismPicture& picture)
      : model_(system.model()), picture_(picture), q_(picture.q), given_(system, picture.q), shapes_(model_) {
    if (picture.at_start) moved_ = given_.moved();
  }

  std::string text() {
    fit();
    for (const BodyId id : moved_) draw_as_given(id);
    for (const std::vector<double>& q : picture_.others) draw_pale(q);
    for (const Trace& trace : picture_.traces) draw_trace(trace);
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) draw_body(static_cast<BodyId>(b));
    for (const JointElement& joint : model_.joints) draw_joint(joint);
    for (const AppliedForce& force : model_.forces) draw_force(force);
    draw_frames();
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) out_.centre(page({q_[3 * b], q_[3 * b + 1]}));
    out_.place_labels({0.0, 0.0, width, height_});
    std::string insets;
    for (std::size_t i = 0; i < picture_.magnified.size(); ++i) insets += inset(picture_.magnified[i], i);
    const double high = std::max(height_, inset_height * static_cast<double>(picture_.magnified.size()));
    return svg::head(width + (picture_.magnified.empty() ? 0.0 : inset_width), high, model_.name) + out_.text() +
           insets + caption() + svg::scale_bar(scale_, width / 6.0, 20.0, height_ - 14.0) + "</svg>\n";
  }

 private:
  static constexpr double width = 900.0, most_height = 1400.0, least_height = 260.0, margin = 70.0;
  static constexpr double inset_width = 262.0, inset_height = 274.0;
  static constexpr double rim = 12.0, least_rim = 8.0;  // radii of gears
  static constexpr double most_pitch = 3.0;             // radius of a wheel, of the rest of the mechanism
  static constexpr double curve_reach = 0.15;           // of a curve to both sides, of the width

  // --- places ----------------------------------------------------------------------------------------------------

  svg::Point world(const Marker& marker) const { return world(marker.body, {marker.position[0], marker.position[1]}); }

  svg::Point world(BodyId id, const svg::Point& p) const { return world(id, p, q_); }

  svg::Point world(BodyId id, const svg::Point& p, std::span<const double> q) const {
    if (id == ground) return p;
    const std::size_t b = static_cast<std::size_t>(id);
    const double angle = q[3 * b + 2], c = std::cos(angle), s = std::sin(angle);
    const svg::Point arm{p.x - model_.bodies[b].com[0], p.y - model_.bodies[b].com[1]};
    return {q[3 * b] + c * arm.x - s * arm.y, q[3 * b + 1] + s * arm.x + c * arm.y};
  }

  /// Points of a body that a joint or a force is at, those of outlines, and its centre of mass.
  std::vector<svg::Point> points_of(BodyId id, std::span<const double> q) const {
    std::vector<svg::Point> points;
    for (std::size_t m = 0; m < model_.markers.size(); ++m) {
      const Marker& one = model_.markers[m];
      if (one.body == id && !shapes_.stands_for(m)) points.push_back(world(id, {one.position[0], one.position[1]}, q));
    }
    for (const JointShape& shape : shapes_.all()) {
      if (marker(shape.marker).body != id) continue;
      for (const svg::Point& p : shape.points) points.push_back(world(id, p, q));
    }
    const std::size_t b = static_cast<std::size_t>(id);
    points.push_back({q[3 * b], q[3 * b + 1]});
    return points;
  }

  double angle_of(const Marker& marker) const {
    return marker.angle + (marker.body == ground ? 0.0 : q_[3 * static_cast<std::size_t>(marker.body) + 2]);
  }
  const Marker& marker(int index) const { return model_.markers[static_cast<std::size_t>(index)]; }

  svg::Point page(const svg::Point& p) const {
    return {width / 2 + scale_ * (p.x - middle_.x), height_ / 2 - scale_ * (p.y - middle_.y)};
  }

  static bool is_com(const Marker& marker) { return marker.name.ends_with("/com"); }
  static bool is_origin(const Marker& marker) { return marker.name.ends_with("/origin"); }

  void fit() {
    std::vector<svg::Point> all;
    for (const Marker& one : model_.frames) {
      if (!is_origin(one) || one.body != ground) all.push_back(world(one));
    }
    for (const Marker& one : model_.markers) all.push_back(world(one));
    for (const JointElement& joint : model_.joints) {
      const auto stops = stops_of(joint);
      if (!stops || !stops->slides) continue;
      const svg::Point x{std::cos(angle_of(marker(joint.marker_a))), std::sin(angle_of(marker(joint.marker_a)))};
      for (const double s : {stops->lower, stops->upper}) all.push_back(world(marker(joint.marker_a)) + s * x);
    }
    const auto add = [&](BodyId id, std::span<const double> q) {
      const std::vector<svg::Point> points = points_of(id, q);
      all.insert(all.end(), points.begin(), points.end());
    };
    for (const BodyId id : moved_) add(id, given_.q());
    for (const std::vector<double>& q : picture_.others) {
      for (std::size_t b = 0; b < model_.bodies.size(); ++b) add(static_cast<BodyId>(b), q);
    }
    for (const Trace& trace : picture_.traces) {
      for (const auto& p : trace.points) all.push_back({p[0], p[1]});
    }
    for (const JointElement& joint : model_.joints) {
      if (const auto curve = curve_of(joint); curve && !curve->polar) continue;  // its piece goes by the scale
      for (const std::vector<svg::Point>& line : outlines(joint)) all.insert(all.end(), line.begin(), line.end());
    }
    auto [low, high] = svg::ends_of(all);
    largest_pitch_ = most_pitch * std::max(high.x - low.x, high.y - low.y);
    for (const JointElement& joint : model_.joints) {
      if (joint.gear < 0) continue;
      const Gear& gear = model_.gears[static_cast<std::size_t>(joint.gear)];
      const svg::Point from = world_place(gear.first), to = world_place(gear.second);
      const PitchRadii radii = pitch_radii(length(to - from), ratio_of_wheels(model_, gear));
      if (!has_pitch_circles(gear, radii)) continue;
      for (const auto& [at, radius] : {std::pair(from, radii.first), std::pair(to, radii.second)}) {
        all.push_back({at.x - radius, at.y - radius});
        all.push_back({at.x + radius, at.y + radius});
      }
    }
    std::tie(low, high) = svg::ends_of(all);
    middle_ = 0.5 * (low + high);
    const svg::Point size = high - low;
    const double largest = std::max({size.x, size.y, 1e-9});
    scale_ = (width - 2 * margin) / std::max(size.x, 1e-6 * largest);
    scale_ = std::min(scale_, (most_height - 2 * margin) / std::max(size.y, 1e-6 * largest));
    // A mechanism on one vertical or horizontal line still gets a picture of ordinary proportions.
    scale_ = std::min(scale_, (width - 2 * margin) / largest);
    height_ = std::max(least_height, scale_ * size.y + 2 * margin);
  }

  /// Where strands or a curve go [m]; one that is not closed as far as a part of the picture.
  std::vector<std::vector<svg::Point>> outlines(const JointElement& joint) const {
    const svg::Point a = world(marker(joint.marker_a)), b = world(marker(joint.marker_b));
    if (const auto strands = strands_of(joint)) return {strand_line(*strands, a, b)};
    std::vector<std::vector<svg::Point>> lines;
    for (const JointShape& shape : JointShapes::of(model_, joint)) {
      lines.emplace_back();
      for (const svg::Point& p : shape.points) lines.back().push_back(world(marker(shape.marker).body, p));
    }
    const auto curve = curve_of(joint);
    if (!curve) return lines;
    return curve_lines(*curve, a, angle_of(marker(joint.marker_a)), b, curve_reach * width / scale_);
  }
  void draw_outlines(const JointElement& joint, const char* kind) {
    for (std::vector<svg::Point>& line : outlines(joint)) {
      for (svg::Point& p : line) p = page(p);
      draw_outline(out_, line, kind);
    }
  }

  /// Wheels that turn, of a size that leaves the mechanism visible.
  bool has_pitch_circles(const Gear& gear, const PitchRadii& radii) const {
    return turns(gear.first) && turns(gear.second) && std::max(radii.first, radii.second) <= largest_pitch_;
  }

  // --- shapes ----------------------------------------------------------------------------------------------------

  void draw_body(BodyId id) {
    std::vector<svg::Point> points = points_of(id, q_);
    for (svg::Point& p : points) p = page(p);
    const std::size_t b = static_cast<std::size_t>(id);
    const std::vector<svg::Point> outline = svg::hull(points);
    out_.shape(
        "<path d=\"{} Z\" fill=\"{}\" fill-opacity=\"0.25\" stroke=\"{}\" stroke-width=\"7\" stroke-opacity=\"0.55\" "
        "stroke-linejoin=\"round\" stroke-linecap=\"round\"/>\n",
        svg::path(outline), svg::tint(id), svg::tint(id));
    for (std::size_t i = 0; i < outline.size(); ++i) out_.shun(outline[i], outline[(i + 1) % outline.size()]);
    out_.label(model_.bodies[b].name, page({q_[3 * b], q_[3 * b + 1]}), "font-weight=\"bold\"");
  }

  /// Where the file gives the pose of a body that stands elsewhere: pale and dashed.
  void draw_as_given(BodyId id) {
    std::vector<svg::Point> points = points_of(id, given_.q());
    for (svg::Point& p : points) p = page(p);
    out_.shape(
        "<path class=\"given\" d=\"{} Z\" fill=\"none\" stroke=\"{}\" stroke-width=\"4\" stroke-opacity=\"0.35\" "
        "stroke-dasharray=\"9 6\" stroke-linejoin=\"round\"/>\n",
        svg::path(svg::hull(points)), svg::tint(id));
  }

  /// At another instant.
  void draw_pale(std::span<const double> q) {
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      const BodyId id = static_cast<BodyId>(b);
      std::vector<svg::Point> points = points_of(id, q);
      for (svg::Point& p : points) p = page(p);
      out_.shape(
          "<path class=\"other\" d=\"{} Z\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-opacity=\"0.3\" "
          "stroke-linejoin=\"round\"/>\n",
          svg::path(svg::hull(points)), svg::tint(id));
    }
  }

  void draw_trace(const Trace& trace) {
    std::vector<svg::Point> points;
    for (const auto& p : trace.points) points.push_back(page({p[0], p[1]}));
    draw_way(out_, points, "trace");
    out_.label(trace.name, points.back(), "fill=\"#0072B2\"");
  }

  /// A line, without points that move it less than a part of a pixel.
  static void draw_way(svg::Page& to, const std::vector<svg::Point>& points, const char* kind) {
    std::vector<svg::Point> kept;
    for (const svg::Point& p : points) {
      if (kept.empty() || length(p - kept.back()) > 0.3) kept.push_back(p);
    }
    if (kept.size() == 1) kept.push_back(kept.front());
    to.shape(
        "<path class=\"{}\" d=\"{}\" fill=\"none\" stroke=\"#0072B2\" stroke-width=\"1.2\" "
        "stroke-linejoin=\"round\"/>\n",
        kind, svg::path(kept));
  }

  /// The clearance of a joint with the way of its journal's or slider's centre, in a box right of the mechanism: a
  /// circle, or the walls of the guide, which lies level there; along it nothing is magnified.
  std::string inset(const MagnifiedJoint& magnified, std::size_t index) const {
    const JointElement& joint = model_.joints[static_cast<std::size_t>(magnified.joint)];
    const double top = inset_height * static_cast<double>(index) + 12.0, left = width, side = inset_width - 12.0;
    const double bottom = top + inset_height - 24.0, scale = scale_ * magnified.factor;
    const double play = scale * joint.layout.clearance;
    const svg::Point middle{left + 0.5 * side, 0.5 * (top + bottom) + 6.0};
    svg::Page box;
    box.shape(
        "<clipPath id=\"inset{0}\"><rect x=\"{1}\" y=\"{2}\" width=\"{3}\" height=\"{4}\"/></clipPath>\n"
        "<path d=\"M{5} {6} L{1} {2}\" stroke=\"#999999\" stroke-width=\"0.8\" stroke-dasharray=\"3 3\"/>\n"
        "<rect x=\"{1}\" y=\"{2}\" width=\"{3}\" height=\"{4}\" fill=\"white\" stroke=\"#999999\"/>\n"
        "<g class=\"inset\" clip-path=\"url(#inset{0})\">\n",
        index, px(left), px(top), px(side), px(bottom - top), px(page(world(marker(joint.marker_b))).x),
        px(page(world(marker(joint.marker_b))).y));
    const bool walls = plays_between_walls(joint.layout);
    constexpr const char* dashed = "class=\"clearance\" fill=\"none\" stroke=\"#cc3311\" stroke-dasharray=\"5 3\"";
    if (walls) {
      box.shape("<path {0} d=\"M{1} {2}h{4}M{1} {3}h{4}\"/>\n", dashed, px(left), px(middle.y - play),
                px(middle.y + play), px(side));
    } else {
      box.circle(middle, play, dashed);
    }
    box.shape("<path d=\"M{0} {1}m-4 0h8m-4 -4v8\" stroke=\"#cc3311\" stroke-width=\"0.8\"/>\n", px(middle.x),
              px(middle.y));
    const double whole = 0.48 * (bottom - top) * magnified.factor / play;  // times that fit
    const std::vector<svg::Point> points =
        walls ? way_along(magnified, middle, 0.9 * side) : way_about(magnified, middle);
    if (!points.empty()) {
      draw_way(box, points, "orbit");
      box.circle(points.back(), 4.0, "class=\"journal\" fill=\"black\"");
    }
    box.shape(
        "</g>\n<text x=\"{}\" y=\"{}\" font-weight=\"bold\" paint-order=\"stroke\" stroke=\"white\" "
        "stroke-width=\"4\">{}, {:g} times{}</text>\n",
        px(left + 8.0), px(top + 16.0), svg::escaped(joint.name), magnified.factor, walls ? " across" : "");
    // Beyond the corners of the box nothing of the circle is seen, and of walls nothing beyond its sides.
    if (magnified.factor > (walls ? 1.0 : 1.45) * whole) {
      box.shape("<text x=\"{}\" y=\"{}\" fill=\"#cc3311\">its clearance is larger: up to {:g} times</text>\n",
                px(left + 8.0), px(top + 32.0), whole < 10.0 ? 0.1 * std::floor(10.0 * whole) : std::floor(whole));
    }
    return box.text() + svg::scale_bar(scale, side / 4.0, left + 8.0, bottom - 10.0);
  }

  /// The way of a centre in the box.
  std::vector<svg::Point> way_about(const MagnifiedJoint& magnified, const svg::Point& middle) const {
    const double scale = scale_ * magnified.factor;
    std::vector<svg::Point> points;
    for (const auto& e : magnified.orbit) points.push_back({middle.x + scale * e[0], middle.y - scale * e[1]});
    return points;
  }
  std::vector<svg::Point> way_along(const MagnifiedJoint& magnified, const svg::Point& middle, double room) const {
    if (magnified.orbit.empty()) return {};
    const auto [first, last] =
        std::ranges::minmax(magnified.orbit, {}, [](const std::array<double, 2>& e) { return e[0]; });
    const double stroke = last[0] - first[0], from = 0.5 * (first[0] + last[0]);
    const double along = stroke * scale_ > room ? room / stroke : scale_;
    std::vector<svg::Point> points;
    for (const auto& e : magnified.orbit) {
      points.push_back({middle.x + along * (e[0] - from), middle.y - scale_ * magnified.factor * e[1]});
    }
    return points;
  }

  std::string caption() const {
    if (picture_.caption.empty()) return "";
    return fmt::format("<text x=\"20\" y=\"22\" font-size=\"13\">{}</text>\n", svg::escaped(picture_.caption));
  }

  void draw_joint(const JointElement& joint) {
    if (joint.gear >= 0) return draw_gear(joint);
    const Marker &a = marker(joint.marker_a), &b = marker(joint.marker_b);
    const svg::Point from = page(world(a)), to = page(world(b));
    const bool apart = length(to - from) > 6.0;
    const bool slides = joint.ideal_layout().coordinate == Coordinate::position;
    for (const auto& [one, at] : {std::pair(&a, from), std::pair(&b, to)}) {
      if (one->body == ground && !(slides && one == &a && apart)) out_.hatch(at);
    }
    if (joint.layout.constraint_rows == 0 && !joint.has_play) {
      if (const auto stops = stops_of(joint)) {
        const double turn = angle_of(a);
        draw_stops(out_, *stops, from, {std::cos(turn), -std::sin(turn)}, {-std::sin(turn), -std::cos(turn)}, scale_);
      } else if (strands_of(joint)) {
        draw_outlines(joint, "strands");
      } else if (joint.layout.outlines.empty()) {
        out_.spring(from, to);
      } else {
        draw_outlines(joint, "outline");
      }
      out_.label(joint.name, 0.5 * (from + to), "font-style=\"italic\"");
    } else if (slides) {
      draw_slide(from, to, angle_of(a), angle_of(b), a.body == ground);
      out_.label(joint.name, to, "");
    } else if (curve_of(joint)) {
      draw_outlines(joint, "curve");
      draw_pin(joint, to);
      out_.label(joint.name, to, "");
    } else if (apart && joint.ideal_layout().constraint_rows == 1) {
      out_.line(from, to, "stroke=\"black\" stroke-width=\"2\" stroke-dasharray=\"6 3\"");
      out_.label(joint.name, 0.5 * (from + to), "");
    } else {
      draw_pin(joint, to);
      out_.label(joint.name, to, "");
    }
  }

  /// Pitch circles about the two joints, which touch, and a line between them.
  void draw_gear(const JointElement& joint) {
    const Gear& gear = model_.gears[static_cast<std::size_t>(joint.gear)];
    const svg::Point first = world_place(gear.first), second = world_place(gear.second), from = page(first),
                     to = page(second);
    PitchRadii radii = pitch_radii(length(second - first), ratio_of_wheels(model_, gear));
    const bool drawn = has_pitch_circles(gear, radii) && scale_ * std::min(radii.first, radii.second) > least_rim;
    radii = drawn ? PitchRadii{scale_ * radii.first, scale_ * radii.second} : PitchRadii{rim, rim};
    for (const auto& [at, radius] : {std::pair(from, radii.first), std::pair(to, radii.second)}) {
      out_.shape(
          "<circle class=\"pitch\" cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"none\" stroke=\"#aa3377\" stroke-width=\"3\" "
          "stroke-dasharray=\"2 2\"/>\n",
          px(at.x), px(at.y), px(radius));
    }
    out_.line(from, to, "stroke=\"#aa3377\" stroke-dasharray=\"6 2 1 2\"");
    out_.label(joint.name, 0.5 * (from + to), "font-style=\"italic\"");
  }

  bool turns(int joint) const {
    const JointElement& one = model_.joints[static_cast<std::size_t>(joint)];
    return one.gear < 0 && one.ideal_layout().coordinate == Coordinate::angle;
  }

  /// Where a joint moves its second body.
  svg::Point world_place(int index) const {
    const JointElement& joint = model_.joints[static_cast<std::size_t>(index)];
    return joint.gear >= 0 ? world_place(model_.gears[static_cast<std::size_t>(joint.gear)].second)
                           : world(marker(joint.marker_b));
  }

  void draw_pin(const JointElement& joint, const svg::Point& at) {
    if (joint.ideal_layout().coordinate == Coordinate::angle) {
      if (joint.has_play) out_.circle(at, 9.0, "fill=\"none\" stroke=\"#cc3311\" stroke-width=\"1.5\"");
      out_.circle(at, 5.5, "fill=\"white\" stroke=\"black\" stroke-width=\"1.5\"");
      return;
    }
    out_.shape("<rect x=\"{}\" y=\"{}\" width=\"9\" height=\"9\" fill=\"black\"/>\n", px(at.x - 4.5), px(at.y - 4.5));
    out_.block(at, 5.0);
  }

  void draw_slide(const svg::Point& from, const svg::Point& to, double along, double turn, bool on_ground) {
    const svg::Point direction{std::cos(along), -std::sin(along)}, normal{direction.y, -direction.x};
    const double reach = std::max(40.0, length(to - from) + 25.0);
    out_.line(from - 30.0 * direction, from + reach * direction, "stroke=\"black\" stroke-width=\"0.8\"");
    if (on_ground) {
      for (double s = -25.0; s < reach; s += 8.0) {
        const svg::Point foot = from + s * direction;
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
    const svg::Point at = page(world(marker(force.marker)));
    out_.circle(at, 8.0, "fill=\"none\" stroke=\"#ee7733\" stroke-width=\"1.5\" stroke-dasharray=\"2 2\"");
    out_.label(force.name, at, "font-style=\"italic\"");
  }

  void draw_frames() {
    std::unordered_set<std::string_view> held;
    for (const Marker& one : model_.markers) held.insert(one.name);
    for (const Marker& one : model_.frames) {
      if (is_com(one) || is_origin(one)) continue;
      const svg::Point at = page(world(one));
      const double angle = angle_of(one);
      if (!held.contains(one.name)) {
        const svg::Point x{std::cos(angle), -std::sin(angle)}, y{-std::sin(angle), -std::cos(angle)};
        out_.line(at, at + 14.0 * x, "stroke=\"#cc3311\"");
        out_.line(at, at + 14.0 * y, "stroke=\"#228833\"");
        out_.block(at, 3.0);
      }
      out_.label(one.name, at, "fill=\"#666666\" font-size=\"9\"");
    }
  }

  const Model& model_;
  const MechanismPicture& picture_;
  std::span<const double> q_;
  GivenStart given_;
  std::span<const BodyId> moved_;
  JointShapes shapes_;
  double scale_ = 1.0, height_ = least_height;
  double largest_pitch_ = 0.0;  // [m]
  svg::Point middle_;
  svg::Page out_;
};

}  // namespace

std::array<double, 3> world_position(const System& system, const Marker& marker, std::span<const double> q) {
  if (marker.body == ground) return {marker.position[0], marker.position[1], marker.position[2]};
  const Pose pose = system.coordinates().frame_pose(marker.body, q);
  std::array<double, 3> at{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double* row = &pose.rotation[3 * i];
    at[i] = pose.position[i] + row[0] * marker.position[0] + row[1] * marker.position[1] + row[2] * marker.position[2];
  }
  return at;
}

std::string mechanism_svg(const System& system, const MechanismPicture& picture) {
  if (system.model().space == Space::spatial) return spatial_svg(system, picture);
  return MechanismDrawing(system, picture).text();
}

}  // namespace freeplay
