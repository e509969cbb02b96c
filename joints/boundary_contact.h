// Force elements of one contact between parts of two boundaries in the plane: what they have beside their geometry.
#pragma once

#include <array>
#include <cmath>
#include <utility>
#include <vector>

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

/// Lines of both boundaries for pictures.
class Outlines {
 public:
  void add_point(std::size_t body, double x, double y) {
    points_[body].push_back(x);
    points_[body].push_back(y);
  }
  /// About (x, 0), from one angle to another.
  void add_arc(std::size_t body, double x, double radius, double from, double to) {
    constexpr int parts = 48;
    for (int i = 0; i <= parts; ++i) {
      const double angle = from + (to - from) * i / parts;
      add_point(body, x + radius * std::cos(angle), radius * std::sin(angle));
    }
  }
  Span<const BodyLine> lines() {
    for (std::size_t body = 0; body < 2; ++body)
      lines_[body] = {static_cast<std::uint32_t>(body), {points_[body].data(), points_[body].size()}};
    return {lines_.data(), lines_.size()};
  }

 private:
  std::array<std::vector<double>, 2> points_;
  std::array<BodyLine, 2> lines_{};
};

/// One contact that holds nothing together: no constraint rows, no ideal joint that stands in for it.
template <class Geometry>
class BoundaryContact : public PlanarContacts<Geometry> {
 public:
  BoundaryContact(const Geometry& geometry, const PlanarLaws& laws, Outlines outlines)
      : PlanarContacts<Geometry>(geometry, laws), outlines_(std::move(outlines)), lines_(outlines_.lines()) {}

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
    layout.outlines = lines_;
  }

 private:
  Outlines outlines_;
  Span<const BodyLine> lines_;
};

}  // namespace freeplay::play
