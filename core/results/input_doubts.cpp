#include "results/input_doubts.h"

#include <fmt/format.h>

namespace freeplay {

std::vector<std::string> warnings_of(const Diagnostics& diagnostics, std::span<const std::string> more) {
  std::vector<std::string> warnings;
  for (const Diagnostic& d : diagnostics.sorted()) warnings.push_back(fmt::format("{} [{}]", d.message, d.id));
  warnings.insert(warnings.end(), more.begin(), more.end());
  return warnings;
}

void doubt_input(const Diagnostics& diagnostics, Verdict& verdict) {
  for (const Diagnostic& diagnostic : diagnostics.sorted()) {
    const bool start = diagnostic.id == "unstable-start" || diagnostic.id == "dead-point";
    if (!start && !diagnostic.id.starts_with("doubtful")) continue;
    const char* const id = start ? "unstable-start" : "doubtful-input";
    verdict.add({.id = id, .level = Trust::doubtful, .message = diagnostic.message});
  }
}

}  // namespace freeplay
