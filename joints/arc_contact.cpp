#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "boundary_contact.h"

namespace freeplay {
namespace {

using namespace play;

constexpr double whole_turn = 2.0 * std::numbers::pi;

/// Part of a circle about the origin of a marker, counter-clockwise between two angles from its x axis.
struct Arc {
  double radius;        ///< [m]
  double middle, half;  ///< of the angles [rad]; half a turn: the whole circle

  bool whole() const { return half >= std::numbers::pi; }
  bool holds(const Vec2<double>& direction) const {
    return whole() || std::abs(std::remainder(std::atan2(direction.y, direction.x) - middle, whole_turn)) <= half;
  }
  /// Of its two ends: in the axes of its marker.
  Vec2<double> end(int which) const {
    const double angle = which == 0 ? middle - half : middle + half;
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }
};

/// The arc of b, the outside of a disc, against that of a, the outside of a disc or the inside of a hollow. The contact
/// is at the pair of points that lie deepest in each other: of both arcs, or of an end of one and the other arc, or of
/// two ends, which never overlap. With d = P_b - P_a, radii R_a and R_b, an end C of b and an end Q of a,
///
///   arcs, outside      delta = R_a + R_b - |d|      m = -d/|d|
///   arcs, inside       delta = |d| - (R_a - R_b)    m = d/|d|
///   end of b           delta = R_a - |C|, inside |C| - R_a,   m = -C/|C|, inside C/|C|
///   end of a           delta = R_b - |Q - d|        m = (Q - d)/|Q - d|
///   two ends           delta = -|Q - C|
///
/// so that delta is continuous wherever the pair changes. Both forces act halfway between the two surfaces.
struct TwoArcs {
  static constexpr std::size_t contacts = 1;
  static constexpr bool leaves = true;

  template <class T>
  ContactPlace<T> place(const PlanarMotion<T>& m, std::size_t) const {
    return place_of(deepest(numbers_of(m)), m);
  }
  std::array<double, 2> stand(const PlanarMotion<double>& m) const {
    return {std::sqrt(dot(m.d, m.d)), std::atan2(m.d.y, m.d.x)};
  }
  static constexpr bool between_walls() { return false; }

  Arc first, second;
  bool inside;
  double play;  ///< scale of a flight [m]

 private:
  /// -1: the arc, else one of its ends.
  struct Points {
    int a, b;
  };

  template <class T>
  static PlanarMotion<double> numbers_of(const PlanarMotion<T>& m) {
    using space::value_of;
    return {{value_of(m.d.x), value_of(m.d.y)}, value_of(m.c), value_of(m.s), {}, 0.0, 0.0};
  }
  Points deepest(const PlanarMotion<double>& m) const {
    Points best{-1, -1};
    if (meet(best, m)) return best;
    double depth = -unbounded;
    for (int a = -1; a < 2; ++a) {
      for (int b = -1; b < 2; ++b) {
        if ((a < 0 && b < 0) || (a >= 0 && first.whole()) || (b >= 0 && second.whole()) || !meet({a, b}, m)) continue;
        const double own = place_of(Points{a, b}, m).penetration;
        if (own > depth) {
          depth = own;
          best = {a, b};
        }
      }
    }
    return best;
  }
  /// Whether the points where these would touch belong to the arcs. A hollow holds only what is about its own middle.
  bool meet(const Points& points, const PlanarMotion<double>& m) const {
    if (points.a >= 0 && points.b >= 0) return true;
    const Vec2<double> place = points.b < 0 ? m.d : m.d + turned_by(m, second.end(points.b));
    if (points.a < 0) {
      if (inside && dot(m.d, m.d) >= first.radius * first.radius) return false;
      if (!first.holds(place)) return false;
    }
    if (points.b >= 0) return true;
    const Vec2<double> from_b = points.a >= 0 ? first.end(points.a) - m.d : inside ? m.d : Vec2<double>{} - m.d;
    return second.holds({m.c * from_b.x + m.s * from_b.y, m.c * from_b.y - m.s * from_b.x});
  }

