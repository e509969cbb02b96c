#include "cli/show_command.h"

#include <filesystem>
#include <memory>
#include <system_error>

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
#include "results/made_text.h"
#include "results/provenance.h"
#include "results/result_record.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

struct ShowOptions {
  std::string model, format, out;
  ResultPictureOptions picture;
  ModelOptions build;
  bool force = false;
};

void require_fitting(const ShowOptions& options, bool json) {
  const auto refuse = [](const std::string& why) { throw Error(Error::Category::usage, "bad-value", why); };
  if (options.model.empty())
    throw Error(Error::Category::usage, "missing-argument", "show needs a model file or a result directory");
  require_word("format", options.format, {"text", "json", "dot", "svg"});
  const bool to_file = options.format == "svg" && !options.out.empty();
  if (json && options.format != "json" && !to_file) {
    refuse("--json and --format " + options.format + " exclude each other");
  }
  if (options.picture.any() && options.format != "svg") {
    refuse("--at, --every, --trace and --magnify need --format svg");
  }
}

/// Of a result directory, or what stands for it where the run goes on or was killed; null of all else.
Json summary_of(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return nullptr;
  if (Json summary = read_summary(path); summary.is_object()) return summary;
  if (!fs::exists(path / "run.log", ignored)) return nullptr;
  return summary_of_unfinished(path, *ResultReader::open(path));
}

class Show {
 public:
  Show(ShowOptions options, const CommonOptions& common)
      : options_(std::move(options)), common_(common), path_(options_.model) {
    if (options_.format.empty()) options_.format = common.json ? "json" : "text";
    require_fitting(options_, common.json);
    require_no_other_file(options_.out, own_picture, options_.force);
  }

  int execute() {
    summary_ = summary_of(path_);
    read_model();
    if (loaded_.exit_code == 0 && draws()) assembled_ = assemble_model(loaded_);
    if (loaded_.exit_code != 0) return report_failure(loaded_.diagnostics, loaded_.exit_code, common_);
    if (!is_result()) print_messages(loaded_.diagnostics.format(common_.max_errors), common_.no_color);
    write_output(options_.out, draws() ? picture_with_record(picture(), record()) : text());
    if (common_.json && draws()) print_json({{"file", options_.out}});
    return 0;
  }

 private:
  bool draws() const { return options_.format == "svg"; }
  bool is_result() const { return summary_.is_object(); }

  void read_model() {
    BuildOptions build = build_options(options_.build);
    std::string file = path_;
    const ResultWords result = use_model_of_result(file, summary_, build);
    if (options_.picture.any() && !is_result()) {
      throw Error(
          Error::Category::usage, "bad-value",
          fmt::format("--at, --every, --trace and --magnify need a result directory, and '{}' is a model", path_));
    }
    loaded_ = load_model(file, build, loading(common_));
    if (!loaded_.model) return;
    const Component* type = loaded_.model->settings.integrator_parameters.component;
    if (!result.integrator.empty() && (type == nullptr || result.integrator != type->description.name)) {
      build.integrator = result.integrator;  // another than that of the file, with its default parameters
      loaded_ = load_model(file, build, loading(common_));
    }
    if (loaded_.model && !result.name.empty()) loaded_.model->name = result.name;
  }

  std::string picture() {
    if (!is_result()) return mechanism_svg(assembled_->system, {assembled_->start.state.q()});
    try {
      ResultPicture drawn = result_picture(path_, assembled_->system, options_.picture);
      drawn.picture.caption += unfinished_words(summary_);
      return mechanism_svg(assembled_->system, drawn.picture);
    } catch (const Error& error) {
      if (options_.picture.any()) throw;
      // Of rows without poses only the start is known.
      MechanismPicture start{assembled_->start.state.q()};
      start.caption = "start: " + error.message();
      return mechanism_svg(assembled_->system, start);
    }
  }

  std::string text() const {
    const Json model = model_json(*loaded_.model, options_.format == "text" ? Quantities::text : Quantities::numbers);
    return options_.format == "json"  ? json_text(model)
           : options_.format == "dot" ? model_graph(model)
                                      : model_tree(model);
  }

  /// What makes the picture again. How it was typed would make the bytes depend on where it goes.
  Json record() const {
    std::vector<std::string> arguments{"--format", "svg"};
    const auto add = [&](const char* option, const std::vector<std::string>& values) {
      for (const std::string& value : values) {
        if (!value.empty()) arguments.insert(arguments.end(), {option, value});
      }
    };
    add("--at", {options_.picture.at});
    add("--every", {options_.picture.every});
    add("--trace", options_.picture.traces);
    add("--magnify", options_.picture.magnify);
    add("--set", options_.build.set);
    add("--ideal", options_.build.ideal);
    const char* command = "freeplay show";
    if (is_result()) return record_of(path_, *ResultReader::open(path_), {"show", command, arguments});
    add("--plugin", common_.plugins);
    return provenance_with_texts(*loaded_.model, {"show", command, arguments, FREEPLAY_BUILD, nullptr});
  }

  ShowOptions options_;
  const CommonOptions& common_;
  const std::string path_;  // as given
  Json summary_;
  LoadedModel loaded_;
  std::unique_ptr<AssembledModel> assembled_;
};

}  // namespace

Command add_show_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "show", "Print or draw a model after everything in it is expanded");
  const auto options = std::make_shared<ShowOptions>();
  add_option(*app, "MODEL", options->model, "Model file, or result directory: the model as it ran");
  add_option(*app, "--format", options->format,
             "text (default), json, dot for Graphviz, svg: a drawing of a model's start, a result's end", "FORMAT");
  add_option(*app, "--at", options->picture.at, "Of a result: draw it at this time, \"10 ms\" (its end)", "T");
  add_option(*app, "--every", options->picture.every,
             "Of a result: pale, where it was before, each so much time or turn of the first driven joint: \"30 deg\"",
             "STEP");
  add_repeatable(*app, "--trace", options->picture.traces, "Of a result: the way of a frame, BODY/FRAME; repeatable",
                 "FRAME");
  add_repeatable(*app, "--magnify", options->picture.magnify,
                 "Of a result: a journal in its clearance, so many times larger: tip=500; repeatable", "JOINT=FACTOR");
  add_file_option(*app, "--out", options->out, "Write into a file instead of stdout", "FILE");
  add_flag(*app, "--force", options->force, "Replace a file that is no picture");
  add_model_options(*app, options->build);
  add_common_options(*app, common);
  return {app, [options, &common] { return Show(*options, common).execute(); }};
}

}  // namespace freeplay
