// Force elements of one contact between parts of two boundaries in the plane: what they have beside their geometry.
#pragma once

#include <array>

#include "freeplay/kit/planar_contacts.h"
#include "freeplay/kit/play_parameters.h"
#include "freeplay/plugin.h"

namespace freeplay::play {

inline constexpr Event boundary_events[] = {{"contact_begin", Crossing::rising, 1, event_fields},
                                            {"contact_end", Crossing::falling, 1, event_fields}};
inline constexpr ChannelRole boundary_roles[] = {
    ChannelRole::none,           ChannelRole::none, ChannelRole::penetration, ChannelRole::normal_force,
    ChannelRole::friction_force, ChannelRole::none, ChannelRole::in_contact,  ChannelRole::slip_speed};
/// Two numbers that say where b stands, then those of every such contact.
constexpr std::array<Channel, 8> boundary_channels(const Channel& first, const Channel& second) {
  return {{first,
           second,
           {"delta", "m"},
           {"fn", "N"},
           {"ft", "N"},
           {"contact_power", "W"},
           {"contact", "1"},
           {"vt", "m/s"}}};
}

/// The laws `contact` and `friction`. Nothing is known from which a law could compute its stiffness. Throws
/// BadParameter.
inline PlanarLaws boundary_laws(const Parameters& p, double play) {
  constexpr Material unknown{not_a_number, not_a_number};
  return {p.contact_law("contact", {not_a_number, not_a_number, play, not_a_number, unknown, unknown}),
          p.friction_law("friction")};
}

constexpr Parameter boundary_length(const char* name, const char* summary) {
  return {.name = name, .unit = "m", .minimum = 0.0, .open = Open::minimum, .summary = summary};
}
inline constexpr Parameter boundary_law_rows[] = {{.name = "contact",
                                                   .kind = ParameterKind::contact_law,
                                                   .default_value = required,
                                                   .summary = "Law of the normal force."},
                                                  {.name = "friction",
                                                   .kind = ParameterKind::friction_law,
                                                   .default_value = optional,
                                                   .summary = "Law of the tangential force."}};

/// One contact that holds nothing together: no constraint rows, no ideal joint that stands in for it.
template <class Geometry>
class BoundaryContact : public PlanarContacts<Geometry> {
 public:
  using PlanarContacts<Geometry>::PlanarContacts;

 protected:
  /// `radius`: the smaller one at the contact [m].
  void declare_boundary(JointLayout& layout, Span<const Channel> channels, double radius) const {
    this->declare_contacts(layout);
    layout.clearance = 0.0;
    layout.smaller_radius = radius;
    layout.events = boundary_events;
    layout.event_roles = begin_and_end;
    layout.channels = channels;
    layout.channel_roles = boundary_roles;
  }
};

}  // namespace freeplay::play
