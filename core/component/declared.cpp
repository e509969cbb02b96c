#include "component/declared.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace freeplay {
namespace {

// Beyond is a number that was not set.
constexpr int most_of_a_joint = 10000, most_of_an_integrator = 100000000;
constexpr std::size_t most_names = 1000;
constexpr std::size_t numbers_of_bound = 7, most_bounds = 16;

bool all_named(Span<const Channel> channels) {
  if (channels.data == nullptr) return channels.size == 0;
  for (const Channel& channel : channels) {
    if (channel.name == nullptr || channel.unit == nullptr) return false;
  }
  return true;
}

bool known_roles(const JointLayout& layout) {
  if (layout.channel_roles.data == nullptr && layout.channel_roles.size > 0) return false;
  if (layout.event_roles.data == nullptr && layout.event_roles.size > 0) return false;
  unsigned seen = 0;
  for (const ChannelRole role : layout.channel_roles) {
    if (role == ChannelRole::none) continue;
    const unsigned bit = role > ChannelRole::in_contact ? seen : 1U << static_cast<unsigned>(role);
    if (role > ChannelRole::in_contact || (seen & bit) != 0) return false;
    seen |= bit;
  }
  return std::ranges::all_of(layout.event_roles, [](EventRole role) { return role <= EventRole::contact_end; });
}

bool known_bounds(Span<const double> bounds, Space space) {
  if (bounds.size % numbers_of_bound != 0 || bounds.size > most_bounds * numbers_of_bound) return false;
  if (bounds.data == nullptr) return bounds.size == 0;
  for (std::size_t i = 0; i < bounds.size; i += numbers_of_bound) {
    const Span<const double> one = bounds.part(i, numbers_of_bound);
    if (!std::ranges::all_of(one, [](double x) { return std::isfinite(x); })) return false;
    if (space == Space::planar && (one[3] != 0.0 || one[4] != 0.0 || one[5] != 0.0)) return false;
    if (!(one[0] > 0.0) || std::ranges::all_of(one.part(1, 6), [](double x) { return x == 0.0; })) return false;
  }
  return true;
}

}  // namespace

std::string declaration_fault(const JointLayout& layout) {
  const int most_rows = layout.space == Space::planar ? 3 : 6;
  if (layout.constraint_rows < 0 || layout.constraint_rows > most_rows) {
    return fmt::format("it declares {} constraint rows, of at most {}", layout.constraint_rows, most_rows);
  }
  if (layout.internal_variables < 0 || layout.internal_variables > most_of_a_joint) {
    return fmt::format("it declares {} internal variables", layout.internal_variables);
  }
  if (layout.history < 0 || layout.history > most_of_a_joint) {
    return fmt::format("it declares {} numbers of history", layout.history);
  }
  if (!(layout.clearance >= 0.0) || !std::isfinite(layout.clearance)) {
    return fmt::format("it declares a clearance of {} m", layout.clearance);
  }
  if (!(layout.time_scale >= 0.0)) return fmt::format("it declares changes that last {} s", layout.time_scale);
  if (layout.play_shape > PlayShape::walls) return "it declares play of an unknown shape";
  if (!(layout.contact_reach >= 0.0) || !std::isfinite(layout.contact_reach)) {
    return fmt::format("it declares contacts {} m from the second origin", layout.contact_reach);
  }
  if (!known_bounds(layout.play_bounds, layout.space)) {
    return fmt::format(
        "it declares bounds of its play that are not up to {} times a gap above 0 and six numbers, not "
        "all of them 0, in the plane x, y and the turn alone",
        most_bounds);
  }
  if (layout.planar_rows.size > 0 && layout.space == Space::planar) {
    if (layout.planar_rows.data == nullptr) return "it declares planar rows and does not say which";
    std::int32_t rows = 0;
    for (const PlanarRow row : layout.planar_rows) {
      if (row > PlanarRow::turn) return "it declares a planar row of an unknown kind";
      rows += row == PlanarRow::origins ? 2 : 1;
    }
    if (rows != layout.constraint_rows) {
      return fmt::format("it declares {} constraint rows, and planar rows that are {}", layout.constraint_rows, rows);
    }
  }
  if (layout.coordinate > Coordinate::position) return "it declares a coordinate of an unknown kind";
  if (layout.events.size > most_names || layout.channels.size > most_names) {
    return fmt::format("it declares {} events and {} channels", layout.events.size, layout.channels.size);
  }
  if (layout.channel_roles.size > 0 && layout.channel_roles.size != layout.channels.size) {
    return fmt::format("it declares {} channels and {} roles of channels", layout.channels.size,
                       layout.channel_roles.size);
  }
  if (layout.event_roles.size > 0 && layout.event_roles.size != layout.events.size) {
    return fmt::format("it declares {} events and {} roles of events", layout.events.size, layout.event_roles.size);
  }
  if (!known_roles(layout)) return "it declares roles that are none, or one of a channel twice";
  bool named = all_named(layout.channels) && (layout.events.data != nullptr || layout.events.size == 0);
  if (!named) return "it declares an event or a channel without name or unit";
  for (const Event& event : layout.events) {
    named = named && event.name != nullptr && event.fields.size <= most_names && all_named(event.fields);
  }
  return named ? "" : "it declares an event or a channel without name or unit";
}

std::string declaration_fault(const IntegratorLayout& layout) {
  if (layout.memory < 0 || layout.memory > most_of_an_integrator || layout.scratch < 0 ||
      layout.scratch > most_of_an_integrator) {
    return fmt::format("it declares {} numbers of memory and {} of scratch", layout.memory, layout.scratch);
  }
  if (layout.order < 1) return fmt::format("it declares the order {}", layout.order);
  if (!(layout.newton_tolerance > 0.0) || layout.newton_max_iterations < 1) {
    return fmt::format("it declares a tolerance of {} and {} iterations", layout.newton_tolerance,
                       layout.newton_max_iterations);
  }
  return "";
}

}  // namespace freeplay
