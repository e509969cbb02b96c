#include "cli/run_options.h"

#include <fmt/format.h>

#include "base/error.h"
#include "cli/repeat_runs.h"

namespace freeplay {
namespace {

/// Every option that the numbers or the files of a run depend on.
template <class Options, class Common, class Visit>
void each_kept(Options& options, Common& common, Visit&& visit) {
  visit("end", options.end);
  visit("step", options.step);
  visit("accuracy", options.accuracy);
  visit("integrator", options.integrator);
  visit("format", options.format);
  visit("repeat", options.repeat);
  visit("seed", options.seed);
  visit("set", options.model_options.set);
  visit("ideal", options.model_options.ideal);
  visit("verify", options.verify);
  visit("interval", options.interval);
  visit("inputs", options.inputs);
  visit("channels", options.channels);
  visit("twin", options.twin);
  visit("plugins", options.plugins);
  visit("strict", common.strict);
}

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
  if (!options.inputs.empty() && (options.verify || !options.repeat.empty())) {
    throw Error(Error::Category::usage, "usage",
                fmt::format("--inputs and {} exclude each other: other runs have no inputs",
                            options.verify ? "--verify" : "--repeat"));
  }
  if (options.twin && !options.repeat.empty()) {
    throw Error(Error::Category::usage, "usage",
                "--twin and --repeat exclude each other: a twin without play has one start only");
  }
}

double checkpoint_period(const RunOptions& options) {
  constexpr double usual = 10.0;
  if (options.checkpoint.empty()) return usual;
  if (options.checkpoint == "0") return 0.0;
  const double period = signed_quantity("--checkpoint", options.checkpoint, dimension::time);
  if (!(period >= 0.0)) bad_value("--checkpoint", options.checkpoint, "it must not be negative");
  return period;
}

Making making(const RunOptions& options, const CommonOptions& common, const Model& model) {
  Making making{
      .made = "run", .command = common.command, .arguments = arguments_of(model, options), .build = FREEPLAY_BUILD};
  const auto add = [&](const char* option, const std::string& value) {
    if (value.empty()) return;
    making.arguments.emplace_back(option);
    making.arguments.push_back(value);
  };
  add("--inputs", options.inputs);
  add("--repeat", options.repeat);
  add("--seed", options.seed);
  if (!options.repeat.empty()) making.seed = repeat_plan(options.repeat, options.seed).seed;
  if (options.verify) making.arguments.emplace_back("--verify");
  if (options.twin) making.arguments.emplace_back("--twin");
  for (const std::string& plugin : options.plugins) add("--plugin", plugin);
  return making;
}

Json kept_options(const RunOptions& options, const CommonOptions& common) {
  Json kept;
  each_kept(options, common, [&](const char* name, const auto& value) { kept[name] = value; });
  return kept;
}

bool keep_options(const Json& kept, RunOptions& options, CommonOptions& common) {
  try {
    each_kept(options, common, [&](const char* name, auto& value) { kept.at(name).get_to(value); });
  } catch (const Json::exception&) {
    return false;
  }
  return true;
}

}  // namespace freeplay
