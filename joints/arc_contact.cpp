#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "boundary_contact.h"

namespace freeplay {
namespace {

using namespace play;

constexpr double whole_turn = 2.0 * std::numbers::pi;

/// A disc of radius r about b and an arc of a circle of radius R about a, counter-clockwise between two angles in the
/// axes of a: the outside of a cam or a wheel, or a hollow, whichever side the middle of the disc is on. With d = P_b -
/// P_a and the point C of the arc that is nearest to P_b, which may be one of its ends,
///
///   m = (C - d)/|C - d|    delta = r - |C - d|;    of the arc itself |C - d| = | |d| - R |
///
/// delta is continuous, and so is m but where the middle of the disc would pass through the arc.
struct DiscAtArc {
  static constexpr std::size_t contacts = 1;
  static constexpr bool leaves = true;

  template <class T>
  ContactPlace<T> place(const PlanarMotion<T>& m, std::size_t) const {
    const double x = space::value_of(m.d.x), y = space::value_of(m.d.y);
    if (holds(std::atan2(y, x))) return at_arc(m.d, x * x + y * y < radius * radius);
    const auto [first, second] = std::pair(end(-1.0), end(1.0));
    return at_end(m.d, std::hypot(first.x - x, first.y - y) <= std::hypot(second.x - x, second.y - y) ? first : second);
  }
  std::array<double, 2> stand(const PlanarMotion<double>& m) const {
    return {std::sqrt(dot(m.d, m.d)), std::atan2(m.d.y, m.d.x)};
  }
  static constexpr bool between_walls() { return false; }

  double radius, middle, half;  ///< R [m], and of the angles [rad]; half a turn: the whole circle
  double disc;                  ///< r [m]
  double play;                  ///< scale of a flight [m]

 private:
  static constexpr double smallest = 1e-15;  // distance with a direction [m]

  bool holds(double angle) const {
    return half >= std::numbers::pi || std::abs(std::remainder(angle - middle, whole_turn)) <= half;
  }
  Vec2<double> end(double side) const {
    const double angle = middle + side * half;
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }
  template <class T>
  ContactPlace<T> at_arc(const Vec2<T>& d, bool within) const {
    const T squared = dot(d, d);
    const double side = within ? 1.0 : -1.0, sum = radius - side * disc;
    if (!(space::value_of(squared) > smallest * smallest)) {
      const Vec2<T> along{T(1.0), T(0.0)};
      return {d.x - T(sum), along, T(disc) * along};
    }
    const T distance = sqrt(squared);
    // Outside R + r - |d|, within |d| - (R - r), without the loss of digits near zero.
    return at(T(side) * (squared - T(sum * sum)) / (distance + T(sum)),
              {T(side) * d.x / distance, T(side) * d.y / distance});
  }
  template <class T>
  ContactPlace<T> at_end(const Vec2<T>& d, const Vec2<double>& end) const {
    const Vec2<T> to_end = Vec2<T>{T(end.x), T(end.y)} - d;
    const T squared = dot(to_end, to_end);
    if (!(space::value_of(squared) > smallest * smallest)) return at(T(disc), {T(1.0), T(0.0)});
    const T distance = sqrt(squared);
    return at((T(disc * disc) - squared) / (distance + T(disc)), {to_end.x / distance, to_end.y / distance});
  }
  /// Both forces act halfway between the two surfaces.
  template <class T>
  ContactPlace<T> at(const T& delta, const Vec2<T>& normal) const {
    return {delta, normal, (T(disc) - T(0.5) * delta) * normal};
  }
};

constexpr auto disc_channels = boundary_channels({"distance", "m"}, {"direction", "rad"});

class ArcContact final : public BoundaryContact<DiscAtArc> {
 public:
  explicit ArcContact(const Parameters& p) : ArcContact(p, read(p)) {}
  void declare(JointLayout& layout) const override {
    declare_boundary(layout, {disc_channels.data(), disc_channels.size()},
                     std::min(geometry().radius, geometry().disc));
  }

 private:
  static DiscAtArc read(const Parameters& p) {
    DiscAtArc arc{p.number("arc.radius"), 0.0, std::numbers::pi, p.number("disc"), 0.0};
    arc.play = 1e-3 * std::min(arc.radius, arc.disc);
    const bool from = p.given("arc.from"), to = p.given("arc.to");
    if (from != to)
      throw BadParameter(from ? "arc.from" : "arc.to", "missing-key",
                         "an arc needs both 'from' and 'to'; without them it is the whole circle");
    if (!from) return arc;
    const double begin = p.number("arc.from"), end = p.number("arc.to");
    if (!(begin < end && end - begin <= whole_turn))
      throw BadParameter("arc.to", "out-of-range",
                         "an arc goes counter-clockwise: 'to' must be above 'from', by one turn at most");
    if (!(arc.disc < arc.radius))
      throw BadParameter("disc", "out-of-range",
                         "a disc before a part of a circle must be smaller than the circle: it would touch both ends");
    arc.middle = 0.5 * (begin + end);
    arc.half = 0.5 * (end - begin);
    return arc;
  }
  ArcContact(const Parameters& p, const DiscAtArc& arc)
      : BoundaryContact(arc, boundary_laws(p, arc.play), outlines_of(arc)) {}
  static Outlines outlines_of(const DiscAtArc& arc) {
    Outlines lines;
    lines.add_arc(0, 0.0, arc.radius, arc.middle - arc.half, arc.middle + arc.half);
    lines.add_arc(1, 0.0, arc.disc, 0.0, whole_turn);
    return lines;
  }
};

constexpr Parameter angle_row(const char* name, const char* summary) {
  return {.name = name, .unit = "rad", .default_value = optional, .summary = summary};
}
constexpr Parameter disc_rows[] = {
    boundary_length("arc.radius", "Radius of the arc about the first frame."),
    angle_row("arc.from", "Where it begins, from the x axis of the frame; without both it is the whole circle."),
    angle_row("arc.to", "Where it ends, counter-clockwise."),
    boundary_length("disc", "Radius of the disc about the second frame.")};
constexpr auto arc_contact_parameters = joined(disc_rows, boundary_law_rows);

}  // namespace

Component arc_contact() {
  return joint<ArcContact>(
      {.name = "arc-contact",
       .space = Space::planar,
       .summary =
           "Force element: a disc touches an arc of a circle, from outside or from within, or one of its ends, by a "
           "contact law.",
       .formula =
           "C the point of the arc nearest to the middle of the disc, d from there to C, m = d/|d|: delta = disc - "
           "|d|; force on the disc -F_N m + F_T t, t = m turned by +90 deg, for delta > 0.",
       .validity = "Depths far below the radius of the disc.",
       .parameters = {arc_contact_parameters.data(), arc_contact_parameters.size()}});
}

}  // namespace freeplay
