#include "run/joint_formulas.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "base/index.h"
#include "model/element_name.h"
#include "run/hidden_change.h"

namespace freeplay {
namespace {

constexpr double kept_whole = std::numeric_limits<double>::infinity();
constexpr double shown_in_run = 0.01;                   // of a formula's range in the run
constexpr double no_difference = 1e-12;                 // of the largest value
constexpr double found_place = 1.0 / 64;                // of the part that is looked at: where something begins
constexpr double finest_way = 1e-9;                     // of the step: shorter spans are not halved
constexpr double put_off = 0.125;                       // what begins later in the step is left to the next
constexpr double shortest_share = 1e-6;                 // of a step that it is shortened to at once
constexpr int most_looks_at_one = 4000;                 // at a formula in a step
constexpr int most_looks_in_step = 200;                 // in one of one size
constexpr double box_reach = 16.0, quick_change = 4.0;  // of a box, and of the largest step in it: in present steps

}  // namespace

JointFormulas::JointFormulas(RunContext& run) : run_(run), light_(run.system, run.allowed) {
  std::size_t rows = 0, internal = 0;
  for (std::size_t j = 0; j < run.model.joints.size(); ++j) {
    const JointElement& element = run.model.joints[j];
    if (element.parameters == nullptr || element.parameters->component == nullptr) continue;
    const std::size_t first = courses_.size();
    for (const Parameter& parameter : element.parameters->component->description.parameters) {
      const auto value = element.parameters->values.find(std::string_view(parameter.name));
      if (value != element.parameters->values.end()) add(static_cast<int>(j), parameter, value->second);
    }
    if (courses_.size() == first) continue;
    joints_.push_back({static_cast<int>(j), first, courses_.size()});
    rows = std::max(rows, at(element.layout.constraint_rows));
    internal = std::max(internal, at(element.layout.internal_variables));
  }
  begins_ = ends_ = calls_;
  rate_.resize(internal), jacobian_.resize(12 * rows);
  for (std::vector<double>* numbers : {&phi_, &nu_, &gamma_}) numbers->resize(rows);
}

void JointFormulas::add(int joint, const Parameter& parameter, const ParameterValue& value) {
  if (value.served == nullptr || !value.served->may_hide()) return;
  const std::string_view unit = parameter.unit == nullptr ? "" : parameter.unit,
                         variables = parameter.variables == nullptr ? "" : parameter.variables;
  const bool turns = run_.model.joints[at(joint)].layout.coordinate == Coordinate::angle;
  const Course::Kind kind = unit == "m" ? Course::Kind::length : turns ? Course::Kind::torque : Course::Kind::force;
  courses_.push_back({value.served.get(), kind,
                      kind == Course::Kind::length && variables.find("rad") != std::string_view::npos,
                      MotionPieces(Formula::most_variables)});
  calls_.push_back({value.function_owner.get()});
}

void JointFormulas::follow(std::size_t place, const Point& here, const Evaluation& e) {
  for (const AskedJoint& asked : joints_) ask(asked, here, e);
  ends_ = calls_, ends_at_ = here.t;
  for (std::size_t c = 0; c < courses_.size(); ++c) {
    Course& course = courses_[c];
    course.known = calls_[c].called && (place == 0 || course.known);
    course.count = calls_[c].count;
    const std::span<Jet> variables = course.variables.end(place).first(course.count);
    for (std::size_t k = 0; k < variables.size(); ++k) {
      const double value = variables[k].value = calls_[c].variables[k];
      // A curve about its body begins again there: that step is as its error allows.
      if (course.by_angle && place > 0 &&
          std::abs(value - course.variables.end(place - 1)[k].value) > std::numbers::pi) {
        course.known = false;
      }
    }
  }
}

// Steps of a smooth motion change little from one to the next: from both ends of one it goes no farther than that.
bool JointFormulas::Course::keeps_in_box(std::span<const double> begin, std::span<const double> end) const {
  for (std::size_t k = 0; k < begin.size(); ++k) {
    const double low = box_low[k] + most_change[k], high = box_high[k] - most_change[k];
    const bool inside = begin[k] >= low && begin[k] <= high && end[k] >= low && end[k] <= high;
    if (!inside || !(std::abs(end[k] - begin[k]) <= most_change[k])) return false;
  }
  return true;
}

void JointFormulas::ask_ends() {
  // Where the last step ended this one begins, with what was found there: no event moves a body.
  if (run_.accepted.t() != ends_at_) {
    for (const AskedJoint& asked : joints_) ask(asked, point(run_.accepted), run_.e_accepted);
    ends_ = calls_;
  }
  begins_ = ends_;
  for (const AskedJoint& asked : joints_) ask(asked, point(run_.trial), run_.e_trial);
  ends_ = calls_, ends_at_ = run_.trial.t();
}

bool JointFormulas::stay_known() {
  if (std::ranges::any_of(courses_, [](const Course& course) { return course.known && !course.has_box; })) return false;
  ask_ends();
  for (std::size_t c = 0; c < courses_.size(); ++c) {
    const FormulaCalls::Watched &begin = begins_[c], &end = ends_[c];
    const Course& course = courses_[c];
    if (!begin.called || !end.called) continue;
    if (!(course.has_box &&
          course.keeps_in_box({begin.variables.data(), begin.count}, {end.variables.data(), begin.count})))
      return false;
  }
  return true;
}

// The second derivative in every direction in which variables may change there.
void JointFormulas::find_box(Course& course) {
  std::array<IntervalJet, Formula::most_variables> ranges;
  std::array<Jet, Formula::most_variables> middles;
  const std::size_t count = course.count;
  for (std::size_t k = 0; k < count; ++k) {
    double low = unbounded, high = -unbounded;
    for (std::size_t place = 0; place <= MotionPieces::count; ++place) {
      const double value = course.variables.end(place)[k].value;
      low = std::min(low, value), high = std::max(high, value);
    }
    const double change = high - low;
    course.box_low[k] = low - box_reach * change, course.box_high[k] = high + box_reach * change;
    course.most_change[k] = quick_change * change;
    ranges[k] = IntervalJet{Interval{course.box_low[k], course.box_high[k]},
                            Interval{-course.most_change[k], course.most_change[k]}, Interval{}};
    middles[k] = Jet{0.5 * (low + high), std::nan(""), 0.0};  // at no one rate
  }
  FormulaBounds::Bounds bounds{unknown_jet(), {}};
  course.formula->bound({.half = 0.5, .ranges = {ranges.data(), count}, .at_middle = {middles.data(), count}}, bounds);
  const Interval& bend = bounds.range.acceleration;
  course.has_box = (bend.high - bend.low) / 8.0 <= course.allowed;
}

// A joint that cannot be evaluated here is left out: the next regular evaluation reports its fault.
void JointFormulas::ask(const AskedJoint& asked, const Point& here, const Evaluation& e) {
  const std::span<FormulaCalls::Watched> all(calls_);
  const FormulaCalls calls(all.subspan(asked.first, asked.end - asked.first));
  const JointLayout& layout = run_.model.joints[at(asked.joint)].layout;
  const JointRef& joint = run_.system.joints().handle(asked.joint);
  const JointInput in = run_.system.joints().input(asked.joint, here, e);
  const auto zeroed = [](std::vector<double>& numbers, std::size_t count) {
    std::fill_n(numbers.begin(), count, 0.0);
    return Span<double>(numbers.data(), count);
  };
  Message ignored;
  if (layout.forces != 0) {
    JointForces forces{};
    forces.internal_rate = zeroed(rate_, at(layout.internal_variables));
    joint.apply(in, forces, ignored);
  }
  if (const std::size_t rows = at(layout.constraint_rows); rows > 0) {
    ConstraintRows made{zeroed(phi_, rows), zeroed(jacobian_, 12 * rows), zeroed(nu_, rows), zeroed(gamma_, rows)};
    joint.constrain(in, made, ignored);
  }
}

bool JointFormulas::show(Course& course) {
  Numbers numbers{};
  const std::span<double> variables(numbers.data(), course.count);
  for (std::size_t k = 0; k < course.places.shown.size(); ++k) {
    course.variables.at(0.25 * static_cast<double>(k) * course.places.part, variables);
    double& value = course.places.shown[k];
    if (!course.formula->value(variables, value) || !std::isfinite(value)) return false;
  }
  return true;
}

void JointFormulas::bound(const Course& course, double from, double to, FormulaBounds::Bounds& bounds) const {
  std::array<IntervalJet, Formula::most_variables> all_ranges;
  std::array<Jet, Formula::most_variables> all_middles;
  const std::span<IntervalJet> ranges(all_ranges.data(), course.count);
  const std::span<Jet> middles(all_middles.data(), course.count);
  course.variables.bound(from, to, ranges, middles);
  course.formula->bound({.middle = course.variables.time(0.5 * (from + to)),
                         .half = 0.5 * (to - from) * course.variables.length(),
                         .ranges = ranges,
                         .at_middle = middles},
                        bounds);
}

// The first place of the span where the formula is not what is shown.
double JointFormulas::departure(Course& course, double from, double to) {
  if (++course.looks > most_looks_at_one) return kept_whole;
  const double middle = 0.5 * (from + to), length = course.variables.length();
  FormulaBounds::Bounds bounds{unknown_jet(), {}};
  bound(course, from, to, bounds);
  if (course.places.show(bounds, from, to, length, course.allowed)) return kept_whole;
  const bool leaves =
      std::abs(bounds.at_middle.value - course.places.polynomial(middle, length).value) > course.allowed;
  if (leaves && to - from < found_place * course.places.part) return from;
  if (to - from < finest_way) return leaves ? middle : kept_whole;
  const double earlier = departure(course, from, middle);
  if (earlier < kept_whole) return earlier;
  return leaves ? middle : departure(course, middle, to);
}

double JointFormulas::resolved(Course& course) {
  FivePlaces& places = course.places;
  places.part = 1.0;
  if (!course.known || !show(course)) return 1.0;
  course.low = std::min(course.low, places.shown[0]), course.high = std::max(course.high, places.shown[0]);
  const double low = std::min(course.low, places.low()), high = std::max(course.high, places.high());
  do {
    const double dt = places.part * course.variables.length();
    const double light = course.kind == Course::Kind::length   ? light_.length()
                         : course.kind == Course::Kind::torque ? light_.torque(dt)
                                                               : light_.force(dt);
    course.allowed =
        std::max({shown_in_run * (high - low), no_difference * std::max(std::abs(low), std::abs(high)), light});
    course.looks = 0;
    double place = kept_whole;
    for (std::size_t k = 0; k < MotionPieces::count && !(place < kept_whole); ++k) {
      const double from = static_cast<double>(k) / static_cast<double>(MotionPieces::count);
      const double to = std::min(places.part, from + 1.0 / static_cast<double>(MotionPieces::count));
      if (from < to) place = departure(course, from, to);
    }
    if (!(place < kept_whole)) {
      find_box(course);
      return places.part;
    }
    places.part = place > put_off * places.part ? place : 0.5 * places.part;
  } while (places.part >= shortest_share && show(course));
  return std::max(places.part, shortest_share);
}

double JointFormulas::resolved() {
  const double start = run_.accepted.t(), dt = run_.trial.t() - start;
  double part = 1.0;
  for (Course& course : courses_) {
    course.variables.take(start, dt);
    course.variables.fit_rates();
    part = std::min(part, resolved(course));
  }
  return part;
}

bool JointFormulas::note_ends() {
  ask_ends();
  bool open = false;
  for (std::size_t c = 0; c < courses_.size(); ++c) {
    const FormulaCalls::Watched &begin = begins_[c], &end = ends_[c];
    Course& course = courses_[c];
    course.count = begin.count;
    course.open = begin.called && end.called &&
                  note_ends(course, {begin.variables.data(), begin.count}, {end.variables.data(), begin.count});
    open = open || course.open;
  }
  return open;
}

// Whether it can go beyond what it is at both ends, in the ranges that its variables may have in the step: theirs at
// the ends, made wider by a quarter of what they changed by, as where they turn.
bool JointFormulas::note_ends(Course& course, std::span<const double> begin, std::span<const double> end) {
  std::array<Interval, Formula::most_variables> all_ranges;
  const std::span<Interval> ranges(all_ranges.data(), begin.size());
  bool in_box = course.has_box;
  for (std::size_t k = 0; k < begin.size(); ++k) {
    const double change = std::abs(end[k] - begin[k]);
    // A curve about its body begins again there.
    if (course.by_angle && change > std::numbers::pi) return false;
    const double more = 0.25 * std::max(change, course.last_change[k]);
    course.last_change[k] = change;
    ranges[k] = {std::min(begin[k], end[k]) - more, std::max(begin[k], end[k]) + more};
    in_box = in_box && ranges[k].low >= course.box_low[k] && ranges[k].high <= course.box_high[k];
  }
  double a = 0.0, b = 0.0;
  if (!course.formula->value(begin, a) || !course.formula->value(end, b)) return false;
  if (!std::isfinite(a) || !std::isfinite(b)) return false;
  const auto [low, high] = std::minmax(a, b);
  course.low = std::min(course.low, low), course.high = std::max(course.high, high);
  if (in_box) return false;
  const Interval all = values(course, ranges);
  course.has_box = false;
  if (!(std::max(all.high - high, low - all.low) <= hidden(course))) return true;
  for (std::size_t k = 0; k < begin.size(); ++k) {
    const double more = box_reach * (ranges[k].high - ranges[k].low);
    course.box_low[k] = ranges[k].low - more, course.box_high[k] = ranges[k].high + more;
    ranges[k] = {course.box_low[k], course.box_high[k]};
  }
  const Interval in_all = values(course, ranges);
  course.has_box = in_all.high - in_all.low <= hidden(course);
  return false;
}

// By how much more it may be off than both ends of a step show.
double JointFormulas::hidden(const Course& course) {
  const double largest = std::max(std::abs(course.low), std::abs(course.high));
  return std::max({course.beyond, hidden_part * (course.high - course.low), no_difference * largest});
}

// At any rates: the length of the span says nothing.
Interval JointFormulas::values(const Course& course, std::span<const Interval> ranges) {
  std::array<IntervalJet, Formula::most_variables> jets;
  std::array<Jet, Formula::most_variables> middles;
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    jets[k] = {ranges[k], Interval::whole(), Interval::whole()};
    middles[k] = {0.5 * (ranges[k].low + ranges[k].high), std::nan(""), std::nan("")};
  }
  FormulaBounds::Bounds bounds{unknown_jet(), {}};
  course.formula->bound(
      {.half = 1.0, .ranges = {jets.data(), ranges.size()}, .at_middle = {middles.data(), ranges.size()}}, bounds);
  return bounds.range.value;
}

