#include "cli/study_command.h"

#include <memory>
#include <utility>
#include <vector>

#include "base/error.h"
#include "cli/study_options.h"
#include "cli/study_run.h"
#include "cli/study_views.h"

namespace freeplay {
namespace {

using Act = int (*)(const StudyOptions&, const CommonOptions&);

void add_study_options(CLI::App& app, StudyOptions& options) {
  add_model_options(app, options.model);
  add_option(app, "--end", options.end, "End time at every point: \"0.5 s\"", "T");
  add_option(app, "--step", options.step, "Step at every point: 2us", "H");
  add_option(app, "--accuracy", options.accuracy, "Accuracy of positions at every point instead of a step: 1um", "L");
  add_option(app, "--integrator", options.integrator, "Integrator at every point", "NAME");
}

void add_plan(CLI::App& app, StudyOptions& options) {
  add_flag(app, "--points", options.list_points, "List all points as CSV");
  add_option(app, "--only", options.only, "With --points: only these, such as 0-9,12", "LIST");
  add_option(app, "--probe", options.probe, "Points to time (8); 0: none", "N");
  add_flag(app, "--yes", options.yes, "More than 10^8 points");
  add_study_options(app, options);
}

void add_run(CLI::App& app, StudyOptions& options) {
  add_file_option(app, "--out", options.out, "Directory of the study (results/NAME-study)", "DIR");
  add_option(app, "--jobs", options.jobs, "Workers; default: the processors that it may use", "N");
  add_option(app, "--shard", options.shard, "Only this part of the points, and no merge: 2/8", "I/N");
  add_option(app, "--only", options.only, "Only these points: 0-9,12", "LIST");
  add_flag(app, "--retry-failed", options.retry_failed, "Run failed points again");
  add_flag(app, "--allow-failed", options.allow_failed, "Exit code 0 also when points failed");
  add_option(app, "--keep", options.keep, "Result directories to keep: none (default), failed or all", "WHICH");
  add_option(app, "--point-timeout", options.point_timeout, "Longest time of a point: \"30 s\"", "T");
  add_flag(app, "--isolate", options.isolate, "A new process for every point");
  add_flag(app, "--extend", options.extend, "Of a changed study keep the rows of points that are still the same");
  add_flag(app, "--restart", options.restart, "Set all rows aside in old/ and run all points");
  add_option(app, "--sync", options.sync, "Longest time until rows are on the disk (1 s); 0: after each point", "T");
  add_flag(app, "--yes", options.yes, "More than 10^8 points, or more than 10000 kept results");
  add_study_options(app, options);
}

void add_status(CLI::App& app, StudyOptions& options) {
  add_flag(app, "--watch", options.watch, "Again every two seconds until nothing is left");
}

void add_merge(CLI::App& app, StudyOptions& options) {
  add_file_option(app, "--out", options.out, "Directory that gets all rows (the first)", "DIR");
  add_flag(app, "--partial", options.partial, "Merge what is there although points are missing");
}

void add_script(CLI::App& app, StudyOptions& options) {
  add_file_option(app, "--out", options.out, "Directory of the study (results/NAME-study)", "DIR");
  add_option(app, "--engine", options.engine, "slurm, gnu-parallel or snakemake", "ENGINE");
  add_option(app, "--minutes", options.minutes, "That a task takes, 10 to 60 (30)", "M");
  add_option(app, "--tasks", options.tasks, "Number of tasks, in place of --minutes", "N");
  add_option(app, "--cores", options.cores, "Of a task (1)", "C");
  add_option(app, "--time", options.time, "Limit of a task (three times what it takes)", "HH:MM:SS");
  add_option(app, "--probe", options.probe, "Points to time (32)", "N");
  add_option(app, "--hosts", options.hosts, "File of hosts for GNU parallel", "FILE");
  add_option(app, "--max-array", options.max_array, "Most tasks of an array (1000)", "N");
  add_flag(app, "--yes", options.yes, "More than 10^8 points");
  add_study_options(app, options);
}

void add_point(CLI::App& app, StudyOptions& options) {
  add_flag(app, "--run", options.run_point, "Run it");
  add_file_option(app, "--out", options.out, "With --run: the result directory", "DIR");
}

void add_plot(CLI::App& app, StudyOptions& options) {
  add_file_option(app, "--out", options.out, "File of the picture (DIR/plots/NAME.svg)", "FILE");
  add_flag(app, "--force", options.force, "Replace a file that is no picture");
  add_option(app, "--kind", options.kind, "One picture: line, heat, bifurcation, histogram or tornado", "KIND");
  add_option(app, "--x", options.x, "With --kind: the axis", "AXIS");
  add_option(app, "--y", options.y, "With --kind: the reducer; of heat the second axis", "NAME");
  add_option(app, "--value", options.value, "With --kind: the reducer", "NAME");
  add_option(app, "--by", options.by, "With --kind: a family for each model, value or direction", "NAME");
}

void add_verify(CLI::App& app, StudyOptions& options) {
  add_option(app, "--points", options.points, "How many points run again (20)", "N");
  add_option(app, "--seed", options.seed, "Of the choice (1)", "S");
}

struct StudyWord {
  const char* name;
  const char* help;
  const char* argument;
  void (*add)(CLI::App&, StudyOptions&);
  Act act;
};

constexpr StudyWord study_words[] = {
    // clang-format off
    {"plan", "Check a study, count its points and time some of them", "FILE|DIR", add_plan, study_plan},
    {"run", "Run the points that are not done, then make the table", "FILE|DIR", add_run, study_run},
    {"status", "How far a study is", "DIR", add_status, study_status},
    {"merge", "Make the table of the rows of one or more directories", "DIR", add_merge, study_merge},
    {"script", "Write scripts that run a study on Slurm, GNU parallel or Snakemake", "FILE|DIR", add_script, study_script},
    {"point", "The command that repeats a point: DIR INDEX", "DIR", add_point, study_point},
    {"plot", "Draw the pictures of `plots`, or one: DIR [PLOT...]", "DIR", add_plot, study_plot},
    {"verify", "Run some points again and compare every bit", "DIR", add_verify, study_verify},
    // clang-format on
};

}  // namespace

Command add_study_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "study",
                              "Run a model at many points: plan, run, status, merge, script, point, "
                              "plot, verify");
  add_common_options(*app, common);
  std::vector<std::pair<CLI::App*, const StudyWord*>> commands;
  const auto options = std::make_shared<StudyOptions>();
  for (const StudyWord& word : study_words) {
    CLI::App* own = add_nested_command(*app, word.name, word.help);
    add_arguments(*own, word.argument, options->studies, "Study file, model with a study, or directory of a study");
    word.add(*own, *options);
    add_common_options(*own, common);
    commands.emplace_back(own, &word);
  }
  return {app, [options, &common, commands] {
            for (const auto& command : commands) {
              if (is_chosen(*command.first)) return command.second->act(*options, common);
            }
            throw Error(Error::Category::usage, "missing-argument", "study needs a command", {},
                        "freeplay study --help lists them");
          }};
}

}  // namespace freeplay
