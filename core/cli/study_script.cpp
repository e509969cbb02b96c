#include <filesystem>

#include <fmt/format.h>

#include "base/error.h"
#include "base/option_value.h"
#include "cli/study_probe.h"
#include "cli/study_table.h"
#include "cli/study_views.h"
#include "cli/terminal.h"
#include "study/job_scripts.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr double longest_script_probe = 60.0;  // [s]

JobEngine engine_of(const std::string& word) {
  const std::vector<std::string> words = {"slurm", "gnu-parallel", "snakemake"};
  if (word.empty()) {
    throw Error(Error::Category::usage, "missing-argument", "study script needs --engine", {},
                fmt::format("--engine {}", fmt::join(words, "|")));
  }
  require_word("--engine", word, words);
  return word == "slurm" ? JobEngine::slurm : word == "snakemake" ? JobEngine::snakemake : JobEngine::gnu_parallel;
}

fs::path whole_path(const std::string& path) { return fs::absolute(path).lexically_normal(); }

/// What has --plugin is a file or a name; files are found from any folder.
std::vector<std::string> plugin_words(const CommonOptions& common) {
  std::vector<std::string> words;
  for (const std::string& plugin : common.plugins) {
    std::error_code ignored;
    words.insert(words.end(), {"--plugin", fs::exists(plugin, ignored) ? whole_path(plugin).string() : plugin});
  }
  if (common.allow_plugins) words.emplace_back("--allow-plugins");
  return words;
}

JobRequest request_of(const StudyOptions& options, const CommonOptions& common) {
  constexpr long most_minutes = 60, least_minutes = 10;
  JobRequest request;
  request.engine = engine_of(options.engine);
  request.program = fs::read_symlink("/proc/self/exe");
  request.options = plugin_words(common);
  if (!options.minutes.empty()) {
    const long minutes = whole_number("--minutes", options.minutes, 1);
    if (minutes < least_minutes || minutes > most_minutes) {
      bad_value("--minutes", options.minutes, fmt::format("it must be from {} to {}", least_minutes, most_minutes));
    }
    request.minutes = static_cast<double>(minutes);
  }
  if (!options.tasks.empty()) request.tasks = static_cast<std::uint64_t>(whole_number("--tasks", options.tasks, 1));
  if (!options.cores.empty()) request.cores = static_cast<int>(whole_number("--cores", options.cores, 1));
  if (!options.max_array.empty()) {
    request.max_array = static_cast<std::uint64_t>(whole_number("--max-array", options.max_array, 1));
  }
  request.time = options.time;
  if (options.hosts.empty()) return request;
  request.hosts = whole_path(options.hosts);
  std::error_code ignored;
  if (!fs::is_regular_file(request.hosts, ignored)) bad_value("--hosts", options.hosts, "there is no such file");
  return request;
}

}  // namespace

int study_script(const StudyOptions& options, const CommonOptions& common) {
  constexpr long usual_probe = 32;
  JobRequest request = request_of(options, common);
  plan_jobs(request);  // refuses what no study can make good
  StudyInFolder opened = open_in_folder(only_study(options, "script", "FILE or DIR"), options, common);
  if (!opened.study) return opened.exit_code;
  OpenStudy& study = *opened.study;
  const StudyMark mark = study.mark();
  opened.folder.require_room();
  if (opened.folder.holds_study() && opened.folder.record()["study"] != mark.study) {
    throw Error(Error::Category::input, "study-changed",
                opened.kept ? edited_text(opened.folder)
                            : fmt::format("the study is not the one of '{}'", opened.folder.path().string()),
                {}, "freeplay study run FILE --extend or --restart, or another --out");
  }
  opened.folder.begin(study.plan(), mark, study_record(study.plan(), mark, study.columns()));
  StudyTable table(study, opened.folder);
  table.look(mark, {}, warn_of_damage(common));
  request.folder = whole_path(opened.folder.path().string());
  request.name = study.plan().name();
  request.points_left = table.wanted() - std::min(table.wanted(), table.done());
  const long probe = options.probe.empty() ? usual_probe : whole_number("--probe", options.probe, 1);
  const auto seconds = probe_points(study, static_cast<std::uint64_t>(probe), longest_script_probe);
  if (!seconds) {
    throw Error(Error::Category::numerical, "timeout", fmt::format("no point ended within {} s", longest_script_probe));
  }
  request.seconds_per_point = seconds->mean;
  const JobPlan plan = plan_jobs(request);
  const JobScripts scripts = write_job_scripts(request, plan);
  Json files = Json::array();
  for (const fs::path& file : scripts.files) files.push_back(file.string());
  if (common.json) {
    print_json({{"command", scripts.command},
                {"tasks", plan.tasks},
                {"points", request.points_left},
                {"seconds_per_point", request.seconds_per_point},
                {"minutes", plan.minutes},
                {"files", files}});
    return 0;
  }
  if (!common.quiet) {
    print(fmt::format("{}: {} points of {:.3g} s in {} tasks of {:.3g} minutes\n", request.name, request.points_left,
                      request.seconds_per_point, plan.tasks, plan.minutes));
  }
  print_data(scripts.command + "\n");
  return 0;
}

}  // namespace freeplay
