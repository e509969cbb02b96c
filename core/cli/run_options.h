// RunOptions: what `freeplay run` is asked for.
#pragma once

#include <string>

#include "cli/options.h"
#include "job/kept_words.h"

namespace freeplay {

struct RunOptions : KeptWords {
  std::string model, out, checkpoint, resume;
  // Of a run that goes on: the name of its model, whose copy has none where it was that of the file.
  std::string model_name;
  bool force = false, yes = false, dry_run = false, profile = false, report = false;
  int twin_pipe = -1;  ///< this run is the twin of another, which compares
};

void add_run_options(CLI::App& app, RunOptions& options);

/// Throws Error{usage} for options of which one leaves another nothing to do.
void refuse_idle_options(const RunOptions& options);

/// Throws Error{usage} for options that do not go with --resume: the rest is that of the run which goes on.
void refuse_other_options(const CLI::App& app);

}  // namespace freeplay
