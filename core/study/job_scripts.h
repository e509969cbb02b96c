// JobScripts: what starts the shards of a study on engines that exist.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace freeplay {

enum class JobEngine { slurm, gnu_parallel, snakemake };

struct JobRequest {
  JobEngine engine = JobEngine::slurm;
  std::filesystem::path program, folder;  ///< of the command and of the study, absolute
  std::string name;                       ///< of the study
  std::uint64_t points_left = 0;
  double seconds_per_point = 0.0;
  double minutes = 30.0;  ///< that a task shall take
  std::optional<std::uint64_t> tasks = std::nullopt;
  int cores = 1;                  ///< of a task
  std::string time{};             ///< limit of a task, HH:MM:SS; empty: by what it takes
  std::filesystem::path hosts{};  ///< of GNU parallel, absolute; empty: this machine alone
  std::uint64_t max_array = 1000;
  std::vector<std::string> options{};  ///< that every command needs to load the models
};

struct JobPlan {
  std::uint64_t tasks = 1;
  double minutes = 0.0;  ///< that a task takes
  std::string time{};    ///< limit of a task, HH:MM:SS
};

/// Tasks by the points that are left and the time of one. A task may take an hour before there are more tasks than
/// `max_array`. Throws Error{usage} "bad-value" for a time that is none, "too-large" with what would do.
JobPlan plan_jobs(const JobRequest& request);

struct JobScripts {
  std::string command;                       ///< to type, and again after a loss
  std::vector<std::filesystem::path> files;  ///< that were written
};

/// Writes into `folder`/jobs. Success of a task is judged by the rows it left, not by its engine. Throws Error{file}.
JobScripts write_job_scripts(const JobRequest& request, const JobPlan& plan);

}  // namespace freeplay
