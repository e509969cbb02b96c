#include "cli/plot_command.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "base/error.h"
#include "base/input_text.h"
#include "cli/loading.h"
#include "cli/output_file.h"
#include "cli/terminal.h"
#include "load/load.h"
#include "load/result_model.h"
#include "plot/channel_figure.h"
#include "results/made_text.h"
#include "results/result_record.h"
#include "results/whole_result.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr double px_per_metre = 96.0 / 0.0254, least_px = 200.0, most_px = 10000.0;
constexpr double usual_width = 900.0, usual_height = 240.0, plane_part = 0.75;  // of the width: height of an orbit
constexpr int most_columns = 100;

struct PlotOptions {
  std::string path, from, until, over, orbit, polar, width, height, out;
  std::vector<std::string> channels, against;
  bool xy = false, spectrum = false, histogram = false, text = false, force = false;
};

/// Pixels, or a length on paper: "84 mm".
struct Extent {
  double px = 0.0;
  bool is_length = false;
};

Extent extent(const std::string& option, const std::string& text, double usual) {
  if (text.empty()) return {usual, false};
  Extent extent;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), extent.px);
  if (fault != std::errc() || end != text.data() + text.size()) {
    extent = {positive_quantity(option, text, dimension::length) * px_per_metre, true};
  }
  if (extent.px >= least_px && extent.px <= most_px) return extent;
  bad_value(option, text, fmt::format("a picture has {:g} to {:g} pixels, 96 to an inch", least_px, most_px));
}

[[noreturn]] void refuse(const std::string& why, const std::string& hint = {}) {
  throw Error(Error::Category::usage, "bad-value", why, {}, hint);
}

plot::View view_of(const PlotOptions& options) {
  using plot::View;
  struct Choice {
    bool chosen;
    const char* option;
    View view;
  };
  const Choice choices[] = {{options.xy, "--xy", View::orbit},
                            {!options.over.empty(), "--x", View::over},
                            {!options.orbit.empty(), "--orbit", View::orbit},
                            {!options.polar.empty(), "--polar", View::polar},
                            {options.spectrum, "--fft", View::spectrum},
                            {options.histogram, "--histogram", View::histogram}};
  const Choice* found = nullptr;
  for (const Choice& choice : choices) {
    if (!choice.chosen) continue;
    if (found != nullptr) refuse(fmt::format("{} and {} exclude each other", found->option, choice.option));
    found = &choice;
  }
  return found == nullptr ? View::time : found->view;
}

/// What makes the same picture of the same results.
std::vector<std::string> arguments_of(const PlotOptions& options) {
  std::vector<std::string> arguments = options.channels;
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) arguments.insert(arguments.end(), {option, value});
  };
  const auto flag = [&](const char* option, bool given) {
    if (given) arguments.emplace_back(option);
  };
  flag("--xy", options.xy);
  add("--x", options.over);
  add("--orbit", options.orbit);
  add("--polar", options.polar);
  flag("--fft", options.spectrum);
  flag("--histogram", options.histogram);
  add("--from", options.from);
  add("--until", options.until);
  add("--width", options.width);
  add("--height", options.height);
  return arguments;
}

fs::path folder_of(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored) ? fs::path(path) : fs::path(path).parent_path();
}

Json summary_beside(const std::string& path) { return read_summary(folder_of(path)); }

/// A dimension of a joint with play [m]; 0 where the result does not say, or it has none.
double dimension_of(const Json& summary, const std::string& joint, const char* name) {
  const Json one = summary.is_object()
                       ? summary.value(Json::json_pointer("/joints"), Json::object()).value(joint, Json::object())
                       : Json::object();
  const Json clearance = one.value("clearance", Json(nullptr));
  if (!clearance.is_object() || !clearance.value(name, Json(nullptr)).is_number()) return 0.0;
  return clearance[name];
}

