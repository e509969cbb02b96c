// StudyTable: the rows of a study's directory, looked through and merged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/engine.h"
#include "study/open_study.h"
#include "study/row_scan.h"

namespace freeplay {

class StudyTable {
 public:
  /// Both outlive it.
  StudyTable(OpenStudy& study, const StudyFolder& folder);

  /// Looks through the segments that may have units of `shard`. Throws Error{input} for rows of another mark.
  void look(const StudyMark& mark, const Shard& shard, const SegmentReader::Damage& damage);

  RowScan& scan() { return scan_; }
  const RowScan& scan() const { return scan_; }
  /// Of the rule for the end of sampling.
  StopWatch watch() { return {rule_ ? &*rule_ : nullptr, study_.plan().samples(), study_.stop_column()}; }
  const std::optional<StopRule>& rule() const { return rule_; }

  /// Points that the table will have, which follow from the rule for the end once that is reached.
  std::uint64_t wanted() const;
  bool is_wanted(std::uint64_t point) const;
  /// Of these, with a row and with a failed row.
  std::uint64_t done() const;
  std::uint64_t failed() const;
  /// The first points without a row.
  std::vector<std::uint64_t> missing(std::size_t most) const;

  MergeCounts merge();

 private:
  bool ended_early() const { return rule_ && rule_->end() && *rule_->end() < study_.plan().samples(); }
  std::uint64_t count(const PointSet& points) const;

  OpenStudy& study_;
  const StudyFolder& folder_;
  RowScan scan_;
  std::optional<StopRule> rule_;
};

}  // namespace freeplay
