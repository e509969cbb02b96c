// What the warnings before a run say of its numbers.
#pragma once

#include <algorithm>
#include <string_view>

#include "base/diagnostics.h"
#include "run/trust.h"

namespace freeplay {

/// The reason of the verdict for a warning of this id; null: it says nothing of the numbers.
inline const char* reason_of_warning(std::string_view id) {
  constexpr std::string_view structure[] = {"left-free",       "same-frame",    "not-connected", "duplicate-joint",
                                            "duplicate-force", "play-bypassed", "locked"};
  if (id == "unstable-start" || id == "dead-point") return "unstable-start";
  if (std::ranges::find(structure, id) != std::end(structure)) return "doubtful-structure";
  return id.starts_with("doubtful") ? "doubtful-input" : nullptr;
}

/// What the model is doubted for.
inline void doubt_input(const Diagnostics& diagnostics, Verdict& verdict) {
  for (const Diagnostic& diagnostic : diagnostics.sorted()) {
    const char* const id = reason_of_warning(diagnostic.id);
    if (id != nullptr) verdict.add({.id = id, .level = Trust::doubtful, .message = diagnostic.message});
  }
}

}  // namespace freeplay
