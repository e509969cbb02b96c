#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "freeplay/kit/planar_contacts.h"
#include "freeplay/plugin.h"
#include "no_friction.h"

namespace freeplay {
namespace play {
namespace {

/// Two toothed wheels, marker a in the middle of the first and marker b in that of the second, whose teeth have play:
/// the two flanks of a tooth of b. It is ahead of where the ideal gear holds it, and touches one, or behind, the other.
struct Flanks {
  static constexpr std::size_t contacts = 2, kept = 3;
  enum Kept : std::size_t { middle, line, turn };  // phi_0, last beta, last gamma [rad]
  static double side(std::size_t i) { return i == 0 ? 1.0 : -1.0; }

  template <class T>
  ContactPlace<T> place(const PlanarMotion<T>& m, std::size_t i) const {
    const T distance = sqrt(dot(m.d, m.d));
    const Vec2<T> along{m.d.x / distance, m.d.y / distance};
    const T ahead = T(side(i) * radius) * shifted_angle(m), wider = distance - T(nominal);
    const T share = T(-side(i) * turning * cosine * nominal) / distance;
    return {T(cosine) * (ahead - T(play)) - T(parting * sine) * wider,
            share * turned(along) - T(parting * sine) * along, T(-1.0 / whole) * m.d};
  }
  /// phi - phi_0, from angles that were counted over turns.
  template <class T>
  T shifted_angle(const PlanarMotion<T>& m) const {
    return counted(atan2(m.s, m.c), last_turn) - T(whole) * counted(atan2(m.d.y, m.d.x), last_line) - T(start);
  }
  /// The turn of an angle that is nearest to the last one.
  template <class T>
  static T counted(const T& angle, double last) {
    constexpr double revolution = 2.0 * std::numbers::pi;
    return angle + T(revolution * std::round((last - space::value_of(angle)) / revolution));
  }

  std::array<double, 2> stand(const PlanarMotion<double>& m) const {
    const double angle = shifted_angle(m);
    return {radius * angle, angle};
  }
  static constexpr bool between_walls() { return false; }

  void keep_first(const PlanarMotion<double>& m, Span<double> own) const {
    own[line] = std::atan2(m.d.y, m.d.x);
    own[turn] = std::atan2(m.s, m.c);
    own[middle] = std::isnan(start) ? own[turn] - whole * own[line] : start;
  }
  void keep(const PlanarMotion<double>& m, Span<double> own) const {
    own[line] = counted(std::atan2(m.d.y, m.d.x), own[line]);
    own[turn] = counted(std::atan2(m.s, m.c), own[turn]);
  }
  Flanks with(Span<const double> own) const {
    Flanks here = *this;
    here.start = own[middle];
    here.last_line = own[line];
    here.last_turn = own[turn];
    return here;
  }

  double radius;        ///< R, pitch radius of the second wheel [m]
  double play;          ///< g, to each side at the pitch circle [m]
  double whole;         ///< k = 1 - ratio
  double nominal;       ///< D_0, distance of the axes where the pitch circles touch [m]
  double cosine, sine;  ///< of the pressure angle
  double turning;       ///< sign of k
  double parting;       ///< 1 where teeth leave each other as the axes part; -1: inside of a ring
  double start;         ///< phi_0; NaN: where the wheels stand at the start [rad]
  double last_line = 0.0, last_turn = 0.0;
};

constexpr const char* flank_events[] = {"ahead_contact_begin", "ahead_contact_end", "behind_contact_begin",
                                        "behind_contact_end"};
constexpr auto all_flank_events = contact_events(flank_events);
constexpr auto all_flank_roles = contact_event_roles<all_flank_events.size()>();

constexpr Channel flank_channels[] = {
    {"shift", "m"},      {"turn", "rad"},       {"delta", "m"},     {"fn", "N"},          {"ft", "N"},
    {"mesh_power", "W"}, {"contact", "1"},      {"vt", "m/s"},      {"ahead_delta", "m"}, {"ahead_fn", "N"},
    {"ahead_ft", "N"},   {"behind_delta", "m"}, {"behind_fn", "N"}, {"behind_ft", "N"}};
constexpr ChannelRole flank_roles[] = {
    ChannelRole::none,           ChannelRole::none, ChannelRole::penetration, ChannelRole::normal_force,
    ChannelRole::friction_force, ChannelRole::none, ChannelRole::in_contact,  ChannelRole::slip_speed,
    ChannelRole::none,           ChannelRole::none, ChannelRole::none,        ChannelRole::none,
    ChannelRole::none,           ChannelRole::none};

/// Gear with backlash, in the plane. No constraint rows. With d = P_b - P_a, D = |d|, its direction m at the angle beta
/// and t = m turned by +90 degrees, the angle gamma of b, both in the axes of a, and w_b = ratio w_a where the line of
/// centres rests:
///
///   phi = gamma - k beta,   k = 1 - ratio      constant where the teeth roll without play, whatever turns the axes
///   D_0 = R abs(k)                             distance of the axes where the pitch circles touch
///   delta_i = cos(alpha) (sigma R (phi - phi_0) - g) - e sin(alpha) (D - D_0)
///
/// with sigma = 1 for the flank that b meets when it is ahead and -1 for the other, e = 1 for wheels side by side
/// (ratio < 0) and -1 for one inside of the other. Its derivative by P_b is
///
///   n = -sigma sign(k) cos(alpha) D_0/D t - e sin(alpha) m,   and F_b = -F_N n acts at C = P_b - d/k
///
/// the pitch point, so that power is -F_N delta' without remainder: delta' = n.(velocity of b less that of a at C). At
/// D = D_0 n is a unit vector, the line of action. Where the axes may move, as in loose bearings, the play grows by 2
/// (D - D_0) tan(alpha) as it does for involute teeth; that the contact ratio changes the stiffness along the mesh is
/// left out, and so is the sliding of flanks off the pitch point. phi_0 is what the assembled start has, or `middle`:
/// the tooth begins in the middle of its gap. Angles are counted over turns in `history`. Litvin and Fuentes 2004, Gear
/// Geometry and Applied Theory; ISO 21771.
class GearClearance final : public PlanarContacts<Flanks> {
 public:
  explicit GearClearance(const Parameters& p) : GearClearance(p, read_flanks(p)) {}

