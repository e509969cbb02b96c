#include "study/job_scripts.h"

#include <algorithm>
#include <cmath>
#include <regex>

#include <fmt/format.h>

#include "base/error.h"
#include "base/json_text.h"
#include "base/shell_word.h"
#include "base/whole_file.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr double longest_task = 60.0;  // of a task that is made longer so that there are fewer [min]

std::string clock_time(double minutes) {
  const auto whole = static_cast<std::uint64_t>(minutes);
  return fmt::format("{:02}:{:02}:00", whole / 60, whole % 60);
}

// Three times what a task takes, for slow machines and the points that take longest; whole five minutes, ten at least.
std::string usual_limit(double minutes) { return clock_time(std::max(10.0, std::ceil(3.0 * minutes / 5.0) * 5.0)); }

std::string checked_time(const std::string& time) {
  static const std::regex form(R"(\d{1,4}:[0-5]\d:[0-5]\d)");
  if (!std::regex_match(time, form))
    throw Error(Error::Category::usage, "bad-value", fmt::format("--time '{}' is no time", time), {},
                "hours, minutes and seconds: 01:30:00");
  return time;
}

/// Words that scripts are made of.
struct Words {
  explicit Words(const JobRequest& request)
      : program(shell_word(request.program.string())),
        folder(shell_word(request.folder.string())),
        jobs(request.folder / "jobs") {
    for (const std::string& word : request.options) options += " " + shell_word(word);
  }

  std::string in_jobs(const std::string& name) const { return shell_word((jobs / name).string()); }
  /// Runs the shard `part`, a word of the shell.
  std::string shard(const std::string& part, std::uint64_t tasks, const std::string& cores) const {
    return fmt::format("{} study run {} --shard {}/{} --jobs {} --allow-failed --quiet{}", program, folder, part, tasks,
                       cores, options);
  }
  std::string merge() const { return fmt::format("{} study merge {}{}", program, folder, options); }
  std::string status() const { return fmt::format("{} study status {}{}", program, folder, options); }

  std::string program, folder, options;
  fs::path jobs;
};

constexpr const char* shell = "#!/bin/bash\n";

class Writer {
 public:
  explicit Writer(const JobRequest& request) : words_(request) {}

  const Words& words() const { return words_; }
  void put(const std::string& name, const std::string& text) {
    write_whole_file(words_.jobs / name, text);
    made_.files.push_back(words_.jobs / name);
  }
  JobScripts finish(std::string command) {
    made_.command = std::move(command);
    return std::move(made_);
  }

 private:
  Words words_;
  JobScripts made_;
};

/// Slurm fills in what stands after a percent sign in a name of a log.
fs::path slurm_pattern(const fs::path& folder) {
  std::string doubled;
  for (const char c : folder.string()) doubled += c == '%' ? "%%" : std::string(1, c);
  return doubled;
}

/// GNU parallel fills in {}, {1}, {/.} and others wherever they stand, and nothing turns that off.
void refuse_replaced(const std::string& path) {
  static const std::regex form(R"(\{[-+\d.#%/]*\})");
  if (!std::regex_search(path, form)) return;
  throw Error(Error::Category::usage, "bad-value",
              fmt::format("GNU parallel would put the number of a task into the braces of '{}'", path), {},
              "another --out");
}

// %A and %a in the name of the log are the numbers of array and task. `exec`: the signal before the limit reaches the
// program, which ends with all rows written; --requeue starts it again, where it goes on.
JobScripts slurm(const JobRequest& request, const JobPlan& plan) {
  Writer writer(request);
  const Words& words = writer.words();
  std::string log = (slurm_pattern(words.jobs) / "%A_%a.log").string(), name = request.name;
  std::ranges::replace_if(
      name, [](unsigned char c) { return !std::isalnum(c) && c != '-' && c != '_' && c != '.'; }, '-');
  writer.put(
      "array.sh",
      fmt::format("{}#SBATCH --job-name={}\n#SBATCH --array=1-{}\n#SBATCH --ntasks=1\n#SBATCH --cpus-per-task={}\n"
                  "#SBATCH --time={}\n#SBATCH --requeue\n#SBATCH --signal=B:TERM@120\n#SBATCH --open-mode=append\n"
                  "#SBATCH --output={}\nexec {}\n",
                  shell, name, plan.tasks, request.cores, plan.time, shell_word(log),
                  words.shard("\"$SLURM_ARRAY_TASK_ID\"", plan.tasks, "\"$SLURM_CPUS_PER_TASK\"")));
  writer.put("merge.sh", fmt::format("{}#SBATCH --job-name={}-merge\n#SBATCH --ntasks=1\n#SBATCH --time={}\n"
                                     "#SBATCH --open-mode=append\n#SBATCH --output={}\nexec {}\n",
                                     shell, name, plan.time,
                                     shell_word((slurm_pattern(words.jobs) / "merge.log").string()), words.merge()));
  writer.put("submit.sh", fmt::format("{}set -eu\narray=$(sbatch --parsable {})\n"
                                      "sbatch --dependency=afterany:\"${{array%%;*}}\" {}\n"
                                      "echo \"array ${{array%%;*}} of {} tasks; what is done:\" {}\n",
                                      shell, words.in_jobs("array.sh"), words.in_jobs("merge.sh"), plan.tasks,
                                      shell_word(words.status())));
  return writer.finish("bash " + words.in_jobs("submit.sh"));
}