std::string name_of_result(const std::string& path, const Json& summary) {
  const std::string folder = fs::path(folder_of(path)).lexically_normal().filename().string();
  if (!summary.is_object() || !summary.contains("model") || !summary["model"].is_object()) return folder;
  return summary["model"].value("name", folder);
}

/// What the legend calls results: by their models, and where that tells none apart by what was set, or their numbers.
std::vector<std::string> legend_names(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  std::vector<Json> summaries;
  for (const std::string& path : paths) {
    const Json& summary = summaries.emplace_back(summary_beside(path));
    std::string name = name_of_result(path, summary);
    const bool ideal =
        summary.is_object() && !summary.value(Json::json_pointer("/settings/ideal"), Json::array()).empty();
    if (ideal) name += ", ideal";
    names.push_back(std::move(name));
  }
  const auto differ = [&] { return std::set<std::string>(names.begin(), names.end()).size() == names.size(); };
  if (differ()) return names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!summaries[i].is_object()) continue;
    const Json set = summaries[i].value(Json::json_pointer("/settings/set"), Json::object());
    for (const auto& [name, value] : set.items())
      names[i] += fmt::format(", {} = {}", name, value.is_string() ? value.get<std::string>() : value.dump());
  }
  if (differ()) return names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = fmt::format("{}. {}", i + 1, names[i]);
  return names;
}

class Plot {
 public:
  Plot(PlotOptions options, const CommonOptions& common) : options_(std::move(options)), common_(common) {
    if (options_.path.empty()) throw Error(Error::Category::usage, "missing-argument", "plot needs a result");
    request_.view = view_of(options_);
    size_of_page();
    set_window();
    require_no_other_file(options_.out, own_picture, options_.force);
    open_results();
    set_channels();
  }

  int execute() {
    const bool as_text = options_.text || (options_.out.empty() && stdout_is_terminal());
    const int columns = std::min(stdout_columns(), most_columns);
    if (as_text) request_.across = 2.0 * columns;
    const std::vector<std::string> names = legend_names(paths_);
    std::vector<plot::Source> sources;
    for (std::size_t i = 0; i < readers_.size(); ++i) sources.push_back({names[i], readers_[i].get()});
    plot::Figure figure = plot::channel_figure(sources, request_);
    figure.title = name_of_result(options_.path, summary_) + unfinished_words(summary_);
    if (common_.json) {
      print_json(extremes(figure));
      if (options_.out.empty()) return 0;
    }
    if (as_text && options_.out.empty()) {
      print_data(plot::figure_text(figure, columns, stdout_takes_unicode()));
      return 0;
    }
    write_output(options_.out, picture_with_record(figure_svg(figure, size_), record(paths_)));
    return 0;
  }

 private:
  /// How it was typed would make the bytes depend on where the picture goes. Of several results each has its own.
  Json record(const std::vector<std::string>& paths) {
    const MadeOfResult made{"plot", "freeplay plot", arguments_of(options_)};
    Json record = record_of(paths[0], *readers_[0], made);
    if (paths.size() < 2 || !record.is_object()) return record;
    record["results"] = paths;
    for (std::size_t i = 0; i < paths.size(); ++i) record["runs"].push_back(record_of(paths[i], *readers_[i], made));
    return record;
  }

  void size_of_page() {
    if (options_.text && (!options_.out.empty() || !options_.width.empty() || !options_.height.empty())) {
      refuse("--text goes to the terminal and has no --out, --width or --height");
    }
    const bool plane = request_.view == plot::View::orbit || request_.view == plot::View::polar;
    const Extent width = extent("--width", options_.width, usual_width);
    const Extent height = extent("--height", options_.height, plane ? plane_part * width.px : usual_height);
    size_ = {width.px, height.px, width.is_length};
    request_.across = plot::line_room(size_);
    request_.down = size_.panel_height - 60.0;
  }

  void set_window() {
    RowWindow& window = request_.window;
    if (!options_.from.empty()) window.from = signed_quantity("--from", options_.from, dimension::time);
    if (!options_.until.empty()) window.until = signed_quantity("--until", options_.until, dimension::time);
    if (window.from > window.until) refuse(fmt::format("--from {} is after --until {}", options_.from, options_.until));
  }

