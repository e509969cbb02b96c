#include "drawing/spatial_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_set>
#include <utility>
#include <vector>

#include "drawing/given_start.h"
#include "drawing/joint_stops.h"
#include "drawing/pitch_radii.h"
#include "drawing/spatial_scene.h"
#include "drawing/view.h"

namespace freeplay {
namespace {

using Vector = Eigen::Vector3d;

// More names than these are in the isometric view alone.
constexpr std::size_t few = 16;

/// The smallest rectangle about some points.
struct Extent {
  svg::Point low, high;
  bool empty = true;

  void add(const svg::Point& p) {
    low = empty ? p : svg::Point{std::min(low.x, p.x), std::min(low.y, p.y)};
    high = empty ? p : svg::Point{std::max(high.x, p.x), std::max(high.y, p.y)};
    empty = false;
  }
  svg::Point middle() const { return 0.5 * (low + high); }
  svg::Point size() const { return high - low; }
};

std::string axis_word(const Vector& axis) {
  for (int k = 0; k < 3; ++k) {
    if (std::abs(axis[k]) > 0.99) return std::string(axis[k] > 0.0 ? "+" : "-") + "xyz"[k];
  }
  return "";
}

class SpatialDrawing {
 public:
  SpatialDrawing(const System& system, const MechanismPicture& picture)
      : picture_(picture),
        scene_(system, picture.q),
        given_(system, picture.q),
        given_scene_(system, given_.q()),
        model_(system.model()) {
    if (picture.at_start) moved_ = given_.moved();
    others_.reserve(picture.others.size());
    for (const std::vector<double>& q : picture.others) others_.emplace_back(system, q);
  }

  std::string text() {
    choose_views();
    lay_out();
    std::string out = svg::head(2 * panel_width, top_height_ + front_height_, model_.name);
    for (std::size_t i = 0; i < views_.size(); ++i) out += panel(views_[i], bounds_[i]);
    if (!picture_.caption.empty()) {
      out += fmt::format("<text x=\"{}\" y=\"18\" text-anchor=\"end\" font-size=\"13\">{}</text>\n",
                         svg::px(2 * panel_width - 10), svg::escaped(picture_.caption));
    }
    return out + "</svg>\n";
  }

 private:
  static constexpr double panel_width = 580.0, most_height = 560.0, least_height = 240.0, title_height = 18.0;
  static constexpr double least_rim = 8.0, most_rim = 120.0;  // radii of pitch circles that are drawn true
  static constexpr double margin = 52.0, axes_width = 80.0;   // the arrows of the axes stand left of everything else
  // --- views -----------------------------------------------------------------------------------------------------

  void choose_views() {
    Vector up = Vector::UnitZ();
    const Vector gravity(model_.gravity.data());
    int along = 0;
    if (gravity.cwiseAbs().maxCoeff(&along) > 0.99 * gravity.norm() && gravity.norm() > 0.0)
      up = Vector::Unit(along) * (gravity[along] > 0.0 ? -1.0 : 1.0);
    const Vector right = std::abs(up.x()) > 0.5 ? Vector::UnitY() : Vector::UnitX(), back = up.cross(right);
    views_ = {View("top", right, back),
              View("isometric", (right + back) / std::sqrt(2.0), (2.0 * up - right + back) / std::sqrt(6.0)),
              View("front", right, up), View("side", back, up)};
  }

