#include "study/row_scan.h"

#include <utility>

namespace freeplay {
namespace {
constexpr std::size_t most_failures_kept = 1000;
}

void RowScan::read(const std::vector<std::filesystem::path>& segments,
                   const std::function<bool(const SegmentReader&)>& accept, const SegmentReader::Damage& damage) {
  segments_.insert(segments_.end(), segments.begin(), segments.end());
  for (const std::filesystem::path& segment : segments) {
    SegmentReader reader(segment, damage);
    if (!reader.header() || !accept(reader)) continue;
    while (const SegmentRow* row = reader.next(layout_)) {
      if (row->index >= work_.points()) continue;
      note(row->index, row->origin, {row->good(), row->killed(), std::string(row->error)}, row->state);
    }
  }
}

void RowScan::note(std::uint64_t point, const StudyOutcome& outcome) {
  const std::uint64_t origin = running_origin(point);
  const bool good = outcome.exit_code == 0;
  if (work_.chained()) {
    const UnitPlace at = work_.place_of(point);
    running_[at.unit] = {at.place + 1, good ? origin : at.place + 1};
  }
  note(point, origin, {good, outcome.error == "killed", outcome.error}, outcome.state);
}

std::uint64_t RowScan::running_origin(std::uint64_t point) const {
  if (!work_.chained()) return 0;
  const UnitPlace at = work_.place_of(point);
  const auto running = running_.find(at.unit);
  return running != running_.end() && running->second.place == at.place ? running->second.origin
                                                                        : origin_at(at.unit, at.place);
}

void RowScan::note(std::uint64_t point, std::uint64_t origin, const Fact& fact, std::string_view state) {
  if (!work_.chained()) return count(point, fact);
  const UnitPlace at = work_.place_of(point);
  learn(point, origin, fact);
  settle(at.unit, at.place);
  if (length(at.unit) != at.place + 1 || origin_at(at.unit, at.place) != origin) return;
  if (at.place + 1 == work_.unit_size(at.unit)) {
    last_.erase(at.unit);
  } else {
    last_[at.unit] = {at.place, fact.good ? origin : at.place + 1, std::string(state)};
  }
}

void RowScan::count(std::uint64_t point, const Fact& fact) {
  const bool first = done_.insert(point);
  if (fact.good) {
    if (!first && failed_.erase(point)) {
      killed_.erase(point);
      failures_.erase(point);
    }
  } else if (first || failed_.has(point)) {
    failed_.insert(point);
    if (fact.killed) {
      killed_.insert(point);
    } else {
      killed_.erase(point);
    }
    failures_[point] = fact.error;
    if (failures_.size() > most_failures_kept) failures_.erase(std::prev(failures_.end()));
  }
}

void RowScan::forget(std::uint64_t point) {
  done_.erase(point);
  failed_.erase(point);
  killed_.erase(point);
  failures_.erase(point);
}

void RowScan::learn(std::uint64_t point, std::uint64_t origin, const Fact& fact) {
  if (fact.good && origin == 0) {
    unbroken_.insert(point);
    return;
  }
  const auto [place, added] = others_.try_emplace({point, origin}, fact);
  if (!added && !place->second.good) place->second = fact;
}

const RowScan::Fact* RowScan::known(std::uint64_t point, std::uint64_t origin) const {
  static const Fact good{true, false, {}};
  if (origin == 0 && unbroken_.has(point)) return &good;
  const auto found = others_.find({point, origin});
  return found == others_.end() ? nullptr : &found->second;
}

/// How many places of a chain are done, all of them at its beginning.
std::uint64_t RowScan::length(std::uint64_t unit) const {
  std::uint64_t low = 0, high = work_.unit_size(unit);
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (done_.has(work_.unit_point(unit, middle))) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

std::uint64_t RowScan::origin_at(std::uint64_t unit, std::uint64_t place) const {
  const auto after = cold_again_.upper_bound({unit, place});
  return after != cold_again_.begin() && std::prev(after)->first == unit ? std::prev(after)->second : 0;
}

std::uint64_t RowScan::origin(std::uint64_t point) const {
  if (!work_.chained()) return 0;
  const UnitPlace at = work_.place_of(point);
  return origin_at(at.unit, at.place);
}

/// There is news of the row at `place`: what follows from it.
void RowScan::settle(std::uint64_t unit, std::uint64_t place) {
  std::uint64_t end = length(unit);
  if (place > end) return;
  if (place < end) {
    const std::uint64_t point = work_.unit_point(unit, place);
    const Fact& fact = *known(point, origin_at(unit, place));
    if (!fact.good || !failed_.has(point)) return count(point, fact);
    while (end > place) forget(work_.unit_point(unit, --end));
    cold_again_.erase(cold_again_.upper_bound({unit, place}), cold_again_.lower_bound({unit + 1, 0}));
  }
  for (; end < work_.unit_size(unit); ++end) {
    const std::uint64_t point = work_.unit_point(unit, end);
    const Fact* fact = known(point, origin_at(unit, end));
    if (fact == nullptr) return;
    count(point, *fact);
    if (!fact->good) cold_again_.insert({unit, end + 1});
  }
}

bool RowScan::counts(const SegmentRow& row) const {
  return row.index < work_.points() && done_.has(row.index) && row.origin == origin(row.index);
}

void RowScan::each_that_counts(const std::function<void(const SegmentRow&)>& each) const {
  for (const std::filesystem::path& segment : segments_) {
    SegmentReader reader(segment, [](const std::filesystem::path&, std::size_t) {});
    while (const SegmentRow* row = reader.next(layout_)) {
      if (counts(*row)) each(*row);
    }
  }
}

std::string RowScan::state_before(std::uint64_t unit, std::uint64_t place) const {
  if (!work_.chained() || origin_at(unit, place) == place) return {};
  const auto known = last_.find(unit);
  if (known != last_.end() && known->second.place + 1 == place && known->second.next_origin == origin_at(unit, place)) {
    return known->second.state;
  }
  const std::uint64_t before = work_.unit_point(unit, place - 1);
  std::string state;
  each_that_counts([&](const SegmentRow& row) {
    if (row.index == before && row.good()) state = row.state;
  });
  return state;
}

std::vector<std::pair<std::uint64_t, std::string>> RowScan::first_failures(std::size_t most) const {
  std::vector<std::pair<std::uint64_t, std::string>> first;
  for (auto at = failures_.begin(); at != failures_.end() && first.size() < most; ++at) first.push_back(*at);
  return first;
}

}  // namespace freeplay
