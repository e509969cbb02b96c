#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <utility>

#include "curve_check.h"
#include "freeplay/kit/planar_contacts.h"
#include "freeplay/plugin.h"
#include "no_friction.h"

namespace freeplay {
namespace {

using namespace play;
using curves::Curve;
using curves::CurveForm;

/// A point at b on one side of a curve of a. With its foot C on the curve, where the tangent t of the curve is at a
/// right angle to P - C, and the normal N there, which points upwards or away from the origin,
///
///   e = N.(P - C)      de = N.dP      dN = -sigma kappa t (t.dP)/(1 - kappa e')
///
/// with the curvature kappa, sigma = 1 for a height over x and -1 around the origin, e' = sigma e.
struct CurveSide {
  static constexpr std::size_t contacts = 1;

  struct Foot {
    double at;               ///< the variable of the curve
    double lift;             ///< e
    Eigen::Vector2d normal;  ///< N
  };

  template <class T>
  ContactPlace<T> place(const PlanarMotion<T>& m, std::size_t) const {
    const Eigen::Vector2d p(space::value_of(m.d.x), space::value_of(m.d.y));
    const Foot foot = foot_of(p);
    const Eigen::Vector2d &n = foot.normal, t(n.y(), -n.x());
    T lift(foot.lift);
    Vec2<T> normal{T(n.x()), T(n.y())};
    if constexpr (!std::is_same_v<T, double>) {
      // Zero, with the derivatives of the place.
      const T x = m.d.x - T(p.x()), y = m.d.y - T(p.y());
      lift = lift + T(n.x()) * x + T(n.y()) * y;
      const T turn = T(normal_by_tangent(foot)) * (T(t.x()) * x + T(t.y()) * y);
      normal = {T(n.x()) + turn * T(t.x()), T(n.y()) + turn * T(t.y())};
    }
    return {T(-side) * lift, T(-side) * normal, {T(0.0), T(0.0)}};
  }
  std::array<double, 2> stand(const PlanarMotion<double>& m) const {
    const Foot foot = foot_of({m.d.x, m.d.y});
    return {side * foot.lift, std::atan2(side * foot.normal.y(), side * foot.normal.x())};
  }
  static constexpr bool between_walls() { return false; }

  CurveForm form;
  Curve curve;
  double side;  ///< 1: the point is above or outside of the curve; -1: below or inside
  double play;  ///< scale of a flight [m]

 private:
  static constexpr int most_steps = 30;
  static constexpr double smallest_distance = 1e-12;  // [m]
  static constexpr double smallest_secant = 1e-9;     // by the distance from the origin: of less rounding decides

  struct At {
    Eigen::Vector2d place, rate;  ///< on the curve, and its derivative by the variable
    Curve::Line line;
  };
  At at(double s) const {
    const Curve::Line f = curve.line_at(within_turn(s));
    if (form == CurveForm::cartesian) return {{s, f.value}, {1.0, f.slope}, f};
    const Eigen::Vector2d u(std::cos(s), std::sin(s)), q(-u.y(), u.x());
    return {f.value * u, f.slope * u + f.value * q, f};
  }
  /// The second derivative of the place, at `c`.
  Eigen::Vector2d second_at(double s, const At& c) const {
    const double bend = curve.bend_at(within_turn(s));
    if (form == CurveForm::cartesian) return {0.0, bend};
    const Eigen::Vector2d u(std::cos(s), std::sin(s)), q(-u.y(), u.x());
    return (bend - c.line.value) * u + 2.0 * c.line.slope * q;
  }
  double within_turn(double s) const {
    return form == CurveForm::polar ? s - whole_turn * std::floor(s / whole_turn) : s;
  }
  double sigma() const { return form == CurveForm::polar ? -1.0 : 1.0; }

  /// Where (P - C).C' = 0, from the point of the curve below P.
  Foot foot_of(const Eigen::Vector2d& p) const {
    double s = form == CurveForm::polar ? std::atan2(p.y(), p.x()) : p.x();
    const double below = s;
    if (!find_by_slopes(p, s)) {
      s = below;
      find_by_bends(p, s);
    }
    const At c = at(s);
    const Eigen::Vector2d tangent = c.rate / std::max(c.rate.norm(), smallest_distance);
    const Eigen::Vector2d left(-tangent.y(), tangent.x());
    return {s, sigma() * left.dot(p - c.place), sigma() * left};
  }

  bool is_there(double step, const At& c) const {
    return !(std::abs(step) * c.rate.norm() > 1e-15 * (smallest_distance + c.place.norm()));
  }

  /// The secant method, as a bend takes six values of the formula; false where P is so far off that the curve bends
  /// about it, as there may be several feet.
  bool find_by_slopes(const Eigen::Vector2d& p, double& s) const {
    At c = at(s);
    double along = (p - c.place).dot(c.rate), convex = c.rate.squaredNorm();
    for (int i = 0; i < most_steps; ++i) {
      const double step = along / convex;
      if (is_there(step, c)) return true;
      s += step;
      c = at(s);
      const double before = std::exchange(along, (p - c.place).dot(c.rate));
      if (std::abs(step) * c.rate.norm() < smallest_secant * c.place.norm()) continue;
      convex = (before - along) / step;
      const double share = convex / c.rate.squaredNorm();
      if (!(share > 0.8 && share < 1.25)) return false;
    }
    return false;
  }

