// JointRoles: what the channels and events of a joint mean, as declared or, where nothing is, by their names; and how
// its play lies.
#pragma once

#include <cstddef>
#include <string_view>

#include "freeplay/joint.h"

namespace freeplay {

inline ChannelRole channel_role(const JointLayout& layout, std::size_t channel) {
  if (!layout.channel_roles.empty()) return layout.channel_roles[channel];
  struct Named {
    std::string_view name;
    ChannelRole role;
  };
  constexpr Named names[] = {{"ex", ChannelRole::eccentricity_x}, {"ey", ChannelRole::eccentricity_y},
                             {"ez", ChannelRole::eccentricity_z}, {"delta", ChannelRole::penetration},
                             {"fn", ChannelRole::normal_force},   {"ft", ChannelRole::friction_force},
                             {"vt", ChannelRole::slip_speed},     {"contact", ChannelRole::in_contact}};
  for (const Named& named : names) {
    if (layout.channels[channel].name == named.name) return named.role;
  }
  return ChannelRole::none;
}

inline EventRole event_role(const JointLayout& layout, std::size_t event) {
  if (!layout.event_roles.empty()) return layout.event_roles[event];
  const std::string_view name = layout.events[event].name;
  if (name.ends_with("contact_begin")) return EventRole::contact_begin;
  return name.ends_with("contact_end") ? EventRole::contact_end : EventRole::none;
}

/// Whether the play of a joint lies between walls along its x axis; else it is round.
inline bool plays_between_walls(const JointLayout& layout) {
  if (layout.play_shape == PlayShape::by_coordinate) return layout.coordinate == Coordinate::position;
  return layout.play_shape == PlayShape::walls;
}

/// Contacts of a joint: its events that begin one.
inline std::size_t contact_count(const JointLayout& layout) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < layout.events.size; ++i) count += event_role(layout, i) == EventRole::contact_begin;
  return count;
}

/// Which of the contacts an event that begins or ends one is about.
inline std::size_t contact_of(const JointLayout& layout, std::size_t event) {
  std::size_t before = 0;
  for (std::size_t i = 0; i < event; ++i) before += event_role(layout, i) == event_role(layout, event);
  return before;
}

/// Index of the field of an event, or -1.
inline int field_index(const Event& event, std::string_view name) {
  for (std::size_t i = 0; i < event.fields.size; ++i) {
    if (event.fields[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace freeplay