  /// Four panels in two columns of one width; the three plain views have one scale and stand below and beside each
  /// other.
  void lay_out() {
    std::array<Extent, 4> extents;
    for (const Vector& p : scene_.points()) {
      for (std::size_t i = 0; i < views_.size(); ++i) extents[i].add(views_[i].flat(p));
    }
    const auto add = [&](const Vector& p) {
      for (std::size_t i = 0; i < views_.size(); ++i) extents[i].add(views_[i].flat(p));
    };
    for (const BodyId id : moved_) {
      for (const Vector& p : given_scene_.points_of(id)) add(p);
    }
    for (const SpatialScene& other : others_) {
      for (const Vector& p : other.points()) add(p);
    }
    for (const Trace& trace : picture_.traces) {
      for (const auto& p : trace.points) add(Vector(p.data()));
    }
    const auto size = [&](std::size_t i) { return extents[i].size(); };
    const double largest = std::max({size(0).x, size(0).y, size(2).y, 1e-9}), least = 1e-6 * largest;
    const double wide = panel_width - axes_width - 2 * margin, high = most_height - 2 * margin;
    const double plain = std::min({wide / std::max({size(0).x, size(3).x, least}),
                                   high / std::max({size(0).y, size(2).y, least}), wide / largest});
    const double slanted =
        std::min({wide / std::max(size(1).x, least), high / std::max(size(1).y, least), wide / largest});
    top_height_ = std::max({least_height, plain * size(0).y + 2 * margin, slanted * size(1).y + 2 * margin});
    front_height_ = std::max(least_height, plain * size(2).y + 2 * margin);
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const double left = i % 2 == 0 ? 0.0 : panel_width, top = i < 2 ? 0.0 : top_height_;
      const double height = i < 2 ? top_height_ : front_height_;
      bounds_[i] = {left, top, left + panel_width, top + height};
      views_[i].fit(extents[i].middle(), {left + (axes_width + panel_width) / 2, top + height / 2},
                    i == 1 ? slanted : plain);
    }
  }

  std::string panel(const View& view, const svg::Box& box) {
    page_ = svg::Page();
    view_ = &view;
    for (const BodyId id : moved_) draw_as_given(id);
    for (const SpatialScene& other : others_) draw_pale(other);
    draw_items();
    for (const Trace& trace : picture_.traces) draw_trace(trace);
    for (const AppliedForce& force : model_.forces) draw_force(force);
    draw_frames();
    page_.place_labels({box.left + axes_width, box.top + title_height, box.right, box.bottom});
    const std::string sight = axis_word(-view.toward());
    svg::Page border;
    border.shape("<text x=\"{}\" y=\"{}\" fill=\"#666666\">{}{}</text>\n", svg::px(box.left + 10),
                 svg::px(box.top + 16), view.name(), sight.empty() ? "" : ", seen along " + sight);
    solid::axes(border, view, {box.left + 38, box.bottom - 38}, 24.0);
    std::string out =
        fmt::format("<g id=\"{}\">\n<path d=\"M{} {} H{} V{} H{} Z\" fill=\"none\" stroke=\"#dddddd\"/>\n", view.name(),
                    svg::px(box.left), svg::px(box.top), svg::px(box.right), svg::px(box.bottom), svg::px(box.left));
    out += page_.text() + border.text();
    if (view.name() == "front")
      out += svg::scale_bar(view.scale(), panel_width / 6.0, box.left + axes_width + 10.0, box.bottom - 14.0);
    return out + "</g>\n";
  }

  // --- shapes ----------------------------------------------------------------------------------------------------

  struct Item {
    double depth;
    bool is_body;
    int index;
    int layer = 0, order = 0;
  };

  /// Bodies and joints, the furthest first.
  void draw_items() {
    std::vector<Item> items;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      const std::vector<Vector> points = scene_.points_of(static_cast<BodyId>(b));
      double depth = 0.0;
      for (const Vector& p : points) depth += view_->depth(p) / static_cast<double>(points.size());
      items.push_back({depth, true, static_cast<int>(b)});
      low = std::min(low, depth), high = std::max(high, depth);
    }
    // A joint is seen before the bodies that it joins, unless another one hides it.
    for (std::size_t i = 0; i < model_.joints.size(); ++i) {
      double depth = view_->depth(scene_.place(static_cast<int>(i)));
      for (const int index : {model_.joints[i].marker_a, model_.joints[i].marker_b}) {
        const BodyId body = model_.joints[i].gear >= 0 ? ground : scene_.marker(index).body;
        if (body != ground) depth = std::max(depth, items[static_cast<std::size_t>(body)].depth);
      }
      items.push_back({depth, false, static_cast<int>(i)});
    }
    for (Item& item : items) {
      // What is about as near is drawn in the order bodies, slides, turns, balls, which hide less and less.
      item.layer =
          scene_.reach() > 0.0 ? static_cast<int>(std::lround((item.depth - low) / (0.02 * scene_.reach()))) : 0;
      item.order = item.is_body ? 0 : 1 + scene_.freedom(item.index).turns;
    }
    std::ranges::stable_sort(items, {}, [](const Item& item) { return std::pair(item.layer, item.order); });
    for (const Item& item : items) {
      if (item.is_body) {
        draw_body(item.index, high > low ? (item.depth - low) / (high - low) : 1.0);
      } else {
        draw_joint(item.index);
      }
    }
  }