  void declare(JointLayout& layout) const override {
    declare_contacts(layout);
    layout.clearance = 0.0;  // it lets no origin move
    layout.events = {all_flank_events.data(), all_flank_events.size()};
    layout.event_roles = {all_flank_roles.data(), all_flank_roles.size()};
    layout.channels = flank_channels;
    layout.channel_roles = flank_roles;
  }
  bool place(double, Pose& b_in_a) const override {
    b_in_a = planar::pose(geometry().nominal, 0.0);
    return true;
  }

 private:
  static Flanks read_flanks(const Parameters& p) {
    const double radius = p.number("clearance.pitch_radius"), first = p.number("clearance.first_radius"),
                 angle = p.number("pressure_angle"), backlash = p.number("clearance.backlash");
    double gap = p.number("clearance.gap");
    if (std::isnan(gap) == std::isnan(backlash)) {
      throw BadParameter("clearance", std::isnan(gap) ? "missing-key" : "conflicting-keys",
                         "give 'gap', the play to each side at the pitch circle, or 'backlash', the whole angle by "
                         "which the second wheel turns while the first stands");
    }
    if (std::isnan(gap)) gap = 0.5 * backlash * radius;
    if (!(gap < radius)) {
      throw BadParameter(p.given("clearance.gap") ? "clearance.gap" : "clearance.backlash", "out-of-range",
                         "the play at the pitch circle must be below 'pitch_radius'");
    }
    if (std::isnan(first)) throw BadParameter("clearance", "missing-key", "give 'first_radius'");
    const double whole = 1.0 + first / radius;
    if (first == 0.0 || whole == 0.0) {
      throw BadParameter("clearance.first_radius", "out-of-range",
                         "teeth need two wheels of different size or sense: the radii must not be the same");
    }
    return {radius,
            gap,
            whole,
            radius * std::abs(whole),
            std::cos(angle),
            std::sin(angle),
            whole > 0.0 ? 1.0 : -1.0,
            first > 0.0 ? 1.0 : -1.0,
            p.number("clearance.middle")};
  }
  GearClearance(const Parameters& p, const Flanks& flanks)
      : PlanarContacts(flanks, {p.contact_law("clearance.contact", {not_a_number, not_a_number, flanks.play,
                                                                    not_a_number, unknown, unknown}),
                                no_friction()}) {}

  static constexpr Material unknown{not_a_number, not_a_number};
};

constexpr Parameter gear_clearance_parameters[] = {
    {.name = "pressure_angle",
     .unit = "rad",
     .default_value = std::numbers::pi / 9.0,
     .minimum = 0.0,
     .maximum = std::numbers::pi / 4.0,
     .summary = "Of the line of action against the common tangent of the pitch circles."},
    {.name = "clearance.pitch_radius",
     .unit = "m",
     .default_value = required,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Pitch radius of the second wheel."},
    {.name = "clearance.first_radius",
     .unit = "m",
     .default_value = optional,
     .summary = "Pitch radius of the first wheel, negative where one turns inside of the other: -ratio pitch_radius."},
    {.name = "clearance.middle",
     .unit = "rad",
     .default_value = 0.0,
     .summary = "Where a tooth is in the middle of its gap: phi_0 of the formula. A gear takes that of its start."},
    length("clearance.gap", "Play of a tooth to each side, along the pitch circle."),
    {.name = "clearance.backlash",
     .unit = "rad",
     .default_value = optional,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Instead of `gap`: angle by which the second wheel can turn, from flank to flank, while the first "
                "stands."},
    {.name = "clearance.contact",
     .kind = ParameterKind::contact_law,
     .default_value = required,
     .summary = "Law of the force along the line of action."},
};

}  // namespace
}  // namespace play

Component gear_clearance() {
  using namespace play;
  return joint<GearClearance>(
      {.name = "gear-clearance",
       .space = Space::planar,
       .summary = "Gear with backlash: a tooth of the second wheel touches either flank by a contact law, at the pitch "
                  "point.",
       .formula =
           "phi = gamma - (1 - ratio) beta with the angle gamma of the second wheel and beta of the line of centres, "
           "both against the first wheel: delta = cos(alpha) (+-R (phi - phi_0) - gap) -+ sin(alpha) (D - D_0); force "
           "along the line of action at the pitch point for delta > 0, on either flank.",
       .validity = "Two revolute joints on one body hold the wheels; play small against the tooth.",
       .references = "Litvin and Fuentes 2004, Gear Geometry and Applied Theory; ISO 21771",
       .parameters = gear_clearance_parameters,
       .ideal = "gear",
       .block = "clearance"});
}

}  // namespace freeplay
