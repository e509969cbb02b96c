#include "drawing/joint_outline.h"

#include <cmath>
#include <exception>
#include <numbers>

#include "base/angle.h"

namespace freeplay {
namespace {

constexpr int arc_parts = 48, curve_parts = 240;  // of a whole turn; of a curve

const ParameterValue* value_of(const JointElement& joint, const char* name) {
  if (!joint.parameters) return nullptr;
  const auto found = joint.parameters->values.find(name);
  return found == joint.parameters->values.end() ? nullptr : &found->second;
}

svg::Point towards(const svg::Point& u, double angle) {
  return std::cos(angle) * u + std::sin(angle) * svg::Point{-u.y, u.x};
}

void add_arc(std::vector<svg::Point>& to, const svg::Point& middle, const svg::Point& u, double radius, double from,
             double until) {
  const int parts = 1 + static_cast<int>(arc_parts * std::abs(until - from) / whole_turn);
  for (int i = 0; i <= parts; ++i) to.push_back(middle + radius * towards(u, from + (until - from) * i / parts));
}

}  // namespace

std::optional<StrandShape> strands_of(const JointElement& joint) {
  const ParameterValue *first = value_of(joint, "first_radius"), *second = value_of(joint, "second_radius"),
                       *strands = value_of(joint, "strands");
  if (joint.has_play || first == nullptr || second == nullptr || strands == nullptr) return std::nullopt;
  return StrandShape{first->number, second->number, strands->word == 1};
}

// The normals of both strands stand at the angle theta to both sides of the line of centres u.
std::vector<svg::Point> strand_line(const StrandShape& strands, const svg::Point& first, const svg::Point& second) {
  const double apart = length(second - first), sense = strands.crossed ? -1.0 : 1.0;
  const double across = strands.second - sense * strands.first;
  if (!(apart > std::abs(across))) return {};
  const svg::Point u = (1.0 / apart) * (second - first);
  const double theta = std::acos(-sense * across / apart);
  const double at_second = strands.crossed ? theta - std::numbers::pi : theta;
  std::vector<svg::Point> line;
  add_arc(line, first, u, strands.first, theta, whole_turn - theta);
  add_arc(line, second, u, strands.second, -at_second, at_second);
  line.push_back(line.front());
  return line;
}

std::optional<CurveShape> curve_of(const JointElement& joint) {
  const ParameterValue *curve = value_of(joint, "curve"), *form = value_of(joint, "form");
  if (curve == nullptr || form == nullptr || !curve->formula) return std::nullopt;
  return CurveShape{curve->formula, form->word == 1};
}

std::vector<std::vector<svg::Point>> curve_lines(const CurveShape& shape, const svg::Point& origin, double angle,
                                                 const svg::Point& at, double reach) {
  const svg::Point h{std::cos(angle), std::sin(angle)}, n{-h.y, h.x}, d = at - origin;
  const double middle = h.x * d.x + h.y * d.y;
  const double from = shape.polar ? 0.0 : middle - reach, until = shape.polar ? whole_turn : middle + reach;
  std::vector<std::vector<svg::Point>> lines(1);
  for (int i = 0; i <= curve_parts; ++i) {
    const double x[] = {from + (until - from) * i / curve_parts};
    double y = 0.0;
    try {
      y = shape.curve.at(x);
    } catch (const std::exception&) {
      if (!lines.back().empty()) lines.emplace_back();
      continue;
    }
    lines.back().push_back(origin + (shape.polar ? y * towards(h, x[0]) : x[0] * h + y * n));
  }
  if (lines.back().empty()) lines.pop_back();
  return lines;
}

void draw_outline(svg::Page& page, const std::vector<svg::Point>& points, const char* kind) {
  if (points.size() < 2) return;
  for (std::size_t i = 1; i < points.size(); ++i) page.shun(points[i - 1], points[i]);
  page.shape("<path class=\"{}\" d=\"{}\" fill=\"none\" stroke=\"#aa3377\" stroke-width=\"2.5\"/>\n", kind,
             svg::path(points));
}

}  // namespace freeplay
