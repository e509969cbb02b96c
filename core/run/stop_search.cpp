#include "run/stop_search.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/index.h"

namespace freeplay {
namespace {

constexpr double far_off = 4.0;  // times what a value changes in two steps: inside these it goes no farther
constexpr double same_instant_in_step = 1e-12;  // of a step
constexpr double same_top = 1e-3;               // of a step, where a value is largest
constexpr int most_looks_at_top = 12;           // for a largest value

}  // namespace

StopSearch::StopSearch(RunContext& run, Recorder& recorder)
    : run_(run), recorder_(recorder), row_(run.settings.stop.empty() ? 0 : run.channels.all().size()) {
  const EnergyColumns& energy = run.channels.energy;
  for (const StopCondition& stop : run.settings.stop) {
    const int column = run.channels.find(stop.channel);
    if (column < 0) continue;
    const bool summed = column == energy.work || column == energy.dissipated || column == energy.residual;
    conditions_.push_back({.stop = &stop, .column = column, .inside = !summed});
  }
}

bool StopSearch::look_at_start() {
  if (!conditions_.empty() && !recorder_.know_row()) return false;
  for (Condition& condition : conditions_) {
    const bool counts = !(run_.accepted.t() < condition.stop->after);
    condition.at_start = counts && condition.beyond(recorder_.row()[at(condition.column)]) > 0.0;
  }
  return true;
}

bool StopSearch::look(double s) {
  return recorder_.see_ahead(run_.accepted.t() + s * (run_.trial.t() - run_.accepted.t()), row_);
}

// What is farther from its limit at both ends than it has moved lately does not come there in between.
bool StopSearch::may_be_met(const Condition& condition) const {
  if (!condition.inside || !(condition.stop->after < run_.trial.t())) return false;
  const double start = condition.past.front(), end = condition.past.back();
  if (std::isnan(start) || std::isnan(end)) return true;
  const double moved = std::abs(end - start) + std::abs(start - condition.last_start);
  return !condition.has_last || std::max(start, end) + far_off * moved > 0.0;
}

bool StopSearch::first_inside(double& part) {
  part = 2.0;
  found_ = -1;
  if (!recorder_.know_row()) return false;
  for (Condition& condition : conditions_)
    condition.past.front() = condition.beyond(recorder_.row()[at(condition.column)]);
  if (!look(1.0)) return false;
  for (Condition& condition : conditions_) condition.past.back() = past(condition);
  if (run_.solver.regularity() < near_singular) return true;  // no motion is interpolated there
  const double start = run_.accepted.t(), whole = run_.trial.t() - start;
  std::array<double, places> even{};
  for (std::size_t k = 0; k < places; ++k) even[k] = static_cast<double>(k) / static_cast<double>(places - 1);
  bool looked = false;
  for (std::size_t i = 0; i < conditions_.size(); ++i) {
    Condition& condition = conditions_[i];
    if (!may_be_met(condition)) continue;
    const double begin = (condition.stop->after - start) / whole;
    const bool late = begin > same_instant_in_step;  // it counts from a time inside on
    std::array<double, places> at = even;
    for (double& s : at) s = late ? begin + s * (1.0 - begin) : s;
    for (std::size_t k = late ? 0 : 1; k + 1 < places && (late || !looked); ++k) {
      if (!look(at[k])) return false;
      for (Condition& each : conditions_) {
        if (!late || &each == &condition) each.past[k] = past(each);
      }
    }
    looked = looked || !late;
    double own = late && condition.past.front() > 0.0 ? begin : 2.0;
    if (!seek(condition, at, own)) return false;
    if (own < part) part = own, found_ = static_cast<int>(i);
  }
  return true;
}

// The first rise through the limit; where the value stays below at all places, beside the highest of three.
bool StopSearch::seek(const Condition& condition, const std::array<double, places>& at, double& part) {
  const auto place = [&](std::size_t k) { return Place{at[k], condition.past[k]}; };
  for (std::size_t k = 1; k < places && !(part <= 1.0); ++k) {
    if (condition.past[k - 1] <= 0.0 && condition.past[k] > 0.0) return narrow(condition, place(k - 1), place(k), part);
    if (k + 1 < places && !seek_top(condition, {place(k - 1), place(k), place(k + 1)}, part)) return false;
  }
  return true;
}

// Follows the top of the parabola through three places that are not past the limit.
bool StopSearch::seek_top(const Condition& condition, std::array<Place, 3> around, double& part) {
  for (int looks = 0; looks < most_looks_at_top; ++looks) {
    const auto& [a, b, c] = around;
    if (a.past > 0.0 || b.past > 0.0 || c.past > 0.0) return true;
    const double slope = (b.past - a.past) / (b.s - a.s);
    const double bend = ((c.past - b.past) / (c.s - b.s) - slope) / (c.s - a.s);
    if (!(bend < 0.0)) return true;
    const double top = 0.5 * (a.s + b.s - slope / bend);
    if (!(top > a.s && top < c.s)) return true;
    const double height = a.past + (top - a.s) * (slope + bend * (top - b.s));
    // It may rise above its chord by twice what the parabola does.
    if (!(height - bend * (c.s - a.s) * (c.s - a.s) > 0.0)) return true;
    if (std::abs(top - b.s) < same_top * (c.s - a.s) && !(height > 0.0)) return true;
    if (!look(top)) return false;
    const Place now{top, past(condition)};
    if (now.past > 0.0) return narrow(condition, top > b.s ? b : a, now, part);
    if (std::abs(top - b.s) < same_instant_in_step) return true;
    if (top > b.s) {
      around = now.past > b.past ? std::array{b, now, c} : std::array{a, b, now};
    } else {
      around = now.past > b.past ? std::array{a, now, b} : std::array{now, b, c};
    }
  }
  return true;
}

// Between a place before the rise and one after it.
bool StopSearch::narrow(const Condition& condition, Place before, Place after, double& part) {
  while (after.s - before.s > same_instant_in_step) {
    const double s = 0.5 * (before.s + after.s);
    if (!look(s)) return false;
    (past(condition) > 0.0 ? after : before).s = s;
  }
  part = after.s;
  return true;
}

bool StopSearch::go_on() {
  if (conditions_.empty()) return true;
  if (met_ >= 0) {
    fill_outcome(conditions_[at(met_)], true);
    return false;
  }
  for (Condition& condition : conditions_) {
    condition.last_start = condition.past.front();
    condition.has_last = run_.adaptive && !run_.ended_abruptly;
    if (run_.accepted.t() < condition.stop->after) continue;
    if (!recorder_.know_row()) return false;
    if (!(condition.beyond(recorder_.row()[at(condition.column)]) > 0.0)) continue;
    fill_outcome(condition, false);
    return false;
  }
  return true;
}

void StopSearch::fill_outcome(const Condition& condition, bool located) {
  const StopCondition& stop = *condition.stop;
  const double value = recorder_.know_row() ? recorder_.row()[at(condition.column)] : stop.limit;
  run_.outcome.status = RunStatus::stopped;
  run_.outcome.reason = located ? fmt::format("{} is {} {:.9g} from t = {:.9g} s on", stop.channel,
                                              stop.above ? "above" : "below", stop.limit, run_.accepted.t())
                                : fmt::format("{} = {:.9g} is {} {:.9g} at t = {:.9g} s", stop.channel, value,
                                              stop.above ? "above" : "below", stop.limit, run_.accepted.t());
  if (!condition.at_start || run_.outcome.steps > 1) return;
  run_.outcome.reason += ", as it was at the start";
  run_.outcome.doubts.push_back(
      {.id = "statistics-window",
       .level = Trust::doubtful,
       .message = fmt::format("the run ended with its first step, as {} was {} {:.9g} at the start already: is '{}' "
                              "meant? A condition that counts later has an 'after'",
                              stop.channel, stop.above ? "above" : "below", stop.limit, stop.above ? "below" : "above"),
       .element = stop.channel});
}

}  // namespace freeplay
