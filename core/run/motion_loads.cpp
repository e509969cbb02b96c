#include "run/motion_loads.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "run/dense_step.h"
#include "run/hidden_change.h"

namespace freeplay {
namespace {

constexpr double no_departure = std::numeric_limits<double>::infinity();
constexpr double shown_part = 0.01;        // of a formula's range in the step
constexpr double shown_alone = 1e-5;       // of it where loads move nothing: means and peaks of forces are by parabolas
constexpr double finest_span = 1e-9;       // of the step: shorter spans are not halved
constexpr double same_begin = 1.0 / 64.0;  // to which it is known where something begins
constexpr double late_part = 0.125;        // what begins later in the step is left to the next
constexpr double next_longest = 4.0;       // the next step to try, of one that had to be shortened
constexpr double least_part = 1e-6;        // of a step that it is shortened to at once
constexpr double no_change = 1e-12;        // of the largest value
constexpr double narrowest_box = 4.0, widest_box = 256.0;  // see Formula::box_steps
constexpr int rest_without_box = 16;                       // steps until a box is tried again
constexpr int most_looks_at_formula = 4000;                // at a formula in a step
constexpr int most_looks_at_ends = 200;                    // in one of one size
constexpr int most_looks_at_impulse = 400;                 // likewise
constexpr double known_impulse = 1e-3;                     // of a step with a formula's range in the run
constexpr double seen_jump = 0.01, quick_part = 0.25;      // of that range, in one step

}  // namespace

MotionLoads::MotionLoads(RunContext& run)
    : run_(run), light_(run.system, run.allowed), channels_(run.system), joints_(run) {
  std::size_t channels = 0, switches = 0;
  for (const LoadChannels::Load& load : channels_.loads()) {
    Load own{&load, -1, {}, MotionPieces(load.formulas->channels.size())};
    int first = load.first_switch;
    int component = 0;
    for (const StateFormula& formula : load.formulas->formulas) {
      FormulaBounds bounds(formula);
      // In steps of one size nothing ends where a switch changes its side.
      const bool watched = bounds.may_hide() || (!run.adaptive && formula.switches() > 0);
      if (watched) {
        own.formulas.push_back({.bounds = std::move(bounds), .first_switch = first, .component = component});
        own.formulas.back().box.resize(load.formulas->channels.size());
      }
      ++component;
      first += formula.switches();
      switches = std::max(switches, at(formula.switches()));
    }
    if (own.formulas.empty()) continue;
    if (run.adaptive) own.idle = run.idle_loads.add(load.on);
    own.end_values.resize(load.formulas->channels.size());
    channels = std::max(channels, load.formulas->channels.size());
    loads_.push_back(std::move(own));
  }
  ranges_.resize(channels);
  reaches_.resize(channels);
  middles_.resize(channels);
  values_.resize(channels);
  switches_.resize(switches);
  changes_.resize(channels);
  for (std::vector<double>* numbers : {&decides_, &rates_, &scale_}) numbers->resize(switches);
}

bool MotionLoads::follow(Fault& fault) {
  const double start = run_.accepted.t(), dt = run_.trial.t() - start;
  const DenseStep step(run_.model.space, run_.accepted, run_.e_accepted->internal_rate, run_.trial,
                       run_.e_trial->internal_rate);
  const unsigned terms = joints_.any() ? term_event | term_coordinate : term_event;
  for (std::size_t k = 0; k <= MotionPieces::count; ++k) {
    const bool inside = k > 0 && k < MotionPieces::count;
    if (inside) {
      step.at(static_cast<double>(k) / static_cast<double>(MotionPieces::count), run_.between);
      if (!run_.system.evaluate(point(run_.between), terms, run_.e_between)) {
        fault = run_.e_between->fault;
        return false;
      }
      run_.system.constraints().fill_driven(run_.e_between);
    }
    const State& state = inside ? run_.between : k == 0 ? run_.accepted : run_.trial;
    const Evaluation& e = inside ? run_.e_between : k == 0 ? run_.e_accepted : run_.e_trial;
    for (Load& load : loads_) channels_.follow(*load.load, state.a(), e, load.motion.end(k));
    joints_.follow(k, point(state), e);
  }
  for (Load& load : loads_) load.motion.take(start, dt);
  return true;
}

double MotionLoads::value(const Course& course, double s) {
  const std::span<double> values(values_.data(), course.load.load->formulas->channels.size());
  course.load.motion.at(s, values);
  double out = 0.0;
  EvaluationFailure ignored;
  const bool good =
      course.formula.bounds.formula().value({course.load.motion.time(s), values, course.sides}, out, ignored);
  return good ? out : std::nan("");
}

bool MotionLoads::show(Course& course) {
  std::array<double, 5>& shown = course.places.shown;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    shown[k] = value(course, 0.25 * static_cast<double>(k) * course.places.part);
    if (!std::isfinite(shown[k])) return false;
  }
  course.low = course.places.low(), course.high = course.places.high();
  const double dt = course.places.part * course.load.motion.length();
  const double light = course.load.load->turns ? light_.torque(dt) : light_.force(dt);
  const double largest = std::max(std::abs(course.low), std::abs(course.high));
  const double part = run_.idle_loads.is_idle(course.load.idle) ? shown_alone : shown_part;
  course.allowed = std::max({part * (course.high - course.low), no_change * largest, light});
  return true;
}