void JointFormulas::note_inside() {
  for (Course& course : courses_) {
    if (!course.open || !course.known) continue;
    course.variables.take(run_.accepted.t(), run_.trial.t() - run_.accepted.t());
    course.variables.fit_rates();
    course.looks = 0;
    course.places.part = 1.0;
    if (!show(course)) continue;
    for (std::size_t k = 0; k < MotionPieces::count; ++k) {
      const double from = static_cast<double>(k) / static_cast<double>(MotionPieces::count);
      seek_beyond(course, from, from + 1.0 / static_cast<double>(MotionPieces::count));
    }
  }
}

void JointFormulas::seek_beyond(Course& course, double from, double to) {
  if (++course.looks > most_looks_in_step) return;
  FormulaBounds::Bounds bounds{unknown_jet(), {}};
  bound(course, from, to, bounds);
  const auto [low, high] = std::minmax(course.places.shown.front(), course.places.shown.back());
  const auto beyond = [&, low = low, high = high](const Interval& range) {
    return std::max(range.high - high, low - range.low);
  };
  if (!(beyond(bounds.range.value) > hidden(course))) return;
  const double middle = 0.5 * (from + to), here = beyond(Interval::at(bounds.at_middle.value));
  if (here > hidden(course)) course.beyond = here, course.at = course.variables.time(middle);
  if (to - from < finest_way) return;
  seek_beyond(course, from, middle);
  seek_beyond(course, middle, to);
}

void JointFormulas::format() {
  for (const AskedJoint& asked : joints_) {
    const JointElement& joint = run_.model.joints[at(asked.joint)];
    for (std::size_t c = asked.first; c < asked.end; ++c) {
      const Course& course = courses_[c];
      const HiddenChange change{.beyond = course.beyond,
                                .at = course.at,
                                .range = std::max(course.high - course.low, 0.0) + course.beyond,
                                .unit = course.kind == Course::Kind::length   ? "m"
                                        : course.kind == Course::Kind::torque ? "N m"
                                                                              : "N"};
      if (!change.counts(run_)) continue;
      change.say(run_, written_name(joint));
      break;
    }
  }
}

}  // namespace freeplay
