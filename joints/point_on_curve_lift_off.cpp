#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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
    double lift;               ///< e
    Eigen::Vector2d normal;    ///< N
    double normal_by_tangent;  ///< dN by t.dP, along t
  };

  template <class T>
  ContactPlace<T> place(const PlanarMotion<T>& m, std::size_t) const {
    const Eigen::Vector2d p(space::value_of(m.d.x), space::value_of(m.d.y));
    const Foot foot = foot_of(p);
    const Eigen::Vector2d &n = foot.normal, t(n.y(), -n.x());
    // Zero, with the derivatives of the place.
    const T x = m.d.x - T(p.x()), y = m.d.y - T(p.y());
    const T lift = T(foot.lift) + T(n.x()) * x + T(n.y()) * y;
    const T turn = T(foot.normal_by_tangent) * (T(t.x()) * x + T(t.y()) * y);
    const Vec2<T> normal{T(n.x()) + turn * T(t.x()), T(n.y()) + turn * T(t.y())};
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

  /// The place on the curve and its derivatives by the variable of the curve.
  struct At {
    Eigen::Vector2d place, rate, second;
  };
  At at(double s) const {
    const Curve::At f = curve.at(form == CurveForm::polar ? s - whole_turn * std::floor(s / whole_turn) : s);
    if (form == CurveForm::cartesian) return {{s, f.value}, {1.0, f.slope}, {0.0, f.bend}};
    const Eigen::Vector2d u(std::cos(s), std::sin(s)), q(-u.y(), u.x());
    return {f.value * u, f.slope * u + f.value * q, (f.bend - f.value) * u + 2.0 * f.slope * q};
  }

  /// Newton's method for (P - C).C' = 0 from the point of the curve below P; where the distance is not convex the step
  /// is that along the tangent.
  Foot foot_of(const Eigen::Vector2d& p) const {
    double s = form == CurveForm::polar ? std::atan2(p.y(), p.x()) : p.x();
    At c = at(s);
    for (int i = 0; i < most_steps; ++i) {
      const Eigen::Vector2d d = p - c.place;
      const double squared = c.rate.squaredNorm(), along = d.dot(c.rate), convex = squared - d.dot(c.second);
      const double step = along / (convex > 0.1 * squared ? convex : squared);
      if (!(std::abs(step) * std::sqrt(squared) > 1e-15 * (smallest_distance + c.place.norm()))) break;
      s += step;
      c = at(s);
    }
    const double size = std::max(c.rate.norm(), smallest_distance), sigma = form == CurveForm::polar ? -1.0 : 1.0;
    const Eigen::Vector2d tangent = c.rate / size, left(-tangent.y(), tangent.x());
    const double curvature = (c.rate.x() * c.second.y() - c.rate.y() * c.second.x()) / (size * size * size);
    const double off = left.dot(p - c.place), room = 1.0 - curvature * off;
    // N = sigma left, and t of place() is N turned by -90 degrees: sigma times the tangent.
    const double by_tangent = -sigma * curvature / (std::abs(room) > 1e-9 ? room : 1e-9);
    return {sigma * off, sigma * left, by_tangent};
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
