#include "cli/analyze_command.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <system_error>

#include <fmt/format.h>

#include "analysis/analyse.h"
#include "base/processors.h"
#include "base/sha256.h"
#include "base/whole_file.h"
#include "cli/analysis_watch.h"
#include "cli/analyze_options.h"
#include "cli/failure.h"
#include "cli/loading.h"
#include "cli/output_file.h"
#include "cli/terminal.h"
#include "drawing/analysis_map.h"
#include "load/load.h"
#include "results/made_text.h"
#include "results/provenance.h"

namespace freeplay {
namespace {

/// What makes the same table or map again.
Json record_of(const Model& model, const AnalyzeOptions& options, const CommonOptions& common) {
  Making making{.made = "analyze",
                .command = common.command,
                .arguments = analyze_arguments(options, common),
                .build = FREEPLAY_BUILD};
  if (!options.samples.empty()) making.seed = seed_of(options);
  return provenance_with_texts(model, making);
}

/// Table, map and JSON, each to its place with the record of how it was made.
void write_results(const AnalysisResult& result, const std::string& map, Json record, const AnalyzeOptions& options,
                   const CommonOptions& common) {
  if (!options.svg.empty()) write_output(options.svg, picture_with_record(map, record));
  const std::string table = result.table.csv();
  if (!options.out.empty() || !common.json) write_output(options.out, table);
  if (common.json) {
    Json json = result.table.json(options.kind);
    json["provenance"] = record;
    print_json(json);
  }
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(options.out, ignored)) return;  // stdout, a terminal, a pipe
  record["data_sha256"] = sha256(table);
  write_whole_file(record_file(options.out), json_text(record));
}

int analyze(const AnalyzeOptions& options, const CommonOptions& common) {
  if (options.kind.empty() || options.model.empty()) {
    throw Error(Error::Category::usage, "missing-argument", "analyze needs a kind and a model file", {},
                "freeplay analyze ik|workspace|singularity|error|inverse-dynamics MODEL");
  }
  require_sense(options);
  if (!options.out.empty() && options.out == options.svg) {
    throw Error(Error::Category::usage, "bad-value",
                fmt::format("--out and --svg name the same file '{}'", options.out));
  }
  require_no_other_table(options.out, options.force);
  require_no_other_file(options.svg, own_picture, options.force);
  if (options.coloured && options.svg.empty()) {
    throw Error(Error::Category::usage, "bad-value", "--colours is given without --svg", {}, "--svg FILE draws a map");
  }
  LoadedModel loaded = load_model(options.model, build_options(options.build), loading(common));
  if (!loaded.model) return report_failure(loaded.diagnostics, loaded.exit_code, common);
  if (options.branches) require_planar(loaded, "--branches");
  if (!options.elbow.empty()) require_planar(loaded, "--elbow");
  AnalysisResult result;
  std::string map;
  try {
    AnalysisWatch watch(stderr_is_terminal() && !common.quiet);
    const TickOf tick_of = [&](const char* what, std::size_t total) { return watch.begin(what, total); };
    IdealMechanism mechanism(*loaded.model, platform_of(*loaded.model, platform_overrides(*loaded.model, options)));
    const AnalysisRequest request = request_of(mechanism, options, processor_count());
    const RequestedStations stations(mechanism, request, tick_of);
    result = analyse(mechanism, request, stations, tick_of);
    if (!options.svg.empty()) {
      map = analysis_map_svg(mechanism, request, stations, result.table, options.coloured, tick_of);
    }
  } catch (const Interrupted&) {
    Diagnostic diagnostic;
    diagnostic.id = "interrupted";
    diagnostic.message = "interrupted, nothing was written";
    diagnostic.location = {options.model, 0, 0};
    loaded.diagnostics.add(std::move(diagnostic));
    return report_failure(loaded.diagnostics, 130, common);
  } catch (const Error& error) {
    if (error.category() != Error::Category::input && error.category() != Error::Category::plugin) throw;
    Diagnostic diagnostic = as_diagnostic(error);
    if (error.location().file.empty() && loaded.document) diagnostic.location = {loaded.document->file_name(), 0, 0};
    loaded.diagnostics.add(std::move(diagnostic));
    return report_failure(loaded.diagnostics, error.exit_code(), common);
  }
  print_messages(loaded.diagnostics.format(common.max_errors), common.no_color);
  for (const std::string& warning : result.warnings) {
    print_messages(fmt::format("{}: warning: {}\n", options.model, warning), common.no_color);
  }
  write_results(result, map, record_of(*loaded.model, options, common), options, common);
  return 0;
}

}  // namespace

Command add_analyze_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "analyze", "Kinematics, errors by clearance and drive forces of a platform");
  const auto options = std::make_shared<AnalyzeOptions>();
  add_option(*app, "KIND", options->kind, "ik, workspace, singularity, error or inverse-dynamics");
  add_option(*app, "MODEL", options->model, "Model file");
  add_option(*app, "--frame", options->frame, "The platform: BODY or BODY/FRAME", "FRAME");
  add_repeatable(*app, "--pose", options->pose,
                 "Pose: x,y,angle or x=5cm,y=0 (in space x,y,z,roll,pitch,yaw); repeatable", "POSE");
  add_repeatable(*app, "--grid", options->grid, "Poses on a grid: x=FROM:TO:COUNT (also y and so on); repeatable",
                 "GRID");
  add_option(*app, "--time", options->time, "Instants on the path: FROM:TO:COUNT", "TIMES");
  add_repeatable(*app, "--input", options->input, "Coordinates of driven joints: JOINT=VALUE,...; repeatable",
                 "INPUTS");
  add_option(*app, "--elbow", options->elbow, "Working modes of the legs: 1 or -1, or a list", "S[,S...]");
  add_flag(*app, "--sensitivity", options->sensitivity, "error: sensitivity to the clearance of each joint");
  add_option(*app, "--samples", options->samples, "error: columns of N samples of random play", "N");
  add_option(*app, "--seed", options->seed, "Of the samples (0)", "S");
  add_option(*app, "--distribution", options->distribution, "Of the samples: uniform (default), rim or normal[:SIGMA]",
             "LAW");
  add_flag(*app, "--branches", options->branches, "ik: all working modes of a --pose, all assemblies of an --input");
  add_option(*app, "--preload", options->preload, "inverse-dynamics: inner tension of redundant drivers", "VALUE");
  add_file_option(*app, "--out", options->out, "Write the CSV into a file instead of stdout", "FILE");
  add_file_option(*app, "--svg", options->svg, "Draw the map of a grid of x and y into a file", "FILE");
  add_flag(*app, "--colours", options->coloured, "The map in colours in place of greys");
  add_flag(*app, "--force", options->force, "Replace files that are no table or picture");
  add_model_options(*app, options->build);
  add_common_options(*app, common);
  return {app, [options, &common] { return analyze(*options, common); }};
}

}  // namespace freeplay
