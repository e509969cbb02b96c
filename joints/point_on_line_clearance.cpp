#include <algorithm>
#include <array>
#include <cmath>

#include "freeplay/kit/planar_slide.h"
#include "freeplay/kit/wall_play.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace play {
namespace {

constexpr SizeKeys slot_keys{"clearance.slot_width", "clearance.pin_radius", "clearance.gap", 2.0};

/// A pin of radius r at b in a slot of width 2 (r + g) along the x axis of a, with round ends about x0 and x1 or
/// without ends. One contact serves both walls and both ends: the pin's place fixes its direction.
struct PinInSlot {
  static constexpr std::size_t contacts = 1;

  template <class T>
  ContactPlace<T> place(const PlanarMotion<T>& m, std::size_t) const {
    const Vec2<T> e{beyond(m.d.x), m.d.y};
    const T squared = dot(e, e);
    // In the very middle nothing touches, and no direction is better than another.
    if (!(space::value_of(squared) > 1e-24 * play * play)) {
      const Vec2<T> up{T(0.0), T(1.0)};
      return {m.d.y - T(play), up, T(radius) * up};
    }
    const T distance = sqrt(squared);
    const Vec2<T> normal{e.x / distance, e.y / distance};
    return {(squared - T(play * play)) / (distance + T(play)), normal, T(radius) * normal};
  }
  /// How far x lies beyond the straight part.
  template <class T>
  T beyond(const T& x) const {
    if (space::value_of(x) > last) return x - T(last);
    if (space::value_of(x) < first) return x - T(first);
    return T(0.0);
  }
  std::array<double, 2> stand(const PlanarMotion<double>& m) const { return {m.d.y, beyond(m.d.x)}; }
  bool between_walls() const { return first == -unbounded && last == unbounded; }

  double radius;       ///< r, 0 where it is not known [m]
  double play;         ///< g, to each side [m]
  double first, last;  ///< x0 and x1, unbounded without ends [m]
};

constexpr Event slot_events[] = {{"contact_begin", Crossing::rising, 1, event_fields},
                                 {"contact_end", Crossing::falling, 1, event_fields}};
constexpr Channel slot_channels[] = {{"shift", "m"}, {"beyond", "m"}, {"delta", "m"},   {"fn", "N"},
                                     {"ft", "N"},    {"power", "W"},  {"contact", "1"}, {"vt", "m/s"}};
constexpr ChannelRole slot_roles[] = {ChannelRole::none,         ChannelRole::none,           ChannelRole::penetration,
                                      ChannelRole::normal_force, ChannelRole::friction_force, ChannelRole::none,
                                      ChannelRole::in_contact,   ChannelRole::slip_speed};

/// Pin with play in a slot, in the plane. No constraint rows. With d = P_b - P_a, (x, y) = (h.d, n.d) in the axes of a
///
///   e = (x - x clamped to [x0, x1], y)    m = e/|e|    delta = |e| - g    C = P_b + r m
///
/// `planar_contacts.h` has what follows from it. Skrinjar, Slavic and Boltezar 2017, Nonlinear Dyn 88, 131.
class PointOnLineClearance final : public PlanarContacts<PinInSlot> {
 public:
  explicit PointOnLineClearance(const Parameters& p) : PointOnLineClearance(p, read_sizes(p)) {}

