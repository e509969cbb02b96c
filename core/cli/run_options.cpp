#include "cli/run_options.h"

#include <algorithm>
#include <array>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/error.h"

namespace freeplay {
namespace {

// What the numbers of a run that goes on may differ in; the rest of its options stays as it was.
constexpr std::array may_change{"--resume", "--end", "--checkpoint", "--report", "--profile", "--yes"};
constexpr std::array of_every_command{"--quiet",      "--verbose", "--json",         "--no-color",
                                      "--max-errors", "--plugin",  "--allow-plugins"};

}  // namespace

void add_run_options(CLI::App& app, RunOptions& options) {
  add_option(app, "MODEL", options.model, "Model file");
  add_option(app, "--end", options.end, "End time: \"0.5 s\"", "T");
  add_option(app, "--step", options.step, "Step: 2us", "H");
  add_option(app, "--accuracy", options.accuracy, "Accuracy of positions instead of a step: 1um", "L");
  add_option(app, "--interval", options.interval, "Between output rows, in place of the file's: 0.1ms", "T");
  add_repeatable(app, "--channels", options.channels,
                 "Channels to write, a name or pattern with *, in place of the file's; repeatable", "PATTERN");
  add_option(app, "--integrator", options.integrator, "Integrator, with its default parameters", "NAME");
  add_file_option(app, "--inputs", options.inputs,
                  "Efforts of the drivers that are inputs, a table over time: inputs.csv of another run", "FILE");
  add_flag(app, "--verify", options.verify,
           "Run again by a method of another kind and print the observed errors; exit code 7 when both disagree");
  add_option(app, "--repeat", options.repeat, "Run N times, from starts moved in the play: median and range of peaks",
             "N");
  add_option(app, "--seed", options.seed, "Of the starts of --repeat (1)", "S");
  add_flag(app, "--twin", options.twin, "Run the model with every clearance closed alongside, and compare both");
  add_flag(app, "--report", options.report, "Write report.html beside the results, as `freeplay report` does");
  add_flag(app, "--profile", options.profile,
           "Print where the time went: assembly, factorization, joints, events, output");
  add_file_option(app, "--out", options.out, "Result directory (results/NAME)", "DIR");
  add_flag(app, "--force", options.force, "Write into a directory that holds other files");
  add_flag(app, "--yes", options.yes, "Write even what takes more than half of the room that is free");
  add_option(app, "--format", options.format, "Of the results: csv, hdf5, both (both)", "FORMAT");
  add_option(app, "--checkpoint", options.checkpoint, "Wall time between checkpoints (10 s); 0: when it is interrupted",
             "T");
  add_file_option(app, "--resume", options.resume, "Go on with the run of a result directory that did not end", "DIR");
  add_flag(app, "--dry-run", options.dry_run, "Load, assemble, print the facts, write nothing");
  add_model_options(app, options.model_options);
}

void refuse_idle_options(const RunOptions& options) {
  if (options.dry_run &&
      (options.verify || options.profile || options.twin || options.report || !options.repeat.empty())) {
    const char* idle = options.verify    ? "--verify"
                       : options.profile ? "--profile"
                       : options.twin    ? "--twin"
                       : options.report  ? "--report"
                                         : "--repeat";
    throw Error(Error::Category::usage, "usage",
                fmt::format("--dry-run runs nothing, so {} has nothing to report", idle));
  }
  require_together(options);
}

void refuse_other_options(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || std::ranges::find(may_change, name) != may_change.end() ||
        std::ranges::find(of_every_command, name) != of_every_command.end()) {
      continue;
    }
    throw Error(Error::Category::usage, "usage", fmt::format("{} does not go with --resume", name), {},
                "model and settings are those of the run that goes on; only --end, --checkpoint, --report, "
                "--profile and --yes may change");
  }
}

}  // namespace freeplay