void MotionLoads::bound(const Course& course, double from, double to) {
  const std::size_t channels = course.load.load->formulas->channels.size();
  const std::span<IntervalJet> ranges(ranges_.data(), channels);
  const std::span<Jet> middles(middles_.data(), channels);
  course.load.motion.bound(from, to, ranges, middles);
  course.formula.bounds.bound({.middle = course.load.motion.time(0.5 * (from + to)),
                               .half = 0.5 * (to - from) * course.load.motion.length(),
                               .ranges = ranges,
                               .at_middle = middles,
                               .sides = course.sides},
                              bounds_, {switches_.data(), at(course.formula.bounds.formula().switches())});
}

// In the whole span, as its bounds say.
bool MotionLoads::is_shown(const Course& course, double from, double to) const {
  return !may_cross(course) && course.places.show(bounds_, from, to, course.load.motion.length(), course.allowed);
}

// Whether a switch that does not pass zero as evenly as the motion goes may be past it somewhere in the span that was
// bounded.
bool MotionLoads::may_cross(const Course& course) const {
  if (course.sides == nullptr) return false;
  const FormulaBounds& bounds = course.formula.bounds;
  for (int i = 0; i < bounds.formula().switches(); ++i) {
    if (course.sides[i] == 0.0 || bounds.is_even(i)) continue;
    const Interval& values = switches_[at(i)].range.value;
    if (!((course.sides[i] > 0.0 ? values.low : -values.high) >= 0.0)) return true;
  }
  return false;
}

// Whether one is past it in a place, by more than a switch may be that a step ends at.
bool MotionLoads::crosses(const Course& course, double s) {
  if (course.sides == nullptr) return false;
  const FormulaBounds& bounds = course.formula.bounds;
  const int count = bounds.formula().switches();
  const std::vector<double>& units = course.load.load->units;
  const std::span<double> values(values_.data(), units.size()), changes(changes_.data(), units.size());
  const std::span<double> decides(decides_.data(), at(count)), rates(rates_.data(), at(count));
  course.load.motion.at(s, values);
  const StateFormula::Input here{course.load.motion.time(s), values, course.sides};
  std::fill_n(scale_.begin(), count, 0.0);
  for (std::size_t k = 0; k <= units.size(); ++k) {
    std::ranges::fill(changes, 0.0);
    if (k < units.size()) changes[k] = units[k];
    bounds.formula().decide(here, changes, k < units.size() ? 0.0 : 1.0, decides, rates);
    for (int i = 0; i < count; ++i) scale_[at(i)] += std::isfinite(rates[at(i)]) ? std::abs(rates[at(i)]) : 0.0;
  }
  for (int i = 0; i < count; ++i) {
    if (course.sides[i] == 0.0 || bounds.is_even(i)) continue;
    if (-course.sides[i] * decides[at(i)] > 2.0 * run_.events.switches().band() * scale_[at(i)]) return true;
  }
  return false;
}