  /// A vector that is fixed in b, in the axes of a.
  template <class T>
  static Vec2<T> turned_by(const PlanarMotion<T>& m, const Vec2<double>& q) {
    return {T(q.x) * m.c - T(q.y) * m.s, T(q.x) * m.s + T(q.y) * m.c};
  }
  template <class T>
  ContactPlace<T> place_of(const Points& points, const PlanarMotion<T>& m) const {
    if (points.a < 0) {
      const double side = inside ? 1.0 : -1.0;
      if (points.b < 0) {
        auto at = between(m.d, side, inside ? first.radius - second.radius : first.radius + second.radius);
        at.arm = (T(second.radius) - T(0.5) * at.penetration) * at.normal;
        return at;
      }
      const Vec2<T> arm = turned_by(m, second.end(points.b));
      auto at = between(m.d + arm, side, first.radius);
      at.arm = arm - T(0.5) * at.penetration * at.normal;
      return at;
    }
    const Vec2<double> end = first.end(points.a);
    const Vec2<T> to_end = Vec2<T>{T(end.x), T(end.y)} - m.d;
    if (points.b < 0) {
      auto at = between(to_end, -1.0, second.radius);
      at.normal = Vec2<T>{} - at.normal;
      at.arm = (T(second.radius) - T(0.5) * at.penetration) * at.normal;
      return at;
    }
    const Vec2<T> arm = turned_by(m, second.end(points.b));
    auto at = between(to_end - arm, -1.0, 0.0);
    at.normal = Vec2<T>{} - at.normal;
    at.arm = arm;
    return at;
  }
  /// delta = side (|v| - size) and side v/|v|, without the loss of digits near zero.
  template <class T>
  static ContactPlace<T> between(const Vec2<T>& v, double side, double size) {
    const T squared = dot(v, v);
    if (!(space::value_of(squared) > 1e-30)) return {T(-side * size), {T(side), T(0.0)}, {}};
    const T distance = sqrt(squared);
    return {T(side) * (squared - T(size * size)) / (distance + T(size)),
            {T(side) * v.x / distance, T(side) * v.y / distance},
            {}};
  }
};

constexpr auto channels = boundary_channels({"distance", "m"}, {"direction", "rad"});

class ArcContact final : public BoundaryContact<TwoArcs> {
 public:
  explicit ArcContact(const Parameters& p) : ArcContact(p, read(p)) {}
  void declare(JointLayout& layout) const override {
    declare_boundary(layout, {channels.data(), channels.size()},
                     std::min(geometry().first.radius, geometry().second.radius));
  }

 private:
  static Arc read_arc(const Parameters& p, const char* radius, const char* from, const char* to) {
    if (p.given(from) != p.given(to))
      throw BadParameter(p.given(from) ? from : to, "missing-key",
                         "an arc needs both 'from' and 'to'; without them it is the whole circle");
    if (!p.given(from)) return {p.number(radius), 0.0, std::numbers::pi};
    const double begin = p.number(from), end = p.number(to);
    if (!(begin < end && end - begin <= whole_turn))
      throw BadParameter(to, "out-of-range",
                         "an arc goes counter-clockwise: 'to' must be above 'from' by one turn at most");
    return {p.number(radius), 0.5 * (begin + end), 0.5 * (end - begin)};
  }
  static TwoArcs read(const Parameters& p) {
    TwoArcs arcs{read_arc(p, "first.radius", "first.from", "first.to"),
                 read_arc(p, "second.radius", "second.from", "second.to"), p.word("side") == 1, 0.0};
    const double a = arcs.first.radius, b = arcs.second.radius;
    if (arcs.inside && !(b < a))
      throw BadParameter("second.radius", "out-of-range",
                         "a disc in a hollow must be smaller than the hollow, 'first.radius'");
    arcs.play = arcs.inside ? a - b : 1e-3 * std::min(a, b);
    return arcs;
  }
  ArcContact(const Parameters& p, const TwoArcs& arcs)
      : BoundaryContact(arcs, boundary_laws(p, arcs.play), outlines_of(arcs)) {}
  static Outlines outlines_of(const TwoArcs& arcs) {
    Outlines lines;
    std::size_t body = 0;
    for (const Arc& arc : {arcs.first, arcs.second})
      lines.add_arc(body++, 0.0, arc.radius, arc.middle - arc.half, arc.middle + arc.half);
    return lines;
  }
};

constexpr Parameter angle_row(const char* name, const char* summary) {
  return {.name = name, .unit = "rad", .default_value = optional, .summary = summary};
}
constexpr Parameter own_rows[] = {
    boundary_length("first.radius", "Radius of the arc about the first frame."),
    angle_row("first.from", "Where it begins, from the x axis of the frame; without both it is the whole circle."),
    angle_row("first.to", "Where it ends, counter-clockwise."),
    boundary_length("second.radius", "Radius of the arc about the second frame."),
    angle_row("second.from", "Where it begins, from the x axis of the frame; without both it is the whole circle."),
    angle_row("second.to", "Where it ends, counter-clockwise."),
    {.name = "side",
     .kind = ParameterKind::choice,
     .default_value = 0,
     .choices = "outside|inside",
     .summary = "The second arc touches the first one from outside, or lies in a hollow."}};
constexpr auto arc_contact_parameters = joined(own_rows, boundary_law_rows);

}  // namespace

Component arc_contact() {
  return joint<ArcContact>(
      {.name = "arc-contact",
       .space = Space::planar,
       .summary =
           "Force element: two arcs of circles, or whole discs, one outside of the other or in a hollow, touch by a "
           "contact law; their ends are sharp.",
       .formula =
           "m from the second body into the first at the points that lie deepest in each other: discs delta = R_a + "
           "R_b "
           "- |d|, m = -d/|d|; in a hollow delta = |d| - (R_a - R_b), m = d/|d|; an end C delta = R - |C|; force on "
           "the second body -F_N m + F_T t, t = m turned by +90 deg, for delta > 0.",
       .validity =
           "The second arc is the outside of a disc. A hollow is left where the middle of the disc leaves its circle.",
       .parameters = {arc_contact_parameters.data(), arc_contact_parameters.size()}});
}

}  // namespace freeplay
