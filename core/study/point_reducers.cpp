#include "study/point_reducers.h"

#include <algorithm>
#include <cmath>

#include "results/summary.h"
#include "study/summary_numbers.h"

namespace freeplay {
namespace {
constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
constexpr double same_instant = 1e-12;  // of the instant, or of a second
}  // namespace

bool PointReducers::Window::holds(double t) const {
  const auto rounding = [](double limit) { return same_instant * std::max(1.0, std::abs(limit)); };
  return t >= from - rounding(from) && !(t > until + rounding(until));
}

double PointReducers::Course::at(std::span<const double> row) const {
  return formula ? formula->value(row[0], row) : row[static_cast<std::size_t>(channel)];
}

void PointReducers::step(std::span<const double> row) {
  const double t = row[0];
  for (Timed& timed : timed_) {
    if (timed.window.holds(t)) timed.reduced.add_at(t, timed.course.at(row));
  }
}

void PointReducers::inside(std::span<const double> row) {
  for (Timed& timed : timed_) {
    if (timed.window.holds(row[0])) timed.reduced.add_inside(timed.course.at(row));
  }
}

void PointReducers::instant(std::span<const double> row) {
  const double due = next_;
  for (Section& section : sections_) {
    if (!(section.next <= due)) continue;
    take_sample(section, row);
    section.turns += 1.0;
    section.next = section.begin + section.turns * section.every;
  }
  renew_next();
}

void PointReducers::passed(std::size_t which, std::span<const double> row) {
  const Section& section = sections_[passing_[which]];
  if (section.window.holds(row[0])) take_sample(section, row);
}

void PointReducers::take_sample(const Section& section, std::span<const double> row) {
  samples_[section.list].emplace_back(row[0], section.course.at(row));
}

void PointReducers::renew_next() {
  next_ = std::numeric_limits<double>::infinity();
  for (const Section& section : sections_) {
    if (section.window.holds(section.next)) next_ = std::min(next_, section.next);
  }
}

void PointReducers::take_event(std::span<const double> numbers) {
  const auto joint = static_cast<std::size_t>(numbers[1]);
  for (OfEvents& of : of_events_) {
    if (of.joints[joint] == 0 || numbers[2] != of.kind || !of.window.holds(numbers[0])) continue;
    const double value = of.field < 0 ? 0.0 : numbers[static_cast<std::size_t>(of.field)];
    if (std::isnan(value) || !(value > of.above)) continue;
    of.reduced.add(value);
  }
}

void PointReducers::fill_sets(const Statistics& statistics) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].source != ReducerEntry::Source::set) continue;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& joint = model_.joints[static_cast<std::size_t>(j)];
      if (!has_contact_statistics(channels_.joints[static_cast<std::size_t>(j)]) || !statistics.any()) continue;
      const JointStatistics seen = statistics.joint(j);
      for (const ClearanceNumber& number : clearance_numbers()) {
        const int column = columns_.find(entries_[i].name + "." + joint.name + "." + number.name);
        if (column >= 0) values_[static_cast<std::size_t>(column)] = number.of(seen);
      }
    }
  }
}

void PointReducers::fill_summaries(const Json& summary) {
  const SummaryNumbers numbers(summary);
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].source == ReducerEntry::Source::summary)
      values_[columns_.first(i)] = numbers.number(entries_[i].text(), entries_[i].over);
  }
}

void PointReducers::fill_others() {
  for (double& value : values_) {
    if (!std::isfinite(value)) value = no_value;
  }
  for (const OfOthers& of : of_others_) values_[of.column] = of.formula.value(0.0, values_);
}

void PointReducers::finish(const Statistics& statistics, const std::function<Json()>& summary) {
  if (events_) events_->finish();
  for (Timed& timed : timed_) values_[timed.column] = timed.reduced.result();
  for (const Section& section : sections_) values_[section.column] = static_cast<double>(samples_[section.list].size());
  for (OfEvents& of : of_events_) values_[of.column] = of.reduced.result();
  fill_sets(statistics);
  if (needs_summary_) fill_summaries(summary());
  fill_others();
}

void PointReducers::finish(const AnalysisTable& table) {
  for (OfColumn& of : of_columns_) {
    const auto place =
        static_cast<std::size_t>(std::ranges::find(table.columns, of.entry->text()) - table.columns.begin());
    if (place == table.columns.size()) {
      of.entry->subject.fail("unknown-name", "the analysis has no column '" + of.entry->text() + "'",
                             nearest(of.entry->text(), table.columns));
      continue;
    }
    for (const std::vector<AnalysisCell>& row : table.rows) {
      const double* const value = std::get_if<double>(&row[place]);
      if (value != nullptr && std::isfinite(*value)) of.reduced.add(*value);
    }
    values_[of.column] = of.reduced.result();
    // Once for all points, so that formulas have one unit at all of them.
    if (lacking_ == Lacking::mistake && has_unit_of_values(*of.entry->reduction)) {
      columns_.set_unit(of.column, table.units[place]);
    }
  }
  fill_others();
}

}  // namespace freeplay
