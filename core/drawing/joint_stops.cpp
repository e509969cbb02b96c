#include "drawing/joint_stops.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace freeplay {
namespace {

constexpr double way_radius = 21.0, bar = 7.0;  // px, of a turn; half of a bar across a way
constexpr int way_parts = 48;                   // of a whole turn
constexpr const char* bar_style = "class=\"stop\" stroke=\"#228833\" stroke-width=\"3.5\"";
constexpr const char* way_style = "fill=\"none\" stroke=\"#228833\" stroke-width=\"0.8\" stroke-dasharray=\"3 2\"";

}  // namespace

std::optional<JointStops> stops_of(const JointElement& joint) {
  if (joint.layout.constraint_rows > 0 || joint.has_play || !joint.parameters) return std::nullopt;
  if (joint.layout.coordinate != Coordinate::position && joint.layout.coordinate != Coordinate::angle) {
    return std::nullopt;
  }
  const auto& values = joint.parameters->values;
  const auto lower = values.find("lower"), upper = values.find("upper");
  if (lower == values.end() || upper == values.end()) return std::nullopt;
  const JointStops stops{lower->second.number, upper->second.number, joint.layout.coordinate == Coordinate::position};
  if (!std::isfinite(stops.lower) || !std::isfinite(stops.upper)) return std::nullopt;
  return stops;
}

void draw_stops(svg::Page& page, const JointStops& stops, const svg::Point& at, const svg::Point& x,
                const svg::Point& y, double scale) {
  const double size = length(x);
  if (stops.slides && size < 0.1) return;  // seen from its end
  const auto towards = [&](double angle) { return std::cos(angle) * x + std::sin(angle) * y; };
  const auto end = [&](double s) { return stops.slides ? at + scale * s * x : at + way_radius * towards(s); };
  for (const double s : {stops.lower, stops.upper}) {
    const svg::Point across = stops.slides ? (bar / size) * svg::Point{-x.y, x.x} : bar * towards(s);
    page.line(end(s) - across, end(s) + across, bar_style);
  }
  const double turn = std::min(stops.upper - stops.lower, 2.0 * std::numbers::pi);
  const int parts = stops.slides ? 1 : 1 + static_cast<int>(way_parts * turn / (2.0 * std::numbers::pi));
  const double way = stops.slides ? stops.upper - stops.lower : turn;
  std::vector<svg::Point> points;
  for (int i = 0; i <= parts; ++i) points.push_back(end(stops.lower + way * i / parts));
  page.shape("<path d=\"{}\" {}/>\n", svg::path(points), way_style);
  page.block(at, stops.slides ? bar : way_radius);
}

}  // namespace freeplay
