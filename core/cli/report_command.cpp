#include "cli/report_command.h"

#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "base/whole_file.h"
#include "cli/loading.h"
#include "cli/output_file.h"
#include "cli/study_options.h"
#include "cli/terminal.h"
#include "report/report.h"
#include "study/page.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  std::vector<std::string> results, channels, pictures;
  std::string out, from, until, title;
  bool force = false;
};

/// What makes the same page of the same results.
std::vector<std::string> arguments_of(const ReportOptions& options) {
  std::vector<std::string> arguments;
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) arguments.insert(arguments.end(), {option, value});
  };
  for (const std::string& pattern : options.channels) add("--channels", pattern);
  add("--from", options.from);
  add("--until", options.until);
  add("--title", options.title);
  return arguments;
}

/// A folder as the page `file` sees it; empty in it.
fs::path seen_from(const fs::path& file, const fs::path& folder) {
  const fs::path seen =
      fs::weakly_canonical(folder).lexically_relative(fs::weakly_canonical(fs::absolute(file).parent_path()));
  return seen == "." ? fs::path() : seen;
}

/// Of a study's directory: its pictures and its table.
int report_study(const std::string& folder, const ReportOptions& options, const CommonOptions& common) {
  const StudyInFolder opened = open_kept(folder, StudyUse::look, common);
  if (!opened.study) return opened.exit_code;
  const std::string file = options.out.empty() ? (opened.folder.path() / "report.html").string() : options.out;
  require_no_other_file(file, own_page, options.force);
  const std::string page = study_page(*opened.study, folder, seen_from(file, folder));
  write_whole_file(file, page);
  if (common.json) {
    print_json(Json{{"file", file}, {"bytes", page.size()}});
  } else if (!common.quiet) {
    print(fmt::format("report in {} ({} bytes)\n", printable(file), page.size()));
  }
  return 0;
}

int report(const ReportOptions& options, const CommonOptions& common) {
  if (options.results.size() == 1 && StudyFolder(options.results.front()).holds_study()) {
    return report_study(options.results.front(), options, common);
  }
  ReportRequest request;
  request.results = options.results;
  request.out = options.out;
  request.channels = options.channels;
  request.pictures = options.pictures;
  if (!options.from.empty()) request.window.from = signed_quantity("--from", options.from, dimension::time);
  if (!options.until.empty()) request.window.until = signed_quantity("--until", options.until, dimension::time);
  if (request.window.from > request.window.until) {
    throw Error(Error::Category::usage, "bad-value",
                fmt::format("--from {} is after --until {}", options.from, options.until));
  }
  request.title = options.title;
  request.force = options.force;
  request.arguments = arguments_of(options);
  request.build = FREEPLAY_BUILD;
  request.load = loading(common);
  const ReportMade made = write_report(request);
  if (common.json) {
    print_json(Json{{"file", made.file}, {"bytes", made.bytes}, {"runs", made.runs}, {"left_out", made.left_out}});
  } else if (!common.quiet) {
    print(fmt::format("report in {} ({} bytes)\n", printable(made.file), made.bytes));
  }
  return 0;
}

}  // namespace

Command add_report_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "report", "Write results as one HTML page: motion, orbits, plots, tables");
  const auto options = std::make_shared<ReportOptions>();
  add_arguments(*app, "RESULT", options->results,
                "Result directories, results.csv or results.h5; several are compared");
  add_file_option(*app, "--out", options->out, "File (report.html in the first result)", "FILE");
  add_repeatable(*app, "--channels", options->channels, "Channels to show, a name or pattern with *; repeatable",
                 "PATTERN");
  add_option(*app, "--from", options->from, "First time: \"10 ms\"", "T");
  add_option(*app, "--until", options->until, "Last time", "T");
  add_repeatable(*app, "--picture", options->pictures,
                 "SVG of analyze, plot or show that is to be on the page, too; repeatable", "FILE");
  add_option(*app, "--title", options->title, "Title of the page (names of the runs)", "TEXT");
  add_flag(*app, "--force", options->force, "Replace a file that is no report");
  add_common_options(*app, common);
  return {app, [options, &common] { return report(*options, common); }};
}

}  // namespace freeplay
