#include "study/old_rows.h"

#include <algorithm>

#include "study/row_outcome.h"

namespace freeplay {
OldRows::OldRows(const std::vector<std::filesystem::path>& segments, const RowLayout& layout,
                 const SegmentReader::Damage& damage)
    : layout_(layout) {
  for (const std::filesystem::path& segment : segments) {
    SegmentReader reader(segment, damage);
    if (!reader.header()) continue;
    while (const SegmentRow* row = reader.next(layout_)) {
      std::vector<Row>& rows = rows_[std::string(row->hash)];
      const auto known = std::ranges::find(rows, row->origin, &Row::origin);
      if (known == rows.end()) {
        rows.push_back({row->origin, outcome_of(*row, layout_)});
      } else if (known->outcome.exit_code != 0) {
        known->outcome = outcome_of(*row, layout_);
      }
    }
  }
}

template <class Take>
void OldRows::each(const StudyPlan& plan, Take&& take) const {
  if (rows_.empty()) return;
  // In the order of units, which hashes of chains follow.
  for (std::uint64_t unit = 0; unit < plan.units(); ++unit) {
    for (std::uint64_t place = 0; place < plan.unit_size(unit); ++place) {
      const std::uint64_t point = plan.unit_point(unit, place);
      const std::string hash = plan.hash(point);
      if (const auto found = rows_.find(hash); found != rows_.end()) take(point, hash, found->second);
    }
  }
}

std::uint64_t OldRows::kept(const StudyPlan& plan) const {
  std::uint64_t count = 0;
  each(plan, [&](std::uint64_t, const std::string&, const std::vector<Row>&) { ++count; });
  return count;
}

void OldRows::write(const StudyPlan& plan, SegmentWriter& segment) const {
  std::string lines;
  each(plan, [&](std::uint64_t point, const std::string& hash, const std::vector<Row>& rows) {
    lines.clear();
    for (const Row& row : rows) append_point(lines, point, hash, row.outcome, layout_, row.origin);
    segment.put(lines);
  });
  segment.close();
}

}  // namespace freeplay
