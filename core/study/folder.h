// StudyFolder: the directory of a study, its record and its segments.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "study/plan.h"
#include "study/segment_header.h"
#include "workers/outcome.h"

namespace freeplay {

/// What must be the same for rows to stand in one table.
struct StudyMark {
  std::string study;       ///< StudyPlan::identity()
  std::string version;     ///< of the program
  std::string build;       ///< SHA-256 of the program and of every plugin file
  std::string arithmetic;  ///< fingerprint
  std::string columns;     ///< SHA-256 of what the columns of reducers are

  std::string program() const { return version + "/" + build; }
};

class StudyFolder {
 public:
  explicit StudyFolder(std::filesystem::path path) : path_(std::move(path)) {}

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path file() const { return path_ / "study.yaml"; }
  std::filesystem::path rows() const { return path_ / "rows"; }
  /// Rows of an older study that are those of the next one, until that has begun.
  std::filesystem::path extended() const { return path_ / "extended"; }
  std::filesystem::path table() const { return path_ / "study.csv"; }

  bool holds_study() const;
  /// Throws Error{file} "not-empty" where there is something else than a study.
  void require_room() const;
  /// study.json. Throws Error{input} "file-not-found" where there is none.
  Json record() const;
  /// Those of its copies that are not as they were when it began, or are gone.
  std::vector<std::string> changed_copies() const;
  /// That study.json names. Throws Error{input} "file-not-found" where it names none.
  StudyColumns columns() const;

  /// Makes study.json, with copies of all that was read. Of several that do so at once one wins; the others throw
  /// Error{input} "study-changed" where theirs is another study. Takes the rows of extended() that are of this study.
  /// Throws Error{file}.
  void begin(const StudyPlan& plan, const StudyMark& mark, const Json& record) const;
  /// Segments in the order of their making.
  std::vector<std::filesystem::path> segments() const { return segments_in(rows()); }
  std::vector<std::filesystem::path> extending_segments() const { return segments_in(extended()); }
  /// Is the table newer than all rows?
  bool is_merged() const;
  /// Everything that a run has made goes to a new folder in old/, but for extended().
  void set_aside() const;
  /// Nothing of it is of use any more.
  void forget_extended() const;

 private:
  static std::vector<std::filesystem::path> segments_in(const std::filesystem::path& folder);
  void take_extended(const std::string& study) const;
  void make_record(const std::vector<KeptFile>& files, const StudyMark& mark, const Json& record) const;
  void require_begun(const StudyMark& mark) const;

  std::filesystem::path path_;
};

/// The record of a study: what study.json says.
Json study_record(const StudyPlan& plan, const StudyMark& mark, const StudyColumns& columns);

/// Throws Error{input} where a segment is of another study, program or arithmetic than `mark`: "study-mixed",
/// "program-changed", "arithmetic-differs".
void require_same(const SegmentHeader& header, const std::filesystem::path& segment, const StudyMark& mark);

/// The name of this machine as names of files take it.
std::string host_name();
/// Now, as headers of segments say it.
std::string utc_now();

}  // namespace freeplay