  /// Where the file gives the pose of a body that stands elsewhere: pale and dashed.
  void draw_as_given(BodyId id) {
    std::vector<svg::Point> points;
    for (const Vector& p : given_scene_.points_of(id)) points.push_back(view_->page(p));
    page_.shape(
        "<path class=\"given\" d=\"{} Z\" fill=\"none\" stroke=\"{}\" stroke-width=\"4\" stroke-opacity=\"0.35\" "
        "stroke-dasharray=\"9 6\" stroke-linejoin=\"round\"/>\n",
        svg::path(svg::hull(points)), svg::tint(id));
  }

  /// At another instant.
  void draw_pale(const SpatialScene& other) {
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      std::vector<svg::Point> points;
      for (const Vector& p : other.points_of(static_cast<BodyId>(b))) points.push_back(view_->page(p));
      page_.shape(
          "<path class=\"other\" d=\"{} Z\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-opacity=\"0.25\" "
          "stroke-linejoin=\"round\"/>\n",
          svg::path(svg::hull(points)), svg::tint(static_cast<BodyId>(b)));
    }
  }

  void draw_trace(const Trace& trace) {
    std::vector<svg::Point> points;
    for (const auto& p : trace.points) {
      const svg::Point at = view_->page(Vector(p.data()));
      if (points.empty() || svg::length(at - points.back()) > 0.3) points.push_back(at);
    }
    if (points.size() == 1) points.push_back(points.front());
    page_.shape("<path class=\"trace\" d=\"{}\" fill=\"none\" stroke=\"#0072B2\" stroke-width=\"1.2\"/>\n",
                svg::path(points));
    if (isometric()) page_.label(trace.name, points.back(), "fill=\"#0072B2\"");
  }

  /// `nearness` is 0 for the furthest and 1 for the nearest.
  void draw_body(BodyId id, double nearness) {
    std::vector<svg::Point> points;
    for (const Vector& p : scene_.points_of(id)) points.push_back(view_->page(p));
    const svg::Point centre = points.front();
    const std::vector<svg::Point> outline = svg::hull(points);
    const std::string path = svg::path(outline);
    page_.shape(
        "<path d=\"{} Z\" fill=\"white\" fill-opacity=\"0.5\" stroke=\"white\" stroke-width=\"11\" "
        "stroke-linejoin=\"round\" "
        "stroke-linecap=\"round\"/>\n",
        path);
    page_.shape(
        "<path d=\"{} Z\" fill=\"{}\" fill-opacity=\"{:.2f}\" stroke=\"{}\" stroke-width=\"7\" "
        "stroke-opacity=\"{:.2f}\" "
        "stroke-linejoin=\"round\" stroke-linecap=\"round\"/>\n",
        path, svg::tint(id), 0.15 + 0.15 * nearness, svg::tint(id), 0.35 + 0.35 * nearness);
    for (std::size_t i = 0; i < outline.size(); ++i) page_.shun(outline[i], outline[(i + 1) % outline.size()]);
    page_.centre(centre);
    name(model_.bodies[static_cast<std::size_t>(id)].name, centre, "font-weight=\"bold\"");
  }

  void name(const std::string& text, const svg::Point& at, const char* style) {
    if (isometric() || model_.bodies.size() + model_.joints.size() <= few) page_.label(text, at, style);
  }
  bool isometric() const { return view_->name() == "isometric"; }

  void draw_joint(int index) {
    const JointElement& one = scene_.joint(index);
    if (one.gear >= 0) return draw_gear(one);
    const Marker &a = scene_.marker(one.marker_a), &b = scene_.marker(one.marker_b);
    const svg::Point from = view_->page(scene_.world(a)), to = view_->page(scene_.world(b));
    const JointFreedom& freedom = scene_.freedom(index);
    if (a.body == ground) page_.hatch(from);
    if (b.body == ground) page_.hatch(to);
    if (one.layout.constraint_rows == 0 && !one.has_play) {
      if (const auto stops = stops_of(one)) {
        const Eigen::Matrix3d axes = scene_.axes_of(a);
        draw_stops(page_, *stops, from, view_->flat(axes.col(0)), view_->flat(axes.col(1)), view_->scale());
      } else {
        page_.spring(from, to);
      }
      return name(one.name, 0.5 * (from + to), "font-style=\"italic\"");
    }
    if (one.ideal_layout().constraint_rows == 1 && (scene_.world(a) - scene_.world(b)).norm() > 1e-6 * scene_.reach()) {
      page_.line(from, to, "stroke=\"black\" stroke-width=\"2\" stroke-dasharray=\"6 3\"");
      return name(one.name, 0.5 * (from + to), "");
    }
    // A slide between two moving bodies is drawn between their ends, which other joints may hold.
    const bool between = freedom.slides == 1 && freedom.turns == 0 && a.body != ground && b.body != ground;
    const svg::Point at = between ? 0.5 * (from + to) : to;
    draw_symbol(freedom, scene_.axes_of(a), from, to, at);
    if (one.has_play) page_.circle(at, 10.0, "fill=\"none\" stroke=\"#cc3311\" stroke-width=\"1.5\"");
    name(one.name, at, "");
  }

  /// What is left free: a bar turns about its axis, a block slides on its rail, a plate on its plane, a cross turns
  /// about its arms, a ball about all; a cube is fast.
  void draw_symbol(const JointFreedom& freedom, const Eigen::Matrix3d& axes, const svg::Point& from,
                   const svg::Point& to, const svg::Point& at) {
    if (freedom.slides == 1) {
      const svg::Point along = view_->flat(freedom.slide);
      const svg::Point low = from - 24.0 * along, high = to + 24.0 * along;
      page_.line(low, high, "stroke=\"black\" stroke-width=\"1.2\"");
      page_.shun(low, high);
    }
    const Eigen::Matrix3d edges = edges_along(freedom.slides == 2 ? freedom.slide : freedom.turn, axes);
    if (freedom.slides == 2) solid::block(page_, *view_, at, edges, {16.0, 16.0, 2.0}, 1.0);
    if (freedom.turns == 3) {
      solid::ball(page_, at, 6.0);
    } else if (freedom.turns == 2) {
      draw_cross(edges, at);
    } else if (freedom.turns == 1 && freedom.slides < 2) {
      solid::bar(page_, *view_, at, freedom.turn, freedom.slides == 1 ? 15.0 : 9.0, 5.0);
    } else if (freedom.slides == 1) {
      solid::block(page_, *view_, at, edges_along(freedom.slide, axes), {6.0, 6.0, 11.0}, 1.0);
    } else if (freedom.slides == 0 || freedom.slides == 3) {
      solid::block(page_, *view_, at, axes, {4.5, 4.5, 4.5}, 0.35);
    }
  }

  /// Right-handed axes of which the last is `direction`, and the first as near to one of `axes` as can be.
  static Eigen::Matrix3d edges_along(const Vector& direction, const Eigen::Matrix3d& axes) {
    int least = 0;
    (axes.transpose() * direction).cwiseAbs().minCoeff(&least);
    Eigen::Matrix3d edges;
    edges.col(2) = direction;
    edges.col(1) = direction.cross(axes.col(least)).normalized();
    edges.col(0) = edges.col(1).cross(direction);
    return edges;
  }

  void draw_cross(const Eigen::Matrix3d& edges, const svg::Point& at) {
    for (int k = 0; k < 2; ++k) {
      const svg::Point arm = 9.0 * view_->flat(edges.col(k));
      page_.line(at - arm, at + arm, "stroke=\"black\" stroke-width=\"3\" stroke-linecap=\"round\"");
      for (const double side : {-1.0, 1.0})
        page_.circle(at + side * arm, 2.6, "fill=\"white\" stroke=\"black\" stroke-width=\"1.1\"");
    }
  }

  void draw_gear(const JointElement& one) {
    const Gear& gear = model_.gears[static_cast<std::size_t>(one.gear)];
    const svg::Point from = view_->page(scene_.place(gear.first)), to = view_->page(scene_.place(gear.second));
    const JointFreedom &first = scene_.freedom(gear.first), &second = scene_.freedom(gear.second);
    const double apart = (scene_.place(gear.second) - scene_.place(gear.first)).norm();
    const bool parallel = first.turns == 1 && second.turns == 1 && first.turn.cross(second.turn).norm() < 1e-6;
    const PitchRadii radii = pitch_radii(view_->scale() * apart, ratio_of_wheels(model_, gear));
    const bool seen =
        parallel && std::min(radii.first, radii.second) > least_rim && std::max(radii.first, radii.second) < most_rim;
    const std::pair<svg::Point, const JointFreedom*> wheels[] = {{from, &first}, {to, &second}};
    for (const auto& [at, freedom] : wheels) {
      const double radius = !seen ? 12.0 : freedom == &first ? radii.first : radii.second;
      if (freedom->turns == 1) {
        solid::pitch_circle(page_, *view_, at, freedom->turn, radius);
      } else {
        page_.circle(at, 12.0,
                     "class=\"pitch\" fill=\"none\" stroke=\"#aa3377\" stroke-width=\"3\" stroke-dasharray=\"2 2\"");
      }
    }
    page_.line(from, to, "stroke=\"#aa3377\" stroke-dasharray=\"6 2 1 2\"");
    name(one.name, 0.5 * (from + to), "font-style=\"italic\"");
  }

  void draw_force(const AppliedForce& force) {
    const svg::Point at = view_->page(scene_.world(scene_.marker(force.marker)));
    page_.circle(at, 8.0, "fill=\"none\" stroke=\"#ee7733\" stroke-width=\"1.5\" stroke-dasharray=\"2 2\"");
    name(force.name, at, "font-style=\"italic\"");
  }

  void draw_frames() {
    std::unordered_set<std::string_view> held;
    for (const Marker& one : model_.markers) held.insert(one.name);
    for (const Marker& one : model_.frames) {
      if (SpatialScene::is_own(one)) continue;
      const svg::Point at = view_->page(scene_.world(one));
      if (!held.contains(one.name)) {
        constexpr const char* styles[] = {"stroke=\"#cc3311\"", "stroke=\"#228833\"", "stroke=\"#4477aa\""};
        const Eigen::Matrix3d axes = scene_.axes_of(one);
        for (int k = 0; k < 3; ++k) page_.line(at, at + 14.0 * view_->flat(axes.col(k)), styles[k]);
        page_.block(at, 3.0);
      }
      if (isometric()) page_.label(one.name, at, "fill=\"#666666\" font-size=\"9\"");
    }
  }

  const MechanismPicture& picture_;
  SpatialScene scene_;
  GivenStart given_;
  SpatialScene given_scene_;
  std::span<const BodyId> moved_;
  std::vector<SpatialScene> others_;
  const Model& model_;
  std::vector<View> views_;
  std::array<svg::Box, 4> bounds_{};
  double top_height_ = 0.0, front_height_ = 0.0;
  const View* view_ = nullptr;
  svg::Page page_;
};

}  // namespace

std::string spatial_svg(const System& system, const MechanismPicture& picture) {
  return SpatialDrawing(system, picture).text();
}

}  // namespace freeplay
