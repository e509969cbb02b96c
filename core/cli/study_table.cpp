#include "cli/study_table.h"

#include <charconv>
#include <limits>
#include <string_view>

namespace freeplay {
namespace {

/// Number of a column among the values of a row.
double value_at(std::string_view values, std::size_t column) {
  for (; column > 0; --column) {
    const std::size_t tab = values.find('\t');
    if (tab == values.npos) return std::numeric_limits<double>::quiet_NaN();
    values.remove_prefix(tab + 1);
  }
  values = values.substr(0, values.find('\t'));
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(values.data(), values.data() + values.size(), value);
  return value;
}

}  // namespace

StudyTable::StudyTable(OpenStudy& study, const StudyFolder& folder)
    : study_(study), folder_(folder), scan_(study.work(), study.layout()), rule_(study.stop_rule()) {}

void StudyTable::look(const StudyMark& mark, const Shard& shard, const SegmentReader::Damage& damage) {
  scan_.read(
      folder_.segments(),
      [&](const SegmentReader& reader) {
        require_same(*reader.header(), reader.path(), mark);
        return reader.header()->shard.meets(shard);
      },
      damage);
  if (!rule_) return;
  const StopWatch stop = watch();
  scan_.each_that_counts([&](const SegmentRow& row) {
    if (row.good()) stop.note(row.index, value_at(row.values, stop.column));
  });
  if (scan_.failed().count() == 0) return;
  for (std::uint64_t point = 0; point < study_.plan().points(); ++point) {
    if (scan_.failed().has(point)) stop.note(point, std::numeric_limits<double>::quiet_NaN());
  }
}

std::uint64_t StudyTable::wanted() const {
  const StudyPlan& plan = study_.plan();
  return ended_early() ? plan.points() / plan.samples() * *rule_->end() : plan.points();
}

bool StudyTable::is_wanted(std::uint64_t point) const {
  return !ended_early() || point % study_.plan().samples() < *rule_->end();
}

std::uint64_t StudyTable::count(const PointSet& points) const {
  if (!ended_early()) return points.count();
  std::uint64_t found = 0;
  for (std::uint64_t point = 0; point < study_.plan().points(); ++point) {
    if (is_wanted(point) && points.has(point)) ++found;
  }
  return found;
}

std::uint64_t StudyTable::done() const { return count(scan_.done()); }
std::uint64_t StudyTable::failed() const { return count(scan_.failed()); }

std::vector<std::uint64_t> StudyTable::missing(std::size_t most) const {
  std::vector<std::uint64_t> points;
  for (std::uint64_t point = 0; point < study_.plan().points() && points.size() < most; ++point) {
    if (is_wanted(point) && !scan_.done().has(point)) points.push_back(point);
  }
  return points;
}

MergeCounts StudyTable::merge() {
  MergePlan plan = study_.merge_plan();
  if (ended_early() || study_.plan().chained()) {
    plan.wanted = [this](const SegmentRow& row) { return is_wanted(row.index) && scan_.counts(row); };
  }
  return merge_rows(folder_.path(), folder_.segments(), plan, [](const std::filesystem::path&, std::size_t) {});
}

}  // namespace freeplay
