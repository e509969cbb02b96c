// Merge: the rows of all segments as one table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/row_text.h"
#include "study/segment_reader.h"

namespace freeplay {

/// A column of the table beside those of reducers.
struct KeyColumn {
  std::string name, unit;
  bool words = false;  ///< texts, not numbers
};

struct MergePlan {
  std::uint64_t points = 0;
  RowLayout layout;
  std::vector<KeyColumn> keys;  ///< after `index`
  /// Of the key columns: the one that says how a point of a chain began.
  std::optional<std::size_t> start_cell{};
  /// Cells of the key columns of a point.
  std::function<void(std::uint64_t point, std::vector<std::string>& cells)> cells;
  /// Whether a row belongs to the table; all where empty.
  std::function<bool(const SegmentRow& row)> wanted;
  std::string title;  ///< of study.h5
};

struct MergeCounts {
  std::uint64_t rows = 0, failed = 0;
};

/// Writes study.csv, samples.csv, failures.jsonl, timing.csv and study.h5 of the rows in `segments`, which are in the
/// order of their making, into `folder`. Rows go to buckets by index; memory is flat. Throws Error{input}
/// "study-conflict" where two rows of a point differ, Error{file}.
MergeCounts merge_rows(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& segments,
                       const MergePlan& plan, const SegmentReader::Damage& damage);

}  // namespace freeplay
