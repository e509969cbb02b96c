#include "results/input_doubts.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace freeplay {
namespace {

/// The reason of the verdict for a warning of this id; null: it says nothing of the numbers.
const char* reason_of_warning(std::string_view id) {
  constexpr std::string_view structure[] = {"left-free",       "same-frame",    "not-connected", "duplicate-joint",
                                            "duplicate-force", "play-bypassed", "locked",        "idle-force"};
  if (id == "unstable-start" || id == "dead-point") return "unstable-start";
  if (std::ranges::find(structure, id) != std::end(structure)) return "doubtful-structure";
  return id.starts_with("doubtful") ? "doubtful-input" : nullptr;
}

}  // namespace

std::vector<std::string> warnings_of(const Diagnostics& diagnostics, std::span<const std::string> more) {
  std::vector<std::string> warnings;
  for (const Diagnostic& d : diagnostics.sorted()) warnings.push_back(fmt::format("{} [{}]", d.message, d.id));
  warnings.insert(warnings.end(), more.begin(), more.end());
  return warnings;
}

void doubt_input(const Diagnostics& diagnostics, Verdict& verdict) {
  for (const Diagnostic& diagnostic : diagnostics.sorted()) {
    const char* const id = reason_of_warning(diagnostic.id);
    if (id != nullptr) verdict.add({.id = id, .level = Trust::doubtful, .message = diagnostic.message});
  }
}

}  // namespace freeplay