  void set_channels() {
    summary_ = summary_beside(options_.path);
    std::error_code ignored;
    const fs::path folder = folder_of(options_.path);
    if (!summary_.is_object() && fs::exists(folder / "run.log", ignored)) {
      summary_ = summary_of_unfinished(folder, *readers_[0]);
    }
    request_.over = options_.over;
    request_.channels = options_.channels;
    if (request_.view == plot::View::polar) {
      request_.joint = options_.polar;
      if (!options_.from.empty() || !options_.until.empty()) {
        refuse("tables by bearing sector are of the whole time that counts: --polar has no --from or --until");
      }
      if (common_.json) refuse("--polar has no --json", "export --table bearing --to json has the numbers");
      if (request_.channels.empty()) request_.channels = {"impulse", "work"};
      return;
    }
    if (request_.view == plot::View::spectrum && common_.json) {
      refuse("--fft has no --json", "export --table spectra --to json has the numbers");
    }
    if (!options_.orbit.empty()) {
      if (!request_.channels.empty()) refuse("--orbit JOINT has its channels: name no others");
      request_.joint = options_.orbit;
      require_journal(options_.orbit);
      for (const char* channel : {"ex", "ey", "ez"}) {
        const std::string name = fmt::format("joint.{}.{}", options_.orbit, channel);
        const bool there = readers_[0]->find(name) < readers_[0]->layout().columns.size();
        // A pin in space lies along z of its bearing.
        const bool along = channel[1] == 'z' && dimension_of(summary_, options_.orbit, "length") > 0.0;
        if (there && !along) request_.channels.push_back(name);
      }
      for (const std::string& path : paths_) request_.clearances.push_back(clearance_of(path));
    }
    if (!request_.channels.empty()) return;
    throw Error(Error::Category::usage, "missing-argument", "plot needs a channel, such as 'joint.*.fn'", {},
                fmt::format("'{}' has {} channels: {} ...", readers_[0]->file(), readers_[0]->layout().columns.size(),
                            some_channels()));
  }

  void open_results() {
    std::set<fs::path> seen;
    paths_.push_back(options_.path);
    paths_.insert(paths_.end(), options_.against.begin(), options_.against.end());
    for (const std::string& path : paths_) {
      readers_.push_back(ResultReader::open(path));
      if (const std::string missing = visibly_missing(*readers_.back()); !missing.empty())
        print_messages("freeplay: warning: " + missing + "\n", common_.no_color);
      if (!seen.insert(whole_result(path)).second) {
        print_messages(fmt::format("freeplay: warning: '{}' is given twice\n", path), common_.no_color);
      }
      // A file of text has no units.
      const auto has_no_unit = [](const RecordColumn& column) { return column.unit.empty(); };
      if (!std::ranges::any_of(readers_.back()->layout().columns, has_no_unit)) continue;
      if (const auto model = model_beside(folder_of(path), summary_beside(path), loading(common_))) {
        readers_.back()->know_units(*model);
      }
    }
  }

  /// A joint whose journal has a place in its bearing.
  void require_journal(const std::string& joint) const {
    std::vector<std::string> journals;
    for (const RecordColumn& column : readers_[0]->layout().columns) {
      if (column.name.starts_with("joint.") && column.name.ends_with(".ex")) {
        journals.push_back(column.name.substr(6, column.name.size() - 9));
      }
    }
    require_word("joint with play", joint, journals);
  }

