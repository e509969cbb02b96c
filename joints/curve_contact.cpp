#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <type_traits>
#include <utility>

#include "boundary_contact.h"
#include "curve_pair.h"

namespace freeplay {
namespace {

using namespace play;
using curves::ClosedCurve;
using curves::CurvePair;
using curves::Touch;

/// Two closed curves about a and b that touch from outside. With the nearest points C_a and C_b, the normal n out of
/// the first, the tangent t = n turned by +90 degrees, e = n.(C_b - C_a) and q from P_b to C_b, and the curvatures k_a,
/// k_b,
///
///   delta = -e    de = n.(dP_b + q~ dtheta)    q~ = q turned by +90 degrees, all in the axes of a
///   dalpha = (k_a k_b X + k_a dtheta)/D        of n = (cos alpha, sin alpha), X = t.(dP_b + q~ dtheta)
///   dq = q~ dtheta - t (k_a X - (1 + k_a e) dtheta)/D        D = k_a + k_b + k_a k_b e
struct CurveOnCurve {
  static constexpr std::size_t contacts = 1;
  static constexpr bool leaves = true;

  template <class T>
  ContactPlace<T> place(const PlanarMotion<T>& m, std::size_t) const {
    const Vec2<double> d{space::value_of(m.d.x), space::value_of(m.d.y)};
    const double c = space::value_of(m.c), s = space::value_of(m.s);
    const Touch touch = pair->touch(d, c, s);
    if constexpr (std::is_same_v<T, double>) {
      return at(touch.gap, touch.normal, touch.on_second);
    } else {
      // Zero, with the derivatives of the place.
      return moved(touch, {m.d.x - T(d.x), m.d.y - T(d.y)}, T(c) * m.s - T(s) * m.c);
    }
  }
  /// Angles on both curves at which they touch or are nearest.
  std::array<double, 2> stand(const PlanarMotion<double>& m) const {
    const Touch touch = pair->touch(m.d, m.c, m.s);
    const Vec2<double> second = in_second(m, touch.on_second);
    return {std::atan2(touch.on_first.y, touch.on_first.x), std::atan2(second.y, second.x)};
  }
  static Vec2<double> in_second(const PlanarMotion<double>& m, const Vec2<double>& v) {
    return {m.c * v.x + m.s * v.y, m.c * v.y - m.s * v.x};
  }
  static constexpr bool between_walls() { return false; }

  std::shared_ptr<const CurvePair> pair;
  double play;  ///< scale of a flight [m]

