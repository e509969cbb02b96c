#include <filesystem>

#include <fmt/format.h>

#include "base/shell_word.h"
#include "cli/loading.h"
#include "cli/own_program.h"
#include "cli/study_views.h"
#include "cli/terminal.h"
#include "load/plugins.h"
#include "study/plan.h"
#include "study/point_words.h"

namespace freeplay {

namespace fs = std::filesystem;

int study_point(const StudyOptions& options, const CommonOptions& common) {
  if (options.studies.size() != 2) {
    throw Error(Error::Category::usage, options.studies.size() < 2 ? "missing-argument" : "unexpected-argument",
                "study point needs a DIR and the number of a point");
  }
  const StudyInFolder opened = open_kept(options.studies[0], StudyUse::look, common);
  if (!opened.study) return opened.exit_code;
  const StudyPlan& plan = opened.study->plan();
  const std::string& index = options.studies[1];
  if (index.find_first_not_of("0123456789") != std::string::npos)
    bad_value("INDEX", index, "it must be the number of one point, such as 12");
  const PointRanges ranges = point_ranges("INDEX", index, plan.points());
  const StudyPoint point = plan.point(ranges[0].first);
  const fs::path folder = fs::absolute(opened.folder.path()).lexically_normal();
  std::vector<std::string> words = point_words(plan, folder, point, common.plugins);
  if (common.allow_plugins) words.emplace_back("--allow-plugins");
  // In a chain the point goes on from the end of that before it, which no command of a single run knows.
  const UnitPlace place = plan.place_of(point.index);
  const bool goes_on = plan.chained() && place.place > 0;
  if (goes_on) {
    print_messages(
        fmt::format("freeplay: warning: point {} goes on from the end of point {} (`warm_start`), the command "
                    "of a single run starts anew: its figures are others\n"
                    "      = freeplay study run DIR --only {} computes the row of the study\n",
                    point.index, plan.unit_point(place.unit, place.place - 1), point.index),
        common.no_color);
  }
  if (options.run_point) {
    // Who types the command trusts what it names.
    for (const std::string& copy : plugins_from_copies(plan, folder, point, common.plugins)) {
      require_plugin_allowed(copy, loading(common));
    }
    if (!options.out.empty()) words.insert(words.end(), {"--out", options.out});
    if (common.quiet) words.emplace_back("--quiet");
    if (common.json) words.emplace_back("--json");
    const ProgramEnd end = run_own_program(words, true);
    print_data(end.printed);
    return end.exit_code;
  }
  std::string command = "freeplay";
  for (const std::string& word : words) command += " " + shell_word(word);
  if (common.json) {
    Json set = Json::object();
    for (const StudySetting& setting : point.settings) set[setting.target] = setting.text;
    Json before = nullptr;
    if (goes_on) before = plan.unit_point(place.unit, place.place - 1);
    print_json(
        {{"index", point.index}, {"hash", point.hash}, {"command", command}, {"set", set}, {"goes_on_from", before}});
  } else {
    print_data(command + "\n");
  }
  return 0;
}

}  // namespace freeplay
