#include "study/row_scan.h"

#include <utility>

namespace freeplay {
namespace {
constexpr std::size_t most_failures_kept = 1000;
}

void RowScan::read(const std::vector<std::filesystem::path>& segments,
                   const std::function<bool(const SegmentReader&)>& accept, const SegmentReader::Damage& damage,
                   const std::function<void(const SegmentRow&)>& each) {
  segments_.insert(segments_.end(), segments.begin(), segments.end());
  for (const std::filesystem::path& segment : segments) {
    SegmentReader reader(segment, damage);
    if (!reader.header() || !accept(reader)) continue;
    while (const SegmentRow* row = reader.next(layout_)) {
      if (row->index >= work_.points()) continue;
      note(row->index, row->good(), row->killed(), row->error, row->state);
      if (each) each(*row);
    }
  }
}

void RowScan::note(std::uint64_t point, const StudyOutcome& outcome) {
  note(point, outcome.exit_code == 0, outcome.error == "killed", outcome.error, outcome.state);
}

void RowScan::note(std::uint64_t point, bool good, bool killed, std::string_view error, std::string_view state) {
  const bool first = done_.insert(point);
  if (good) {
    if (!first && failed_.erase(point)) {
      killed_.erase(point);
      failures_.erase(point);
    }
  } else if (first || failed_.has(point)) {
    failed_.insert(point);
    if (killed) {
      killed_.insert(point);
    } else {
      killed_.erase(point);
    }
    failures_[point] = error;
    if (failures_.size() > most_failures_kept) failures_.erase(std::prev(failures_.end()));
  }
  if (!work_.chained()) return;
  const UnitPlace at = work_.place_of(point);
  const auto known = last_.find(at.unit);
  if (known != last_.end() && known->second.place > at.place) return;
  if (at.place + 1 == work_.unit_size(at.unit)) {
    last_.erase(at.unit);
  } else {
    last_[at.unit] = {at.place, std::string(state)};
  }
}

std::string RowScan::state_before(std::uint64_t unit, std::uint64_t place) const {
  if (place == 0 || !work_.chained()) return {};
  const auto known = last_.find(unit);
  if (known != last_.end() && known->second.place + 1 == place) return known->second.state;
  const std::uint64_t before = work_.unit_point(unit, place - 1);
  std::string state;
  for (const std::filesystem::path& segment : segments_) {
    SegmentReader reader(segment, [](const std::filesystem::path&, std::size_t) {});
    while (const SegmentRow* row = reader.next(layout_)) {
      if (row->index == before && row->good()) state = row->state;
    }
  }
  return state;
}

std::vector<std::pair<std::uint64_t, std::string>> RowScan::first_failures(std::size_t most) const {
  std::vector<std::pair<std::uint64_t, std::string>> first;
  for (auto at = failures_.begin(); at != failures_.end() && first.size() < most; ++at) first.push_back(*at);
  return first;
}

}  // namespace freeplay
