#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.h"
#include "model/element_name.h"
#include "run/input_activity.h"

namespace freeplay {
namespace {
constexpr double beside = 8.0;               // steps before a change
constexpr double closer = 0.5;               // a formula is looked at again in changes of at most this part
constexpr long enough_corners = 20'000'000;  // instructions to find them
constexpr std::size_t most_corners = 100'000;
constexpr double one_time = 1e-12;  // of a time: corners that are closer are one
constexpr double nearly = 1e-9;     // of a step

/// The closest two of some times; infinitely far apart where there is one or none.
std::pair<double, double> closest_of(const std::vector<double>& times) {
  std::pair<double, double> closest{0.0, unbounded};
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double apart = times[i + 1] - times[i];
    const bool rounded = apart <= one_time * std::max(std::abs(times[i]), std::abs(times[i + 1]));
    if (!rounded && apart < closest.second - closest.first) closest = {times[i], times[i + 1]};
  }
  return closest;
}

/// The derivative that acts.
int derivative(bool load, bool is_speed) { return load ? 0 : is_speed ? 1 : 2; }

/// Whether how fast a formula may change around t is not known.
bool has_no_rate(const Expression& expression, double from, double to, double t, double by) {
  FormulaCourse course(expression, from, to);
  course.next_corner(std::max(from, t - by), t + by);
  return !std::isfinite(course.rate_within(std::max(from, t - by), t + by));
}
}  // namespace

std::vector<InputActivity::Unresolved> InputActivity::look_closer(double least) {
  std::vector<Unresolved> left;
  for (Formula& formula : formulas_) {
    const int order = derivative(formula.sharp == CornerKind::load, formula.unit == Unit::other);
    const bool cuts_forms = formula.sharp == CornerKind::load || formula.bends > 0;  // see resolved_formula()
    for (double from = start_;;) {
      const double apart = formula.shortest / samples_per_change;
      const auto change =
          UnseenChange::of(*formula.expression, from, end_, apart, order, cuts_forms ? quick(formula.sharp) : 0.0);
      if (!change || !has_no_rate(*formula.expression, start_, end_, change->time, apart)) break;
      if (formula.shortest <= least) {
        left.push_back(
            {formula.section, formula.name, change->time - change->length, change->time + change->length, false});
        break;
      }
      formula.shortest = std::clamp(change->length, least, closer * formula.shortest);
      from = std::max(start_, change->time - beside * apart);  // what is before it is shown by shorter steps, too
    }
  }
  return left;
}

std::optional<UnseenChange::Found> InputActivity::unseen_force(const TimedJoint& timed, double step, const Point& here,
                                                               const Evaluation& e) {
  const JointInput in = system_.joints().input(timed.joint, here, e);
  // What promises no force as long as it stays where it is has none that comes with time.
  double distance = 0.0;
  Fault ignored;
  if (!system_.joints().handle(timed.joint).free_distance(in, distance, ignored.message) || distance > 0.0) return {};
  std::vector<double> all(timed.signals);
  const std::size_t forces =
      timed.signals - static_cast<std::size_t>(system_.joints().layout(timed.joint).constraint_rows);
  const auto look = [&](double t, std::span<double> values) {
    Fault fault;
    if (!signals_of(timed, in, t, all.data(), fault)) return false;
    std::ranges::copy(std::span(all).first(forces), values.begin());
    return true;
  };
  return UnseenChange::of(look, forces, start_, end_, step, timed.shortest / samples_per_change);
}

std::vector<InputActivity::Unresolved> InputActivity::unresolved_by(double step, const Point& here,
                                                                    const Evaluation& e) {
  std::vector<Unresolved> found;
  const auto known = [&](const std::string* name) {
    return std::ranges::any_of(found, [&](const Unresolved& u) { return u.name == name; });
  };
  const auto add_corners = [&](const char* section, const std::string* name, const std::vector<double>& times) {
    const auto [from, to] = closest_of(times);
    if (!known(name) && to - from < step * (1.0 - nearly)) found.push_back({section, name, from, to, true});
  };
  const auto add_change = [&](const char* section, const std::string* name, const auto& function, int derivative) {
    if (known(name)) return;
    const auto change = UnseenChange::of(function, start_, end_, step, derivative);
    if (!change) return;
    found.push_back({section, name, change->time - change->length, change->time + change->length, false});
  };
  const auto acting = [](const auto& input) {
    return derivative(input.sharp == CornerKind::load, input.unit == Unit::other);
  };
  for (Formula& formula : formulas_) {
    std::vector<double> times;
    double corner = formula.course.next_corner(start_, end_);
    while (corner < end_ && formula.course.work() < enough_corners) {
      times.push_back(corner);
      corner = formula.course.next_corner(corner, end_);
    }
    add_corners(formula.section, formula.name, times);
    add_change(formula.section, formula.name, *formula.expression, acting(formula));
    if (formula.sharp != CornerKind::load || known(formula.name)) continue;
    const auto error = jump_error(*formula.expression, times, {start_, end_, system_.model().settings.interval, step});
    if (error && error->part > off_by_jumps)
      found.push_back({formula.section, formula.name, start_, end_, false, *error});
  }
  for (const Table& table : tables_) add_change("driver", table.name, *table.table, acting(table));
  for (const TellingJoint& telling : telling_) {
    std::vector<double> times;
    Fault fault;
    double corner = start_;
    while (corner < end_ && times.size() < most_corners && ask(telling.joint, corner, corner, fault)) {
      if (corner < end_) times.push_back(corner);
    }
    const JointElement& joint = system_.model().joints[at(telling.joint)];
    add_corners(section_of(joint), &joint.name, times);
  }
  for (const TimedJoint& timed : joints_) {
    const JointElement& joint = system_.model().joints[at(timed.joint)];
    if (known(&joint.name) || system_.joints().layout(timed.joint).forces == 0) continue;
    const auto change = unseen_force(timed, step, here, e);
    if (change)
      found.push_back(
          {section_of(joint), &joint.name, change->time - change->length, change->time + change->length, false});
  }
  return found;
}

}  // namespace freeplay