// The first place of the span where the formula is not what is shown, or a switch is past its zero.
double MotionLoads::departure(Course& course, double from, double to) {
  if (++course.looks > most_looks_at_formula) return no_departure;
  bound(course, from, to);
  if (is_shown(course, from, to)) return no_departure;
  const double middle = 0.5 * (from + to);
  const bool leaves = std::abs(bounds_.at_middle.value -
                               course.places.polynomial(middle, course.load.motion.length()).value) > course.allowed;
  const bool crossing = may_cross(course) && crosses(course, middle);
  if (leaves && to - from < same_begin * course.places.part) return from;
  if (to - from >= finest_span) {
    const double earlier = departure(course, from, middle);
    if (earlier < no_departure) return earlier;
  }
  if (crossing) course.crosses = true;
  if (crossing || leaves) return middle;
  return to - from < finest_span ? no_departure : departure(course, middle, to);
}

double MotionLoads::resolved(const Load& load, const Formula& formula) {
  const double* const sides = run_.accepted.h().data() + run_.system.layout().switches().offset + formula.first_switch;
  Course course{.load = load, .formula = formula, .sides = sides};
  while (show(course)) {
    course.looks = 0;
    double place = no_departure;
    for (std::size_t k = 0; k < MotionPieces::count && !(place < no_departure); ++k) {
      const double from = static_cast<double>(k) / static_cast<double>(MotionPieces::count);
      const double to = std::min(course.places.part, from + 1.0 / static_cast<double>(MotionPieces::count));
      if (from < to) place = departure(course, from, to);
    }
    if (!(place < no_departure)) break;
    if (course.crosses) return place;
    course.places.part = place > late_part * course.places.part ? place : 0.5 * course.places.part;
    if (course.places.part < least_part) return least_part;
  }
  return course.places.part;
}

bool MotionLoads::resolved(double& part, Fault& fault) {
  part = 1.0;
  longest_ = unbounded;
  if (loads_.empty() && joints_.stay_known()) return true;
  if (!follow(fault)) return false;
  for (const Load& load : loads_) {
    for (const Formula& formula : load.formulas) part = std::min(part, resolved(load, formula));
  }
  if (joints_.any()) part = std::min(part, joints_.resolved());
  if (part < 1.0) longest_ = next_longest * part * (run_.trial.t() - run_.accepted.t());
  return true;
}

void MotionLoads::note() {
  if (!any()) return;
  follow_ends();
  bool open = false;
  for (Load& load : loads_) {
    load.motion.reach(std::span(reaches_).first(load.end_values.size()));
    for (Formula& formula : load.formulas) {
      formula.misses = false;
      formula.open = is_open(load, formula);
      if (!formula.open && !formula.misses) formula.impulse.add(formula.made, speed_along(load, formula));
      open = open || formula.open || formula.misses;
    }
    load.motion.values_at_end(MotionPieces::count, load.end_values);
  }
  const bool open_joint = joints_.any() && joints_.note_ends();
  Fault ignored;
  if (!(open || open_joint) || !follow(ignored)) return;
  for (Load& load : loads_) {
    for (Formula& formula : load.formulas) {
      if (formula.open || formula.misses) note(load, formula);
    }
  }
  if (open_joint) joints_.note_inside();
}

// Where the last step ended and nothing has happened since, this one begins with what was found there.
void MotionLoads::follow_ends() {
  const double start = run_.accepted.t();
  const bool known = start == followed_until_ && run_.restarts == restarts_then_;
  for (Load& load : loads_) {
    const std::span<Jet> begin = load.motion.end(0), end = load.motion.end(MotionPieces::count);
    if (known) {
      std::ranges::copy(end, begin.begin());
    } else {
      channels_.follow(*load.load, run_.accepted.a(), run_.e_accepted, begin);
    }
    channels_.follow(*load.load, run_.trial.a(), run_.e_trial, end);
    load.motion.take(start, run_.trial.t() - start);
  }
  followed_until_ = run_.trial.t();
  restarts_then_ = run_.restarts;
}

double MotionLoads::allowed(const Formula& formula) {
  if (!(formula.low <= formula.high)) return 0.0;  // nothing is known of it
  const double largest = std::max(std::abs(formula.low), std::abs(formula.high));
  return std::max({formula.beyond, hidden_part * (formula.high - formula.low), no_change * largest});
}

