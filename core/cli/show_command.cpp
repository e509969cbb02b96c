#include "cli/show_command.h"

#include <memory>

#include <fmt/format.h>

#include "cli/failure.h"
#include "cli/loading.h"
#include "cli/output_file.h"
#include "cli/result_picture.h"
#include "cli/terminal.h"
#include "convert/model_json.h"
#include "drawing/mechanism_drawing.h"
#include "drawing/model_text.h"
#include "load/load.h"
#include "load/result_model.h"

namespace freeplay {
namespace {

struct ShowOptions {
  std::string model, format, out;
  ResultPictureOptions picture;
  ModelOptions build;
};

int show(ShowOptions options, const CommonOptions& common) {
  if (options.model.empty())
    throw Error(Error::Category::usage, "missing-argument", "show needs a model file or a result directory");
  if (!options.format.empty()) require_word("format", options.format, {"text", "json", "dot", "svg"});
  if (options.format.empty()) options.format = common.json ? "json" : "text";
  if (common.json && options.format != "json") {
    throw Error(Error::Category::usage, "bad-value", "--json and --format " + options.format + " exclude each other");
  }
  if (options.picture.any() && options.format != "svg") {
    throw Error(Error::Category::usage, "bad-value", "--at, --every, --trace and --magnify need --format svg");
  }
  BuildOptions build = build_options(options.build);
  const std::string directory = options.model;
  const ResultWords result = use_model_of_result(options.model, build);
  if (options.picture.any() && options.model == directory) {
    throw Error(
        Error::Category::usage, "bad-value",
        fmt::format("--at, --every, --trace and --magnify need a result directory, and '{}' is a model", directory));
  }
  LoadedModel loaded = load_model(options.model, build, loading(common));
  const auto integrator_of = [](const Model& model) -> std::string_view {
    const Component* type = model.settings.integrator_parameters.component;
    return type == nullptr ? "" : type->description.name;
  };
  if (loaded.model && !result.integrator.empty() && result.integrator != integrator_of(*loaded.model)) {
    build.integrator = result.integrator;  // another than that of the file, with its default parameters
    loaded = load_model(options.model, build, loading(common));
  }
  if (loaded.model && !result.name.empty()) loaded.model->name = result.name;
  std::unique_ptr<AssembledModel> assembled;
  if (loaded.exit_code == 0 && options.format == "svg") assembled = assemble_model(loaded);
  if (loaded.exit_code != 0) return report_failure(loaded.diagnostics, loaded.exit_code, common);
  if (result.name.empty()) print_messages(loaded.diagnostics.format(common.max_errors), common.no_color);
  std::string text;
  if (options.format == "svg") {
    text = options.picture.any()
               ? mechanism_svg(assembled->system, result_picture(directory, assembled->system, options.picture).picture)
               : mechanism_svg(assembled->system, {assembled->start.state.q()});
  } else {
    const Json model = model_json(*loaded.model, options.format == "text" ? Quantities::text : Quantities::numbers);
    text = options.format == "json"  ? json_text(model)
           : options.format == "dot" ? model_graph(model)
                                     : model_tree(model);
  }
  write_output(options.out, text);
  return 0;
}

}  // namespace

Command add_show_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "show", "Print or draw a model after everything in it is expanded");
  const auto options = std::make_shared<ShowOptions>();
  add_option(*app, "MODEL", options->model, "Model file, or result directory: the model as it ran");
  add_option(*app, "--format", options->format, "text (default), json, dot for Graphviz, svg: a drawing of the start",
             "FORMAT");
  add_option(*app, "--at", options->picture.at, "Of a result: draw it at this time, \"10 ms\" (its end)", "T");
  add_option(*app, "--every", options->picture.every,
             "Of a result: pale, where it was before, each so much time or turn of the first driven joint: \"30 deg\"",
             "STEP");
  add_repeatable(*app, "--trace", options->picture.traces, "Of a result: the way of a frame, BODY/FRAME; repeatable",
                 "FRAME");
  add_repeatable(*app, "--magnify", options->picture.magnify,
                 "Of a result: a journal in its clearance, so many times larger: tip=500; repeatable", "JOINT=FACTOR");
  add_file_option(*app, "--out", options->out, "Write into a file instead of stdout", "FILE");
  add_model_options(*app, options->build);
  add_common_options(*app, common);
  return {app, [options, &common] { return show(*options, common); }};
}

}  // namespace freeplay
