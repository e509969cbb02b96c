// OldRows: what a study has computed, for another one whose points are partly the same.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <unordered_map>
#include <vector>

#include "study/plan.h"
#include "study/row_text.h"
#include "study/segment_reader.h"
#include "study/segment_writer.h"

namespace freeplay {

class OldRows {
 public:
  /// Reads the segments, whose rows have the columns of `layout`.
  OldRows(const std::vector<std::filesystem::path>& segments, const RowLayout& layout,
          const SegmentReader::Damage& damage);

  /// Points that have a row.
  std::uint64_t count() const { return rows_.size(); }
  /// Those of them that are points of `plan`, too.
  std::uint64_t kept(const StudyPlan& plan) const;
  /// Writes their rows as rows of `plan`.
  void write(const StudyPlan& plan, SegmentWriter& segment) const;

 private:
  template <class Take>
  void each(const StudyPlan& plan, Take&& take) const;

  RowLayout layout_;
  struct Row {
    std::uint64_t origin;
    StudyOutcome outcome;
  };
  std::unordered_map<std::string, std::vector<Row>> rows_;  // by hash; of a chain one for each origin
};

}  // namespace freeplay