 private:
  template <class T>
  static ContactPlace<T> moved(const Touch& touch, const Vec2<T>& by, const T& turn) {
    const Vec2<double>&n = touch.normal, t = turned(n), &q = touch.on_second, across = turned(q);
    const auto [first, second] = touch.curvature;
    const double sum = first + second + first * second * touch.gap;
    const double per_sum = 1.0 / std::max(sum, 1e-9 * (std::abs(first) + std::abs(second)));
    const auto along = [&](const Vec2<double>& v) { return T(v.x) * by.x + T(v.y) * by.y + T(dot(v, across)) * turn; };
    const T slide = along(t);
    const T swing = T(per_sum * first) * (T(second) * slide + turn),
            roll = T(per_sum) * (T(first) * slide - T(1.0 + first * touch.gap) * turn);
    const auto sum_of = [](const Vec2<double>& v, const T& x, const Vec2<double>& w, const T& y,
                           const Vec2<double>& u) {
      return Vec2<T>{T(v.x) + x * T(w.x) + y * T(u.x), T(v.y) + x * T(w.y) + y * T(u.y)};
    };
    return at(T(touch.gap) + along(n), sum_of(n, swing, t, T(0.0), t), sum_of(q, turn, across, -roll, t));
  }
  /// Both forces act halfway between the two curves.
  template <class T>
  static ContactPlace<T> at(const T& gap, const Vec2<T>& normal, const Vec2<T>& on_second) {
    return {-gap, T(-1.0) * normal, on_second - T(0.5) * gap * normal};
  }
};

constexpr auto curve_channels = boundary_channels({"first_angle", "rad"}, {"second_angle", "rad"});

class CurveContact final : public BoundaryContact<CurveOnCurve> {
 public:
  explicit CurveContact(const Parameters& p) : CurveContact(p, read(p)) {}
  void declare(JointLayout& layout) const override {
    declare_boundary(layout, {curve_channels.data(), curve_channels.size()}, geometry().pair->least_radius());
    layout.kinks += curve(0).switches() + curve(1).switches();
  }
  /// Apart, beside the first curve along its x axis.
  bool place(double, Pose& b_in_a) const override {
    b_in_a = {{beside_, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
    return true;
  }
  /// Those of the laws, and where a formula changes its form under the contact.
  void kinks(const JointInput& in, Span<double> g) const override {
    const auto first = static_cast<std::size_t>(curve(0).switches()),
               second = static_cast<std::size_t>(curve(1).switches()), own = g.size - first - second;
    if (own > 0) BoundaryContact::kinks(in, g.part(0, own));
    if (first + second == 0 || in.history[phase] == flight) return;
    const PlanarPair motion(in);
    const PlanarMotion<double>& m = motion.numbers();
    const Touch touch = geometry().pair->touch(m.d, m.c, m.s);
    curve(0).decide(touch.on_first, g.part(own, first));
    curve(1).decide(CurveOnCurve::in_second(m, touch.on_second), g.part(own + first, second));
  }

 private:
  static CurveOnCurve read(const Parameters& p) {
    const auto curve_of = [&](std::size_t which) {
      const char* key = CurvePair::keys[which];
      return ClosedCurve(p.formula(key), key);
    };
    auto pair = std::make_shared<const CurvePair>(curve_of(0), curve_of(1));
    const double size = std::min(pair->curve(0).size(), pair->curve(1).size());
    return {std::move(pair), 1e-3 * size};
  }
  CurveContact(const Parameters& p, const CurveOnCurve& curves)
      : BoundaryContact(curves, boundary_laws(p, curves.play), outlines_of(*curves.pair)),
        beside_(distance_beside(*curves.pair)) {}
  const ClosedCurve& curve(std::size_t which) const { return geometry().pair->curve(which); }

  static Outlines outlines_of(const CurvePair& pair) {
    constexpr std::size_t parts = 48;
    Outlines lines;
    for (std::size_t body = 0; body < 2; ++body) {
      for (const double angle : pair.curve(body).stations(parts)) add(pair.curve(body), angle, body, lines);
      add(pair.curve(body), 0.0, body, lines);
    }
    return lines;
  }
  static void add(const ClosedCurve& curve, double angle, std::size_t body, Outlines& lines) {
    const Vec2<double> place = curve.at(angle).place;
    lines.add_point(body, place.x, place.y);
  }
  /// Where the curves, not turned, are twice as far apart as the smaller one is wide.
  static double distance_beside(const CurvePair& pair) {
    const double gap = 4.0 * std::min(pair.curve(0).size(), pair.curve(1).size());
    double low = 0.0, high = gap;
    while (pair.touch({high, 0.0}, 1.0, 0.0).gap < gap) high *= 2.0;
    for (int i = 0; i < 50; ++i) {
      const double between = 0.5 * (low + high);
      (pair.touch({between, 0.0}, 1.0, 0.0).gap < gap ? low : high) = between;
    }
    return high;
  }

  double beside_;  // [m]
};

constexpr Parameter curve_row(const char* name, const char* summary) {
  return {.name = name, .kind = ParameterKind::formula, .unit = "m", .summary = summary, .variables = "x: rad"};
}
constexpr Parameter pair_rows[] = {
    curve_row("first",
              "Closed curve of the first body: distance from its frame at the angle x from 0 to one turn; "
              "points or arcs as well."),
    curve_row("second", "Closed curve of the second body, about its frame.")};
constexpr auto curve_contact_parameters = joined(pair_rows, boundary_law_rows);

}  // namespace

Component curve_contact() {
  return joint<CurveContact>(
      {.name = "curve-contact",
       .space = Space::planar,
       .summary = "Force element: two closed curves, as of cams and rollers that are not round, touch from outside, by "
                  "a contact law.",
       .formula = "C_a, C_b the nearest points, or those that come apart first, n the normal out of the first curve: "
                  "delta = -n.(C_b - C_a); force on b F_N n + F_T t halfway between both, t = -n turned by +90 deg, "
                  "for delta > 0.",
       .validity = "One curve is round everywhere, and each hollow of the other wider than its flattest part, so that "
                   "they touch in one place; depths far below the radii of curvature there.",
       .references = "Litvin and Fuentes 2004, Gear Geometry and Applied Theory",
       .parameters = {curve_contact_parameters.data(), curve_contact_parameters.size()}});
}

}  // namespace freeplay