  void declare(JointLayout& layout) const override {
    declare_contacts(layout);
    layout.coordinate = Coordinate::position;
    layout.planar_coordinate = 1;
    layout.lowest = geometry().first;
    layout.highest = geometry().last;
    layout.play_shape = PlayShape::walls;
    if (geometry().radius > 0.0) layout.smaller_radius = geometry().radius;
    layout.events = slot_events;
    layout.event_roles = begin_and_end;
    layout.channels = slot_channels;
    layout.channel_roles = slot_roles;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override { planar::Slide(in).write_along(row); }
  /// Loaded, the pin rests at the wall that carries the force across.
  void initial_offset(Span<const double> reaction, InitialOffset& out) const override {
    const Eigen::Vector2d n = across_walls(out);
    const double across = n.dot(Eigen::Vector2d(reaction[0], reaction[1]));
    const double shift = start_.loaded ? rest_at_wall(laws().normal, geometry().play, across, 0.0) : start_.shift;
    write_start(n, shift, start_.shift_rate, out);
  }

 private:
  struct Sizes {
    Radii radii;
    std::array<double, 2> ends;
  };
  // The pin's radius, of a slot whose width is halved.
  static Sizes read_sizes(const Parameters& p) {
    Sizes sizes{read_radii(p, slot_keys), {-unbounded, unbounded}};
    if (!p.given("clearance.slot")) return sizes;
    const auto slot = p.vector("clearance.slot");
    if (!(slot[0] < slot[1]))
      throw BadParameter("clearance.slot", "out-of-range", "the second end of the slot must lie beyond the first");
    sizes.ends = {slot[0], slot[1]};
    return sizes;
  }
  PointOnLineClearance(const Parameters& p, const Sizes& sizes)
      : PlanarContacts(
            {sizes.radii.known() ? sizes.radii.journal : 0.0, sizes.radii.clearance, sizes.ends[0], sizes.ends[1]},
            wall_laws(p, at_wall(SurfaceShape::cylinder, sizes.radii.clearance, sizes.radii.journal))),
        start_(p) {
    if (!sizes.radii.known() && !is_inert(laws().friction))
      throw BadParameter("clearance", "missing-key", "friction needs 'slot_width' or 'pin_radius'");
    if (sizes.radii.known() && !(sizes.radii.clearance < 2.0 * sizes.radii.journal))
      throw BadParameter("clearance.gap", "out-of-range",
                         "'gap' must be below twice 'pin_radius': the play is wider than the pin");
    // The sizes are rounded numbers: a pin at the wall is none in it.
    if (std::abs(start_.shift) > (1.0 + 1e-9) * geometry().play)
      throw BadParameter("clearance.initial.eccentricity", "out-of-range",
                         "the pin would start in the wall: it must stay within 'gap'");
  }

  WallStart start_;
};

constexpr Parameter slot_rows[] = {
    length("clearance.slot_width", "Distance of the walls of the slot on the first body."),
    length("clearance.pin_radius", "Radius of the pin on the second body."),
    length("clearance.gap", "Play to each side: half of the slot's width minus the pin's radius."),
    {.name = "clearance.slot",
     .kind = ParameterKind::vector,
     .unit = "m",
     .default_value = optional,
     .summary = "Where the straight part of the slot begins and ends along the x axis of the first frame; its ends "
                "are round. Without it the slot has no ends."},
};
constexpr auto point_on_line_clearance_parameters = joined(slot_rows, law_rows, wall_start_rows);

}  // namespace
}  // namespace play

Component point_on_line_clearance() {
  using namespace play;
  return joint<PointOnLineClearance>(
      {.name = "point-on-line-clearance",
       .space = Space::planar,
       .summary = "Pin with play in a slot, whose walls and round ends it touches by a contact law.",
       .formula =
           "(x, y) = place of the second origin in the first frame, e = (x - x clamped to the slot, y), m = e/|e|: "
           "delta = |e| - gap; force on the pin -F_N m + F_T t, t = m turned by +90 deg, at its surface for delta "
           "> 0.",
       .validity = "Gap small against the pin; rigid walls.",
       .references = "Skrinjar, Slavic and Boltezar 2017, Nonlinear Dyn 88, 131-147",
       .parameters = {point_on_line_clearance_parameters.data(), point_on_line_clearance_parameters.size()},
       .ideal = "point-on-line",
       .block = "clearance",
       .axis = MarkerAxis::x});
}

}  // namespace freeplay
