// The events of several contacts, and their roles, from a list of names.
#pragma once

#include <array>
#include <cstddef>

#include "freeplay/kit/contact_phase.h"

namespace freeplay::play {

/// Events of contacts, by name: begin and end of the first one, of the second one, ...
template <std::size_t N>
constexpr std::array<Event, N> contact_events(const char* const (&names)[N]) {
  std::array<Event, N> all{};
  for (std::size_t i = 0; i < N; ++i)
    all[i] = {names[i], i % 2 == 0 ? Crossing::rising : Crossing::falling, 1, event_fields};
  return all;
}
template <std::size_t N>
constexpr std::array<EventRole, N> contact_event_roles() {
  std::array<EventRole, N> all{};
  for (std::size_t i = 0; i < N; ++i) all[i] = begin_and_end[i % 2];
  return all;
}

}  // namespace freeplay::play
