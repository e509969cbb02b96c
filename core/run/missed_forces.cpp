#include "run/missed_forces.h"

#include <fmt/format.h>

#include "run/context.h"

namespace freeplay {

void MissedForces::say(RunContext& run) const {
  if (!(times > allowed)) return;
  const std::string& name = run.model.bodies[static_cast<std::size_t>(body)].name;
  run.warnings.push_back(fmt::format(
      "body '{}': at t = {:.9g} s, inside a step of {:.3g} s, forces act on it that the motion of this step "
      "does not show, as if they were not; ask for a smaller accuracy, or for a fixed step that is shorter "
      "than they last",
      name, at, length));
  run.outcome.doubts.push_back(
      {.id = "unresolved-input",
       .level = Trust::doubtful,
       .message = fmt::format("forces on body '{}' at t = {:.9g} s act inside a step of {:.3g} s and do not move it",
                              name, at, length),
       .element = name,
       .value = times,
       .limit = allowed});
}

}  // namespace freeplay
