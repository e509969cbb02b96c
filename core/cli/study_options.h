// StudyOptions: the command line of `freeplay study`.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.h"
#include "study/open_study.h"
#include "study/schedule.h"

namespace freeplay {

/// As typed; a command has those of its own.
struct StudyOptions {
  std::vector<std::string> studies;  ///< FILE or DIR
  std::string out, index;
  ModelOptions model;
  std::string end, step, accuracy, integrator;
  std::optional<std::string> only;
  std::string jobs, shard, keep, point_timeout, sync;
  bool retry_failed = false, allow_failed = false, isolate = false, extend = false, restart = false, yes = false;
  bool partial = false, list_points = false, watch = false, run_point = false, force = false;
  std::string probe, points, seed;
  std::string engine, minutes, tasks, cores, time, hosts, max_array;
  std::string kind, x, y, value, by;
};

/// A study with its directory, which may not be there yet.
struct StudyInFolder {
  std::unique_ptr<OpenStudy> study;
  StudyFolder folder;
  bool kept;          ///< it was opened by its directory
  int exit_code = 0;  ///< where there is no study: it was reported why
};

/// Opens FILE or DIR. Reports its mistakes.
StudyInFolder open_in_folder(const std::string& given, const StudyOptions& options, const CommonOptions& common);
/// What a command does with the directory of a study.
enum class StudyUse { look, run_points };
/// The same for a command that takes a DIR alone. Who only looks at it needs no plugins of its models. Throws
/// Error{input} "study-changed" where a copy in it was edited, unless `edited` ones are welcome.
StudyInFolder open_kept(const std::string& given, StudyUse use, const CommonOptions& common, bool edited = false);
/// What was edited in the directory of a study that its rows are not of.
std::string edited_text(const StudyFolder& folder);

/// The only one that is named. Throws Error{usage} "missing-argument".
const std::string& only_study(const StudyOptions& options, const char* command, const char* kind);

/// "I/N". Throws Error{usage} "bad-value".
Shard shard_of(const std::string& text);
/// Warns of a damaged row.
SegmentReader::Damage warn_of_damage(const CommonOptions& common);
/// The mark of the rows that a study's directory holds.
StudyMark kept_mark(const StudyFolder& folder);

}  // namespace freeplay
