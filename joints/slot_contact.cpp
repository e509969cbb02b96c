#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "boundary_contact.h"

namespace freeplay {
namespace {

using namespace play;

/// A round pin of radius r at b and a slot of a that is open at one end: walls y = -w and y = w for x up to the mouth,
/// a round bottom of radius w about (bottom, 0), and two edges at (mouth, -w) and (mouth, w). With g = w - r and the
/// place p = (x, y) of the pin,
///
///   in the slot    e = (min(x - bottom, 0), y)   m = e/|e|         delta = |e| - g
///   elsewhere      v = edge - p                  m = v/|v|         delta = r - |v|     with the edge on the pin's side
///
/// At the mouth both agree, with their slopes.
struct PinAtSlot {
  static constexpr std::size_t contacts = 1;
  static constexpr bool leaves = true;

  template <class T>
  ContactPlace<T> place(const PlanarMotion<T>& m, std::size_t) const {
    const double x = space::value_of(m.d.x), y = space::value_of(m.d.y), reach = play + radius;
    const bool in_slot = x <= mouth && std::hypot(std::min(x - bottom, 0.0), y) < reach;
    return in_slot ? before_walls(m.d) : before_edge(m.d, y < 0.0 ? -1.0 : 1.0);
  }
  std::array<double, 2> stand(const PlanarMotion<double>& m) const { return {m.d.x, m.d.y}; }
  static constexpr bool between_walls() { return false; }

  double radius;         ///< r [m]
  double play;           ///< g [m]
  double bottom, mouth;  ///< [m]

 private:
  template <class T>
  ContactPlace<T> before_walls(const Vec2<T>& p) const {
    const Vec2<T> e{space::value_of(p.x) < bottom ? p.x - T(bottom) : T(0.0), p.y};
    const T squared = dot(e, e);
    // In the very middle nothing touches, and no direction is better than another.
    if (!(space::value_of(squared) > 1e-24 * play * play)) {
      const Vec2<T> up{T(0.0), T(1.0)};
      return {p.y - T(play), up, T(radius) * up};
    }
    const T distance = sqrt(squared);
    const Vec2<T> normal{e.x / distance, e.y / distance};
    return {(squared - T(play * play)) / (distance + T(play)), normal, T(radius) * normal};
  }
  template <class T>
  ContactPlace<T> before_edge(const Vec2<T>& p, double side) const {
    const Vec2<T> v = Vec2<T>{T(mouth), T(side * (play + radius))} - p;
    const T squared = dot(v, v);
    if (!(space::value_of(squared) > 1e-24 * radius * radius)) {
      const Vec2<T> up{T(0.0), T(side)};
      return {T(radius), up, T(radius) * up};
    }
    const T distance = sqrt(squared);
    const Vec2<T> normal{v.x / distance, v.y / distance};
    return {(T(radius * radius) - squared) / (distance + T(radius)), normal, T(radius) * normal};
  }
};

constexpr auto mouth_channels = boundary_channels({"along", "m"}, {"across", "m"});

/// A pin that enters a slot of another body, drives it, and leaves it again, as that of a Geneva drive.
class SlotContact final : public BoundaryContact<PinAtSlot> {
 public:
  explicit SlotContact(const Parameters& p) : SlotContact(p, read(p)) {}
  void declare(JointLayout& layout) const override {
    declare_boundary(layout, {mouth_channels.data(), mouth_channels.size()}, geometry().radius);
  }

 private:
  static PinAtSlot read(const Parameters& p) {
    const double bottom = p.number("bottom");
    return {p.number("pin_radius"), p.number("gap"), bottom, bottom + p.number("length")};
  }
  SlotContact(const Parameters& p, const PinAtSlot& slot)
      : BoundaryContact(slot, boundary_laws(p, slot.play), outlines_of(slot)) {}
  static Outlines outlines_of(const PinAtSlot& slot) {
    const double half = slot.play + slot.radius;
    Outlines lines;
    lines.add_point(0, slot.mouth, half);
    lines.add_arc(0, slot.bottom, half, 0.5 * std::numbers::pi, 1.5 * std::numbers::pi);
    lines.add_point(0, slot.mouth, -half);
    lines.add_arc(1, 0.0, slot.radius, 0.0, 2.0 * std::numbers::pi);
    return lines;
  }
};

constexpr Parameter mouth_rows[] = {
    boundary_length("pin_radius", "Radius of the pin about the second frame."),
    boundary_length("gap", "Play to each side: half of the slot's width minus the pin's radius."),
    {.name = "bottom",
     .unit = "m",
     .summary = "Where the straight part of the slot begins, at a round bottom, along x of the first frame."},
    boundary_length("length", "Of the straight part, from the bottom to the mouth, where the slot is open.")};
constexpr auto slot_contact_parameters = joined(mouth_rows, boundary_law_rows);

}  // namespace

Component slot_contact() {
  return joint<SlotContact>(
      {.name = "slot-contact",
       .space = Space::planar,
       .summary =
           "Force element: a round pin touches the walls, the bottom and the edges of a slot that is open at one "
           "end, by a contact law; it may leave the slot.",
       .formula =
           "in the slot e = (x - bottom where that is negative, y), m = e/|e|, delta = |e| - gap; "
           "before its mouth m towards the nearer edge, delta = pin_radius - distance of the edge; force on the pin "
           "-F_N m + F_T t, t = m turned by +90 deg, at its surface for delta > 0.",
       .validity = "The body of the slot is its two walls and their edges: what else it has is not touched.",
       .references = "Bickford 1972, Mechanisms for Intermittent Motion, chapter 9 (Geneva drives)",
       .parameters = {slot_contact_parameters.data(), slot_contact_parameters.size()}});
}

}  // namespace freeplay
