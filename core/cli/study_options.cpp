#include "cli/study_options.h"

#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "cli/failure.h"
#include "cli/loading.h"
#include "cli/terminal.h"
#include "results/directory.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

/// Lines of `set` of the command line.
TargetTexts set_of(const StudyOptions& options) {
  TargetTexts set = build_options(options.model).set;
  const auto add = [&](const char* target, const std::string& text) {
    if (!text.empty()) set.emplace_back(target, text);
  };
  if (!options.step.empty() && !options.accuracy.empty()) {
    throw Error(Error::Category::usage, "usage", "--step and --accuracy exclude each other");
  }
  add("simulation.end", options.end);
  add("simulation.step", options.step);
  add("simulation.accuracy", options.accuracy);
  add("simulation.integrator", options.integrator);
  if (!options.model.ideal.empty()) add("ideal", fmt::format("[{}]", fmt::join(options.model.ideal, ", ")));
  return set;
}

bool is_folder(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

StudyInFolder open_study(const std::string& given, StudyPlanOptions options, const StudyFolder& folder,
                         const std::string& out, const CommonOptions& common) {
  Diagnostics diagnostics(common.strict);
  options.load = loading(common);
  StudyInFolder opened{nullptr, folder, options.kept};
  opened.study = OpenStudy::open(given, options, diagnostics);
  if (!opened.study) {
    opened.exit_code = report_failure(diagnostics, 3, common);
    return opened;
  }
  print_messages(diagnostics.format(common.max_errors), common.no_color);
  if (!options.kept) {
    opened.folder =
        StudyFolder(out.empty() ? fs::path("results") / (result_name(opened.study->plan().name(), false) + "-study")
                                : fs::path(out));
  }
  return opened;
}

void require_as_begun(const StudyInFolder& opened) {
  if (!opened.study || opened.folder.record()["study"] == opened.study->plan().identity()) return;
  throw Error(Error::Category::input, "study-changed", edited_text(opened.folder), {},
              fmt::format("put back what it was; to change the study edit its own file, and "
                          "freeplay study run FILE --out {} --extend keeps the points that stay",
                          opened.folder.path().string()));
}

}  // namespace

std::string edited_text(const StudyFolder& folder) {
  const std::vector<std::string> copies = folder.changed_copies();
  return fmt::format(
      "the study of '{}' is not the one that it was begun with: {}", folder.path().string(),
      copies.empty() ? "a copy in it was edited" : fmt::format("its copy {} was edited", fmt::join(copies, ", ")));
}

StudyInFolder open_in_folder(const std::string& given, const StudyOptions& options, const CommonOptions& common) {
  StudyPlanOptions plan;
  plan.set = set_of(options);
  plan.many_points = options.yes;
  if (!is_folder(given)) return open_study(given, plan, StudyFolder({}), options.out, common);
  if (!plan.set.empty() || !options.out.empty()) {
    throw Error(Error::Category::usage, "usage",
                fmt::format("'{}' is the directory of a study, which has its model and its place already", given), {},
                "--out, --set and the like are for a file");
  }
  const StudyFolder folder(given);
  folder.record();
  plan.kept = true;
  plan.many_points = true;  // as it was begun
  return open_study(folder.file().string(), plan, folder, "", common);
}

StudyInFolder open_kept(const std::string& given, StudyUse use, const CommonOptions& common, bool edited) {
  const StudyFolder folder(given);
  folder.record();
  StudyPlanOptions plan;
  plan.kept = plan.many_points = true;
  plan.look = use == StudyUse::look;
  StudyInFolder opened = open_study(folder.file().string(), plan, folder, "", common);
  if (!edited) require_as_begun(opened);
  return opened;
}

const std::string& only_study(const StudyOptions& options, const char* command, const char* kind) {
  if (options.studies.empty()) {
    throw Error(Error::Category::usage, "missing-argument", fmt::format("study {} needs a {}", command, kind));
  }
  if (options.studies.size() > 1) {
    throw Error(Error::Category::usage, "unexpected-argument",
                fmt::format("unexpected argument '{}'", options.studies[1]));
  }
  return options.studies.front();
}

Shard shard_of(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto part = std::from_chars(text.data(), end, shard.part);
  const bool divided = part.ec == std::errc() && part.ptr != end && *part.ptr == '/';
  const auto parts = divided ? std::from_chars(part.ptr + 1, end, shard.parts) : part;
  const bool read = divided && parts.ec == std::errc() && parts.ptr == end;
  if (!read || shard.part < 1 || shard.part > shard.parts) {
    const std::string here = read && shard.parts > 0 ? fmt::format("here from 1 to {}", shard.parts) : "such as 2/8";
    bad_value("--shard", text, "it must be I/N with I from 1 to N, " + here);
  }
  return shard;
}

SegmentReader::Damage warn_of_damage(const CommonOptions& common) {
  return [no_color = common.no_color](const fs::path& segment, std::size_t line) {
    print_messages(fmt::format("{}:{}: warning: this line is damaged; its point runs again [rows-damaged]\n",
                               segment.string(), line),
                   no_color);
  };
}

StudyMark kept_mark(const StudyFolder& folder) {
  const Json record = folder.record();
  const auto text = [](const Json& object, const char* key) { return object.value(key, std::string()); };
  return {text(record, "study"), text(record["program"], "version"), text(record["program"], "build"),
          text(record, "arithmetic"), text(record, "rows")};
}

}  // namespace freeplay