// Whether a formula can go beyond what it is at both ends, as far as the ranges of its channels in the whole step show:
// most steps are a small part of the way, and nothing more need be looked at.
bool MotionLoads::is_open(const Load& load, Formula& formula) {
  double low = unbounded, high = -unbounded;
  if (in_box(load, formula) || find_box(load, formula)) {
    if (formula.low > formula.in_box.low || formula.high < formula.in_box.high) note_ends(load, formula, low, high);
    formula.made = 0.5 * (formula.in_box.low + formula.in_box.high) * load.motion.length();
    return false;
  }
  formula.made = 0.0;
  if (!note_ends(load, formula, low, high)) return false;
  const std::span<const Interval> reaches(reaches_.data(), load.end_values.size());
  const Interval range = formula.bounds.values(reaches, {load.motion.time(0.0), load.motion.time(1.0)});
  formula.misses = misses(load, formula, range);
  return !(std::max(range.high - high, low - range.low) <= allowed(formula));
}

// Whether the step may make something else of the formula's impulse than the way along it: the form that it keeps is
// another one at the end, or it changes by much. What it makes of it: a straight line between the ends.
bool MotionLoads::misses(const Load& load, Formula& formula, const Interval& range) {
  const double* const sides = run_.accepted.h().data() + run_.system.layout().switches().offset + formula.first_switch;
  const Course kept{.load = load, .formula = formula, .sides = sides};
  const double begin = value(kept, 0.0), end = value(kept, 1.0), all = formula.high - formula.low;
  if (!std::isfinite(begin) || !std::isfinite(end)) return false;
  formula.made = 0.5 * (begin + end) * load.motion.length();
  return std::abs(end - formula.end_value) > seen_jump * all || range.high - range.low > quick_part * all;
}

// What a formula is at both ends of the step. False where it has no value there.
bool MotionLoads::note_ends(const Load& load, Formula& formula, double& low, double& high) {
  const std::span<double> values(values_.data(), load.end_values.size());
  for (const std::size_t k : {std::size_t{0}, MotionPieces::count}) {
    load.motion.values_at_end(k, values);
    const double t = k == 0 ? run_.accepted.t() : run_.trial.t();
    double here = formula.end_value;
    EvaluationFailure ignored;
    const bool same = t == formula.end_time && std::ranges::equal(values, load.end_values);
    if (!same && !formula.bounds.formula().value({t, values, nullptr}, here, ignored)) return false;
    if (!std::isfinite(here)) return false;
    low = std::min(low, here), high = std::max(high, here);
    formula.end_time = t, formula.end_value = here;
  }
  formula.low = std::min(formula.low, low), formula.high = std::max(formula.high, high);
  return true;
}

bool MotionLoads::in_box(const Load& load, const Formula& formula) const {
  if (!(load.motion.time(1.0) <= formula.box_until)) return false;
  for (std::size_t c = 0; c < formula.box.size(); ++c) {
    if (!(reaches_[c].low >= formula.box[c].low && reaches_[c].high <= formula.box[c].high)) return false;
  }
  return true;
}

// Some steps wide to all sides, if the formula stays within half of what it may be off there, so that no step is open.
bool MotionLoads::find_box(const Load& load, Formula& formula) {
  formula.box_until = -unbounded;
  if (formula.steps_to_box-- > 0) return false;
  formula.steps_to_box = 0;
  for (std::size_t c = 0; c < formula.box.size(); ++c) {
    const double more = formula.box_steps * (reaches_[c].high - reaches_[c].low);
    formula.box[c] = {reaches_[c].low - more, reaches_[c].high + more};
  }
  const double until = load.motion.time(1.0 + formula.box_steps);
  const Interval range = formula.bounds.values(formula.box, {load.motion.time(0.0), until});
  if (!(range.high - range.low <= 0.5 * allowed(formula))) {
    formula.box_steps *= 0.5;
    if (formula.box_steps < narrowest_box) formula.box_steps = narrowest_box, formula.steps_to_box = rest_without_box;
    return false;
  }
  const double rounded = no_change * std::max(std::abs(range.low), std::abs(range.high));
  formula.in_box = {range.low - rounded, range.high + rounded};
  formula.box_until = until;
  formula.box_steps = std::min(1.5 * formula.box_steps, widest_box);
  return true;
}

