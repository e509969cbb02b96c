#include "study/merge.h"

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "base/error.h"
#include "study/row_sorter.h"
#include "study/table_writer.h"

namespace freeplay {
namespace {

/// Names of the columns in which two good rows of one point differ.
std::vector<std::string> differing_columns(const SortedRow& a, const SortedRow& b, const RowLayout& layout) {
  std::vector<std::string> names;
  if (a.hash != b.hash) names.emplace_back("hash");
  if (a.start != b.start) names.emplace_back("start");
  std::string_view left = a.values, right = b.values;
  for (const StudyColumn& column : layout.columns) {
    const std::size_t left_end = std::min(left.find('\t'), left.size()),
                      right_end = std::min(right.find('\t'), right.size());
    if (left.substr(0, left_end) != right.substr(0, right_end)) names.push_back(column.name);
    left.remove_prefix(std::min(left_end + 1, left.size()));
    right.remove_prefix(std::min(right_end + 1, right.size()));
  }
  for (std::size_t i = 0; i < layout.samples.size(); ++i) {
    if (a.samples[i] != b.samples[i]) names.push_back("values of " + layout.samples[i]);
  }
  return names;
}

[[noreturn]] void refuse_conflict(const SortedRow& a, const SortedRow& b, const std::vector<std::string>& columns,
                                  const std::vector<std::filesystem::path>& segments) {
  throw Error(
      Error::Category::input, "study-conflict",
      fmt::format("rows of point {} differ in {}: {} and {}", a.index, fmt::join(columns, ", "),
                  segments[a.segment].filename().string(), segments[b.segment].filename().string()),
      {segments[b.segment].string(), 0, 0},
      fmt::format("one machine computes wrongly, or a row was changed: freeplay study verify finds out which, and "
                  "without that segment the point runs again"));
}

/// The row that counts: a good one, of which all must agree, else the latest.
const SortedRow& row_that_counts(const std::vector<SortedRow>& rows, const RowLayout& layout,
                                 const std::vector<std::filesystem::path>& segments) {
  const SortedRow* good = nullptr;
  for (const SortedRow& row : rows) {
    if (!row.good()) continue;
    if (good != nullptr) {
      const std::vector<std::string> columns = differing_columns(*good, row, layout);
      if (!columns.empty()) refuse_conflict(*good, row, columns, segments);
    } else {
      good = &row;
    }
  }
  return good != nullptr ? *good : rows.back();
}

/// One program at a time writes the tables of a folder. A file system without locks has none.
class OnlyWriter {
 public:
  explicit OnlyWriter(const std::filesystem::path& folder)
      : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    while (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
    }
  }
  ~OnlyWriter() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OnlyWriter(const OnlyWriter&) = delete;
  OnlyWriter& operator=(const OnlyWriter&) = delete;

 private:
  int descriptor_;
};

}  // namespace

MergeCounts merge_rows(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& segments,
                       const MergePlan& plan, const SegmentReader::Damage& damage) {
  std::uint64_t bytes = 0;
  for (const std::filesystem::path& segment : segments) {
    std::error_code ignored;
    const auto size = std::filesystem::file_size(segment, ignored);
    if (!ignored) bytes += size;
  }
  RowSorter sorter(folder, plan.points, bytes);
  std::vector<std::string> hosts(segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    SegmentReader reader(segments[i], damage);
    if (!reader.header()) continue;
    hosts[i] = reader.header()->host;
    while (const SegmentRow* row = reader.next(plan.layout)) {
      if (row->index < plan.points && (!plan.wanted || plan.wanted(*row))) {
        sorter.put(*row, static_cast<std::uint32_t>(i));
      }
    }
  }
  const OnlyWriter alone(folder);
  TableWriter table(folder, plan);
  MergeCounts counts;
  sorter.visit([&](const std::vector<SortedRow>& rows) {
    const SortedRow& row = row_that_counts(rows, plan.layout, segments);
    table.put(row, hosts[row.segment]);
    ++counts.rows;
    if (!row.good()) ++counts.failed;
  });
  table.close();
  return counts;
}

}  // namespace freeplay
