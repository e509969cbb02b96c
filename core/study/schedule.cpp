#include "study/schedule.h"

#include <algorithm>
#include <charconv>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"

namespace freeplay {
namespace {

constexpr std::uint64_t most_listed_units = 1'000'000;

bool take_index(std::string_view& text, std::uint64_t& index) {
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (fault != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

}  // namespace

PointRanges point_ranges(const std::string& option, const std::string& text, std::uint64_t points) {
  const auto fail = [&](const std::string& why) {
    throw Error(Error::Category::usage, "bad-value", fmt::format("bad value '{}' of {}: {}", text, option, why));
  };
  PointRanges ranges;
  std::string_view rest = text;
  do {
    std::uint64_t first = 0, last = 0;
    if (!take_index(rest, first)) fail("it must list numbers of points, such as 0-9,12");
    last = first;
    if (rest.starts_with('-')) {
      rest.remove_prefix(1);
      if (!take_index(rest, last)) fail("it must list numbers of points, such as 0-9,12");
    }
    if (last < first) fail(fmt::format("{} stands after {}", last, first));
    if (last >= points) fail(fmt::format("the points of this study are 0 to {}", points - 1));
    ranges.emplace_back(first, last);
    if (!rest.empty() && !rest.starts_with(',')) fail("it must list numbers of points, such as 0-9,12");
    if (!rest.empty()) rest.remove_prefix(1);
  } while (!rest.empty());
  std::ranges::sort(ranges);
  PointRanges apart;
  for (const auto& range : ranges) {
    if (!apart.empty() && range.first <= apart.back().second + 1) {
      apart.back().second = std::max(apart.back().second, range.second);
    } else {
      apart.push_back(range);
    }
  }
  return apart;
}

bool holds(const PointRanges& ranges, std::uint64_t point) {
  const auto after = std::ranges::upper_bound(ranges, point, {}, [](const auto& range) { return range.first; });
  return after != ranges.begin() && point <= std::prev(after)->second;
}

Schedule::Schedule(const StudyWork& work, const RowScan& scan, ScheduleOptions options)
    : work_(work), scan_(scan), options_(std::move(options)), next_unit_(options_.shard.part - 1) {
  const Shard& shard = options_.shard;
  if (!work.chained()) {
    points_ = work.units() / shard.parts + (work.units() % shard.parts >= shard.part ? 1 : 0);
  } else {
    for (std::uint64_t unit = shard.part - 1; unit < work.units(); unit += shard.parts) points_ += work.unit_size(unit);
  }
  if (!options_.only) return;
  std::uint64_t named = 0;
  for (const auto& [first, last] : *options_.only) named += last - first + 1;
  if (named > most_listed_units) return;
  units_.emplace();
  for (const auto& [first, last] : *options_.only) {
    for (std::uint64_t point = first; point <= last; ++point) {
      const std::uint64_t unit = work.place_of(point).unit;
      if (shard.has(unit)) units_->push_back(unit);
    }
  }
  std::ranges::sort(*units_);
  units_->erase(std::unique(units_->begin(), units_->end()), units_->end());
}

bool Schedule::named(std::uint64_t point) const { return !options_.only || holds(*options_.only, point); }

bool Schedule::open(std::uint64_t point) const {
  return !scan_.done().has(point) || scan_.killed().has(point) || (options_.retry_failed && scan_.failed().has(point));
}

/// A chain is run up to the last point of it that was asked for.
bool Schedule::begin_unit() {
  if (units_) {
    if (next_listed_ == units_->size()) return false;
    unit_ = (*units_)[next_listed_++];
  } else {
    if (next_unit_ >= work_.units()) return false;
    unit_ = next_unit_;
    next_unit_ += options_.shard.parts;
  }
  place_ = 0;
  unit_end_ = work_.unit_size(unit_);
  while (unit_end_ > 0 && !named(work_.unit_point(unit_, unit_end_ - 1))) --unit_end_;
  return true;
}

bool Schedule::next(StudyTask& task) {
  for (;;) {
    while (place_ < unit_end_ && !open(work_.unit_point(unit_, place_))) ++place_;
    if (place_ < unit_end_) break;
    if (!begin_unit()) return false;
  }
  // Where one point of a chain ends otherwise than before, all that follow begin otherwise.
  task = {unit_, place_, unit_end_, scan_.state_before(unit_, place_)};
  place_ = task.end;
  return true;
}

}  // namespace freeplay
