#include "drawing/view.h"

#include <algorithm>
#include <cmath>

namespace freeplay::solid {
namespace {

using svg::px;
using Vector = Eigen::Vector3d;

constexpr double full_turn = 6.283185307179586;
constexpr const char* axis_tints[] = {"#cc3311", "#228833", "#4477aa"};

std::vector<svg::Point> ring(const View& view, const svg::Point& at, const Vector& axis, double radius) {
  const Vector side = axis.unitOrthogonal(), other = axis.cross(side);
  std::vector<svg::Point> points;
  const int corners = radius < 40.0 ? 24 : 72;
  for (int i = 0; i < corners; ++i) {
    const double angle = full_turn * i / corners;
    points.push_back(at + radius * view.flat(std::cos(angle) * side + std::sin(angle) * other));
  }
  return points;
}

void arrow(svg::Page& page, const svg::Point& from, const svg::Point& to, const char* tint) {
  const svg::Point along = (1.0 / svg::length(to - from)) * (to - from), across{-along.y, along.x};
  const svg::Point foot = to - 6.0 * along, left = foot + 3.0 * across, right = foot - 3.0 * across;
  page.shape("<path d=\"M{} {} L{} {}\" stroke=\"{}\" stroke-width=\"1.4\"/>\n", px(from.x), px(from.y), px(foot.x),
             px(foot.y), tint);
  page.shape("<path d=\"{} Z\" fill=\"{}\"/>\n", svg::path({to, left, right}), tint);
}

}  // namespace

void bar(svg::Page& page, const View& view, const svg::Point& at, const Vector& axis, double half, double radius) {
  const Vector near = view.depth(axis) < 0.0 ? Vector(-axis) : axis;
  const svg::Point reach = half * view.flat(near);
  std::vector<svg::Point> all = ring(view, at + reach, near, radius);
  const std::vector<svg::Point> end = all;
  for (const svg::Point& p : ring(view, at - reach, near, radius)) all.push_back(p);
  page.shape("<path d=\"{} Z\" fill=\"white\" stroke=\"black\" stroke-width=\"1.3\" stroke-linejoin=\"round\"/>\n",
             svg::path(svg::hull(all)));
  page.shape("<path d=\"{} Z\" fill=\"#cccccc\" stroke=\"black\" stroke-width=\"0.8\"/>\n", svg::path(end));
  page.block(at, std::max(radius, half * svg::length(view.flat(axis))));
}

void block(svg::Page& page, const View& view, const svg::Point& at, const Eigen::Matrix3d& axes, const Vector& half,
           double grey) {
  for (int k = 0; k < 3; ++k) {
    const double seen = view.depth(axes.col(k));
    if (std::abs(seen) < 1e-9) continue;
    const double side = seen > 0.0 ? 1.0 : -1.0;
    const Vector centre = side * half[k] * axes.col(k);
    const Vector u = half[(k + 1) % 3] * axes.col((k + 1) % 3), v = half[(k + 2) % 3] * axes.col((k + 2) % 3);
    std::vector<svg::Point> corners;
    for (const Vector& corner :
         {Vector(centre + u + v), Vector(centre + u - v), Vector(centre - u - v), Vector(centre - u + v)})
      corners.push_back(at + view.flat(corner));
    // Faces that turn away from the eye are darker.
    const int shade = static_cast<int>(std::lround(255.0 * grey * (0.75 + 0.25 * std::abs(seen))));
    page.shape(
        "<path d=\"{} Z\" fill=\"#{:02x}{:02x}{:02x}\" stroke=\"black\" stroke-width=\"1.1\" "
        "stroke-linejoin=\"round\"/>\n",
        svg::path(corners), shade, shade, shade);
  }
  page.block(at, half.maxCoeff());
}

void pitch_circle(svg::Page& page, const View& view, const svg::Point& at, const Vector& axis, double radius) {
  page.shape(
      "<path class=\"pitch\" d=\"{} Z\" fill=\"none\" stroke=\"#aa3377\" stroke-width=\"2.5\" stroke-dasharray=\"2 "
      "2\"/>\n",
      svg::path(ring(view, at, axis, radius)));
}

void ball(svg::Page& page, const svg::Point& at, double radius) {
  page.circle(at, radius, "fill=\"#bbbbbb\" stroke=\"black\" stroke-width=\"1.3\"");
  page.circle(at - svg::Point{0.3 * radius, 0.35 * radius}, 0.25 * radius, "fill=\"white\"");
}

void axes(svg::Page& page, const View& view, const svg::Point& at, double length) {
  for (int k = 0; k < 3; ++k) {
    const Vector axis = Vector::Unit(k);
    const svg::Point flat = view.flat(axis);
    const char* tint = axis_tints[k];
    svg::Point name = at + (length + 9.0) * flat;
    if (svg::length(flat) > 1e-6) {
      arrow(page, at, at + length * flat, tint);
    } else {
      page.shape("<circle cx=\"{}\" cy=\"{}\" r=\"4.5\" fill=\"white\" stroke=\"{}\" stroke-width=\"1.2\"/>\n",
                 px(at.x), px(at.y), tint);
      if (view.depth(axis) > 0.0) {
        page.shape("<circle cx=\"{}\" cy=\"{}\" r=\"1.5\" fill=\"{}\"/>\n", px(at.x), px(at.y), tint);
      } else {
        page.shape("<path d=\"M{} {} l6 6 m0 -6 l-6 6\" stroke=\"{}\"/>\n", px(at.x - 3), px(at.y - 3), tint);
      }
      name = at + svg::Point{-11.0, 11.0};
    }
    page.shape("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" fill=\"{}\">{}</text>\n", px(name.x), px(name.y + 4),
               tint, "xyz"[k]);
  }
}

}  // namespace freeplay::solid