  /// Newton's method; where the distance is not convex the step is that along the tangent.
  void find_by_bends(const Eigen::Vector2d& p, double& s) const {
    for (int i = 0; i < most_steps; ++i) {
      const At c = at(s);
      const Eigen::Vector2d d = p - c.place;
      const double squared = c.rate.squaredNorm(), convex = squared - d.dot(second_at(s, c));
      const double step = d.dot(c.rate) / (convex > 0.1 * squared ? convex : squared);
      if (is_there(step, c)) return;
      s += step;
    }
  }

  /// dN by t.dP, along t.
  double normal_by_tangent(const Foot& foot) const {
    const At c = at(foot.at);
    const Eigen::Vector2d second = second_at(foot.at, c);
    const double size = std::max(c.rate.norm(), smallest_distance);
    const double curvature = (c.rate.x() * second.y() - c.rate.y() * second.x()) / (size * size * size);
    const double room = 1.0 - curvature * sigma() * foot.lift;
    // N = sigma left, and t of place() is N turned by -90 degrees: sigma times the tangent.
    return -sigma() * curvature / (std::abs(room) > 1e-9 ? room : 1e-9);
  }

  static constexpr double whole_turn = 2.0 * std::numbers::pi;
};

constexpr Event lift_events[] = {{"contact_begin", Crossing::rising, 1, event_fields},
                                 {"contact_end", Crossing::falling, 1, event_fields}};
constexpr Channel lift_channels[] = {{"lift", "m"}, {"normal_angle", "rad"}, {"delta", "m"},   {"fn", "N"},
                                     {"ft", "N"},   {"contact_power", "W"},  {"contact", "1"}, {"vt", "m/s"}};
constexpr ChannelRole lift_roles[] = {ChannelRole::none,         ChannelRole::none,           ChannelRole::penetration,
                                      ChannelRole::normal_force, ChannelRole::friction_force, ChannelRole::none,
                                      ChannelRole::in_contact,   ChannelRole::slip_speed};

/// A follower that may leave its cam, in the plane. No constraint rows: a contact law acts along N for delta = -e > 0.
/// It starts where the ideal joint has it, just touching.
class PointOnCurveLiftOff final : public PlanarContacts<CurveSide> {
 public:
  explicit PointOnCurveLiftOff(const Parameters& p) : PointOnCurveLiftOff(p, read_side(p)) {}

  void declare(JointLayout& layout) const override {
    declare_contacts(layout);
    layout.clearance = 0.0;  // it lets no origin move when it starts
    layout.events = lift_events;
    layout.event_roles = begin_and_end;
    layout.channels = lift_channels;
    layout.channel_roles = lift_roles;
  }

 private:
  static CurveSide read_side(const Parameters& p) {
    const auto form = static_cast<CurveForm>(p.word("form"));
    return {form, curves::checked_curve(p.formula("curve"), form), p.word("lift_off.side") == 0 ? 1.0 : -1.0,
            p.number("lift_off.reach")};
  }
  PointOnCurveLiftOff(const Parameters& p, const CurveSide& side)
      : PlanarContacts(side, {p.contact_law("lift_off.contact",
                                            {not_a_number, not_a_number, side.play, not_a_number, unknown, unknown}),
                              no_friction()}) {}

  static constexpr Material unknown{not_a_number, not_a_number};
};

constexpr Parameter lift_off_rows[] = {{.name = "lift_off.side",
                                        .kind = ParameterKind::choice,
                                        .default_value = 0,
                                        .choices = "outside|inside",
                                        .summary = "Where the point is: above the curve or outside of it, or "
                                                   "below it or inside."},
                                       {.name = "lift_off.reach",
                                        .unit = "m",
                                        .default_value = 1e-4,
                                        .minimum = 0.0,
                                        .open = Open::minimum,
                                        .summary = "How far it flies, by the order of magnitude: in flight no "
                                                   "step goes further."},
                                       {.name = "lift_off.contact",
                                        .kind = ParameterKind::contact_law,
                                        .default_value = required,
                                        .summary = "Law of the force along the normal of the curve."}};
constexpr auto lift_off_parameters = joined(curves::curve_rows, lift_off_rows);

}  // namespace

Component point_on_curve_lift_off() {
  return joint<PointOnCurveLiftOff>({.name = "point-on-curve-lift-off",
                                     .space = Space::planar,
                                     .summary = "Follower that may lift off its cam: a contact law presses "
                                                "it away from the curve, nothing pulls it.",
                                     .formula = "e = N.(P - C) with the foot C of P = P_b on the curve and the "
                                                "normal N there; force F_N N on the point "
                                                "for delta = -e > 0 (inside of the curve the other way round).",
                                     .validity = "The foot is the one nearest along the curve from the point "
                                                 "below; the roller rolls, without friction.",
                                     .references = "Norton 2009, Cam Design and Manufacturing Handbook",
                                     .parameters = {lift_off_parameters.data(), lift_off_parameters.size()},
                                     .ideal = "point-on-curve",
                                     .block = "lift_off"});
}

}  // namespace freeplay
