// RunOverrides: targets of `--set` that act as options of a run, whether the file has the key or not.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "format/build_options.h"
#include "format/parameter_scope.h"

namespace freeplay {

std::span<const char* const> run_override_names();
/// Is it `simulation.end`, `simulation.step`, `simulation.accuracy`, `simulation.integrator`, `ideal`, `repeat` or
/// `seed`?
bool is_run_override(std::string_view name);

/// Takes these of `options.set` into the fields that the options of the command line fill, which win. Values may use
/// `parameters`; of step and accuracy the last one counts. Throws Error{usage}.
void apply_run_overrides(BuildOptions& options, const ParameterScope& parameters);

/// Which of the starts in its play a model begins from.
struct StartChoice {
  std::uint64_t repeat = 1;  ///< as runs of `--repeat` count: 1 is its own
  std::uint64_t seed = 1;    ///< of the draws of the others
};

/// What `repeat` and `seed` of `--set` say of a model that was built with them.
StartChoice start_choice(const Model& model);

}  // namespace freeplay