JobScripts gnu_parallel(const JobRequest& request, const JobPlan& plan) {
  Writer writer(request);
  const Words& words = writer.words();
  refuse_replaced(words.folder);
  refuse_replaced(words.program);
  // Each job gets its processors; on hosts of a list parallel counts them there.
  const std::string where =
      request.hosts.empty() ? std::string() : fmt::format(" --sshloginfile {}", shell_word(request.hosts.string()));
  const std::string at_once = fmt::format("$(( (share = $(nproc) / {}) > 0 ? share : 1 ))", request.cores);
  writer.put(
      "run.sh",
      fmt::format("{}set -u\nparallel --halt never{} --jobs {} {} ::: $(seq 1 {})\nexec {}\n", shell, where, at_once,
                  shell_word(words.shard("{}", plan.tasks, std::to_string(request.cores))), plan.tasks, words.merge()));
  return writer.finish("bash " + words.in_jobs("run.sh"));
}

// A shard has no file of its own that would say that it is done, so each leaves a mark. JSON's strings are Python's.
// Names of files are patterns there, in which braces of a folder would be wildcards: they are given from the folder.
JobScripts snakemake(const JobRequest& request, const JobPlan& plan) {
  Writer writer(request);
  const Words& words = writer.words();
  const auto text = [](const std::string& value) { return Json(value).dump(); };
  const auto braces = [](const std::string& value) {  // Snakemake fills in what stands in braces
    std::string doubled;
    for (const char c : value) doubled += c == '{' || c == '}' ? std::string(2, c) : std::string(1, c);
    return doubled;
  };
  const std::string shard =
      fmt::format("{} study run {} --shard {{wildcards.part}}/{} --jobs {{threads}} --allow-failed --quiet{}",
                  braces(words.program), braces(words.folder), plan.tasks, braces(words.options));
  writer.put(
      "Snakefile",
      fmt::format("workdir: {}\n\nrule merge:\n    input: expand(\"jobs/shard-{{part}}.done\", part=range(1, {} + 1))\n"
                  "    output: \"study.csv\"\n    shell: {}\n\n"
                  "rule shard:\n    output: touch(\"jobs/shard-{{part}}.done\")\n    threads: {}\n    shell: {}\n",
                  text(request.folder.string()), plan.tasks, text(braces(words.merge())), request.cores, text(shard)));
  return writer.finish(fmt::format("snakemake -s {} --cores {} --forceall", words.in_jobs("Snakefile"), request.cores));
}

}  // namespace

JobPlan plan_jobs(const JobRequest& request) {
  JobPlan plan;
  const double work = static_cast<double>(request.points_left) * request.seconds_per_point / 60.0 / request.cores;
  const auto number = [&](double minutes) {
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(std::min(work / minutes, 1e15))));
  };
  plan.tasks = request.tasks ? *request.tasks : number(request.minutes);
  if (request.tasks && request.engine == JobEngine::slurm && plan.tasks > request.max_array) {
    throw Error(Error::Category::usage, "too-large",
                fmt::format("--tasks {} is more than --max-array {}", plan.tasks, request.max_array), {},
                "a larger --max-array where Slurm's MaxArraySize is larger");
  }
  if (!request.tasks && plan.tasks > request.max_array) {
    if (number(longest_task) > request.max_array) {
      const double cores = std::ceil(work * request.cores / (longest_task * static_cast<double>(request.max_array)));
      throw Error(
          Error::Category::usage, "too-large",
          fmt::format("{} tasks of an hour are more than --max-array {}", number(longest_task), request.max_array), {},
          fmt::format("--cores {:.0f} would do", cores));
    }
    plan.tasks = request.max_array;
  }
  plan.minutes = work / static_cast<double>(plan.tasks);
  plan.time = request.time.empty() ? usual_limit(plan.minutes) : checked_time(request.time);
  return plan;
}

JobScripts write_job_scripts(const JobRequest& request, const JobPlan& plan) {
  switch (request.engine) {
    case JobEngine::slurm:
      return slurm(request, plan);
    case JobEngine::gnu_parallel:
      return gnu_parallel(request, plan);
    case JobEngine::snakemake:
      break;
  }
  return snakemake(request, plan);
}

}  // namespace freeplay
