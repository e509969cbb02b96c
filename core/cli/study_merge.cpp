#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "cli/study_table.h"
#include "cli/study_views.h"
#include "cli/terminal.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

void require_one_study(const std::vector<std::string>& folders) {
  const Json first = StudyFolder(folders.front()).record();
  for (const std::string& folder : folders) {
    const Json record = StudyFolder(folder).record();
    if (record["study"] == first["study"] && record["rows"] == first["rows"]) continue;
    throw Error(Error::Category::input, "study-mixed",
                fmt::format("'{}' is study '{}' {}, '{}' is study '{}' {}", folders.front(), first.value("name", ""),
                            first["study"].get<std::string>().substr(0, 12), folder, record.value("name", ""),
                            record["study"].get<std::string>().substr(0, 12)),
                {}, "rows of one study are merged");
  }
}

bool begins_with(const fs::path& longer, const fs::path& part) {
  std::ifstream all(longer, std::ios::binary), some(part, std::ios::binary);
  using Bytes = std::istreambuf_iterator<char>;
  return all && some && std::mismatch(Bytes(some), Bytes(), Bytes(all), Bytes()).first == Bytes();
}

/// Segments only grow: of two of one name the longer one is kept if it goes on where the other ends. If it does not,
/// they are of different processes, and the second gets another name: rows that contradict each other are found then.
void copy_segment(const fs::path& segment, const StudyFolder& to) {
  fs::path place = to.rows() / segment.filename();
  for (int again = 2; fs::exists(place); ++again) {
    if (begins_with(place, segment)) return;
    if (begins_with(segment, place)) break;
    place = to.rows() / fmt::format("{}-{}.rows", segment.stem().string(), again);
  }
  std::error_code error;
  fs::copy_file(segment, place, fs::copy_options::overwrite_existing, error);
  if (!error) return;
  throw Error(Error::Category::file, "cannot-write",
              fmt::format("cannot copy '{}' to '{}': {}", segment.string(), place.string(), error.message()));
}

void copy_segments(const StudyFolder& from, const StudyFolder& to) {
  for (const fs::path& segment : from.segments()) copy_segment(segment, to);
}

void refuse_gaps(const StudyTable& table, const StudyFolder& folder) {
  constexpr std::size_t listed = 3;
  const std::uint64_t missing = table.wanted() - table.done();
  throw Error(Error::Category::input, "study-gaps",
              fmt::format("{} of {} points are missing (first {})", missing, table.wanted(),
                          fmt::join(table.missing(listed), ", ")),
              {},
              fmt::format("freeplay study run {} computes them, --partial merges those that are there",
                          folder.path().string()));
}

}  // namespace

int study_merge(const StudyOptions& options, const CommonOptions& common) {
  if (options.studies.empty()) {
    throw Error(Error::Category::usage, "missing-argument", "study merge needs a DIR");
  }
  require_one_study(options.studies);
  StudyInFolder opened = open_kept(options.studies.front(), StudyUse::look, common);
  if (!opened.study) return opened.exit_code;
  const StudyMark mark = kept_mark(opened.folder);
  if (!options.out.empty()) {
    opened.folder = StudyFolder(options.out);
    opened.folder.require_room();
    opened.folder.begin(opened.study->plan(), mark, study_record(opened.study->plan(), mark, opened.study->columns()));
  }
  for (const std::string& folder : options.studies) {
    for (const fs::path& segment : StudyFolder(folder).segments()) {
      SegmentReader reader(segment, [](const fs::path&, std::size_t) {});
      if (reader.header()) require_same(*reader.header(), segment, mark);
    }
  }
  for (const std::string& folder : options.studies) copy_segments(StudyFolder(folder), opened.folder);
  StudyTable table(*opened.study, opened.folder);
  table.look(mark, {}, warn_of_damage(common));
  if (table.done() < table.wanted() && !options.partial) refuse_gaps(table, opened.folder);
  const MergeCounts counts = table.merge();
  if (common.json) {
    print_json({{"table", opened.folder.table().string()}, {"rows", counts.rows}, {"failed", counts.failed}});
  } else if (!common.quiet) {
    print(fmt::format("{}: {} rows, {} failed\n", opened.folder.table().string(), counts.rows, counts.failed));
  }
  return 0;
}

}  // namespace freeplay
