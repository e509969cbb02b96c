// RunOptions: what `freeplay run` is asked for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "cli/options.h"
#include "model/model.h"
#include "results/provenance.h"

namespace freeplay {

struct RunOptions : RunWords {
  std::string model, out, repeat, seed, checkpoint, resume, inputs;
  // Of a run that goes on: the name of its model, whose copy has none where it was that of the file.
  std::string model_name;
  std::vector<std::string> plugins;  ///< words of --plugin, of the run that goes on where one does
  bool force = false, yes = false, dry_run = false, verify = false, profile = false, twin = false, report = false;
  int twin_pipe = -1;  ///< this run is the twin of another, which compares
};

void add_run_options(CLI::App& app, RunOptions& options);

/// Throws Error{usage} for options of which one leaves another nothing to do.
void refuse_idle_options(const RunOptions& options);

/// Seconds of wall time between two checkpoints; 0: only those that are always made. Throws Error{usage} "bad-value".
double checkpoint_period(const RunOptions& options);

/// Its arguments make the same run of the same model file, in whatever words this one was asked for.
Making making(const RunOptions& options, const CommonOptions& common, const Model& model);

/// What says how the run is made, for a run that goes on from it; without paths and what is only shown.
Json kept_options(const RunOptions& options, const CommonOptions& common);
/// Sets these again. False where `kept` is none of them.
bool keep_options(const Json& kept, RunOptions& options, CommonOptions& common);

}  // namespace freeplay