void MotionLoads::note(const Load& load, Formula& formula) {
  Course course{.load = load, .formula = formula, .sides = nullptr};
  const double begin = value(course, 0.0), end = value(course, 1.0);
  course.low = std::min(begin, end), course.high = std::max(begin, end);
  for (std::size_t k = 0; k < MotionPieces::count; ++k) {
    const double from = static_cast<double>(k) / static_cast<double>(MotionPieces::count);
    seek_beyond(course, formula, from, from + 1.0 / static_cast<double>(MotionPieces::count));
  }
  course.looks = 0;
  course.allowed = known_impulse * std::max(formula.high - formula.low, formula.beyond);
  double exact = 0.0;
  for (std::size_t k = 0; k < MotionPieces::count; ++k) {
    const double from = static_cast<double>(k) / static_cast<double>(MotionPieces::count);
    exact += impulse(course, from, from + 1.0 / static_cast<double>(MotionPieces::count));
  }
  if (std::isfinite(exact)) formula.impulse.add(formula.made, exact, speed_along(load, formula));
}

// Of its place along a component of a force, or about that of a torque, at the end of the step; 0 of other loads.
double MotionLoads::speed_along(const Load& load, const Formula& formula) const {
  const AppliedForce* const force = load.load->force;
  if (force == nullptr) return 0.0;
  const MarkerKinematics& marker = run_.e_trial->markers[at(force->marker)];
  const std::size_t c = at(formula.component);
  if (force->kind == ForceKind::torque) return marker.angular_velocity[force->value.size() == 1 ? 2 : c];
  if (!force->frame_axes) return marker.velocity[c];
  double speed = 0.0;
  for (std::size_t r = 0; r < 3; ++r) speed += marker.rotation[3 * r + c] * marker.velocity[r];
  return speed;
}

// Along the motion in a span of the step, by the value in its middle where that is good enough.
double MotionLoads::impulse(Course& course, double from, double to) {
  bound(course, from, to);
  const double length = to - from, middle = bounds_.at_middle.value;
  if (++course.looks > most_looks_at_impulse || shows(course, length) || length < finest_span)
    return middle * length * course.load.motion.length();
  const double half = 0.5 * (from + to), first = impulse(course, from, half);
  return first + impulse(course, half, to);
}

bool MotionLoads::shows(const Course& course, double length) const {
  const IntervalJet& range = bounds_.range;
  const double dt = length * course.load.motion.length();
  const double bend = std::max(std::abs(range.acceleration.low), std::abs(range.acceleration.high));
  return (range.value.high - range.value.low) * length <= course.allowed ||
         bend * dt * dt * length <= 24.0 * course.allowed;
}

void MotionLoads::seek_beyond(Course& course, Formula& formula, double from, double to) {
  if (++course.looks > most_looks_at_ends) return;
  course.allowed = allowed(formula);
  bound(course, from, to);
  const auto beyond = [&](const Interval& range) { return std::max(range.high - course.high, course.low - range.low); };
  if (!(beyond(bounds_.range.value) > course.allowed)) return;
  const double middle = 0.5 * (from + to), here = beyond(Interval::at(bounds_.at_middle.value));
  if (here > course.allowed) formula.beyond = here, formula.at = course.load.motion.time(middle);
  if (to - from < finest_span) return;
  seek_beyond(course, formula, from, middle);
  seek_beyond(course, formula, middle, to);
}

void MotionLoads::format() {
  if (run_.adaptive) return;
  for (const Load& load : loads_) {
    for (const Formula& formula : load.formulas) {
      const HiddenChange change{.beyond = formula.beyond,
                                .at = formula.at,
                                .range = std::max(formula.high - formula.low, 0.0) + formula.beyond,
                                .unit = load.load->turns ? "N m" : "N"};
      if (!change.counts(run_) && !formula.impulse.counts()) continue;
      if (change.counts(run_)) {
        change.say(run_, load.load->words);
      } else {
        formula.impulse.say(run_, load.load->words);
      }
      break;
    }
  }
  joints_.format();
}

}  // namespace freeplay
