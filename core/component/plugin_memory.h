// PluginMemory: memory that a plugin did not get is missing for the whole program.
#pragma once

#include <new>
#include <string_view>

#include "freeplay/plugin.h"

namespace freeplay {

/// After a call that failed: throws std::bad_alloc again, of which no more than its text comes over the boundary.
inline void require_memory(const Message& message) {
  if (message.text == std::string_view(std::bad_alloc().what())) throw std::bad_alloc();
}

}  // namespace freeplay
