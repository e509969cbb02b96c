// Resumption: `freeplay run --resume DIR`.
#pragma once

#include <string>

#include "cli/run_options.h"
#include "results/checkpoint.h"

namespace freeplay {

/// How a run goes on that did not come to its end.
struct Resumption {
  RunOptions options;  ///< of that run, with what may change
  Checkpoint checkpoint;
  bool goes_on = true;        ///< else it is made again from its start, with a later end
  double interval = 0.0;      ///< between rows, of that run [s]
  std::string nothing_to_do;  ///< why not; empty where there is something
};

/// Reads what is there and changes nothing. `common` gets the plugins of that run. Throws Error{usage} for options that
/// do not go with --resume and an end that is not later, Error{file} "unreadable-result", "no-checkpoint",
/// "bad-checkpoint", Error{input} "resume-mismatch" where another program made the result.
Resumption read_resumption(const CLI::App& app, const RunOptions& asked, CommonOptions& common);

/// Throws Error{input} "resume-mismatch" where the model, an input or a plugin is not the one of that run.
void require_same_making(const Resumption& resumption, const Model& model);

}  // namespace freeplay