  /// Radial clearance of the joint [m] as the summary has it or, where the run goes on or was killed, the model beside
  /// the rows; 0, with a note, where neither does.
  double clearance_of(const std::string& path) const {
    const Json summary = path == options_.path ? summary_ : summary_beside(path);
    if (const double known = dimension_of(summary, options_.orbit, "radial_clearance"); known > 0.0) return known;
    if (const auto model = model_beside(folder_of(path), summary, loading(common_))) {
      const auto joint = std::ranges::find(model->joints, options_.orbit, &JointElement::name);
      if (joint != model->joints.end() && joint->layout.clearance > 0.0) return joint->layout.clearance;
    }
    print_messages(fmt::format("freeplay: note: no model or summary beside '{}' says how large the clearance is: no "
                               "circle\n",
                               path),
                   common_.no_color);
    return 0.0;
  }

  std::string some_channels() const {
    std::string names;
    const std::vector<RecordColumn>& columns = readers_[0]->layout().columns;
    for (std::size_t i = 1; i < std::min(columns.size(), std::size_t{6}); ++i) {
      names += (i == 1 ? "" : ", ") + columns[i].name;
    }
    return names;
  }

  Json extremes(const plot::Figure& figure) const {
    Json channels = Json::array();
    for (const plot::Panel& panel : figure.panels) {
      for (std::size_t i = 0; i < panel.lines.size(); ++i) {
        const plot::Extremes& seen = panel.lines[i].seen;
        Json one = {{"name", panel.channel},
                    {"unit", panel.channel_unit},
                    {"rows", panel.lines[i].rows},
                    {"min", seen.any() ? Json(seen.least) : Json(nullptr)},
                    {"min_time", seen.any() ? Json(seen.least_at) : Json(nullptr)},
                    {"max", seen.any() ? Json(seen.most) : Json(nullptr)},
                    {"max_time", seen.any() ? Json(seen.most_at) : Json(nullptr)}};
        if (panel.lines.size() > 1) one["result"] = figure.names[i];
        channels.push_back(std::move(one));
      }
    }
    return {{"channels", std::move(channels)}};
  }

  PlotOptions options_;
  const CommonOptions& common_;
  plot::FigureRequest request_;
  plot::PageSize size_;
  std::vector<std::string> paths_;  // of the result and those that it is drawn against
  std::vector<std::unique_ptr<ResultReader>> readers_;
  Json summary_;
};

}  // namespace

Command add_plot_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "plot", "Draw channels of a result, as SVG or on the terminal");
  const auto options = std::make_shared<PlotOptions>();
  add_option(*app, "RESULT", options->path, "Result directory, results.csv or results.h5");
  add_arguments(*app, "CHANNELS", options->channels, "Channels, names or patterns with *: a panel each");
  add_option(*app, "--from", options->from, "First time: \"10 ms\"", "T");
  add_option(*app, "--until", options->until, "Last time", "T");
  add_option(*app, "--x", options->over, "Draw over another channel in place of time", "CHANNEL");
  add_flag(*app, "--xy", options->xy, "Draw the second of two channels over the first, with equal scales");
  add_option(*app, "--orbit", options->orbit, "Path of a journal in its clearance circle", "JOINT");
  add_option(*app, "--polar", options->polar,
             "Tables by bearing sector around a joint; CHANNELS are impulse, work, sliding, contact_time, pv_mean or "
             "pv_max",
             "JOINT");
  add_flag(*app, "--fft", options->spectrum, "Amplitudes over frequency");
  add_flag(*app, "--histogram", options->histogram, "Parts of the time over values");
  add_repeatable(*app, "--against", options->against, "The same channels of another result; repeatable", "RESULT");
  add_option(*app, "--width", options->width, "Width in pixels, or on paper: \"84 mm\" (900)", "SIZE");
  add_option(*app, "--height", options->height, "Height of a panel in the same way (240)", "SIZE");
  add_flag(*app, "--text", options->text, "Draw with characters, as on a terminal");
  add_file_option(*app, "--out", options->out, "SVG file (stdout, where it is no terminal)", "FILE");
  add_flag(*app, "--force", options->force, "Replace a file that is no picture");
  add_common_options(*app, common);
  return {app, [options, &common] { return Plot(*options, common).execute(); }};
}

}  // namespace freeplay
