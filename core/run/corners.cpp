#include "run/corners.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/angle.h"
#include "base/index.h"
#include "model/element_name.h"

namespace freeplay {
namespace {

constexpr double smallest_jump = 1e-9;   // of a speed, in parts of the larger one
constexpr double most_lengthened = 4.0;  // steps that go round a singular position are longer than asked for

// Around a kink at t the side is one of rounding.
double margin(double t) { return 4.0 * std::numeric_limits<double>::epsilon() * std::abs(t); }
constexpr double shortest_part = 1e-6;  // of the run, see shortest_change()
constexpr double nearly_a_step = 1e-9;

// What depends on time in a way that cannot be analysed is looked at so closely that no change this long is missed [s].
double shortest_change(const Settings& settings) {
  return std::max(shortest_part * (settings.end - settings.start), settings.interval);
}

}  // namespace

Corners::Corners(RunContext& run, RunFailure& failure, StepAttempt& attempt)
    : run_(run),
      failure_(failure),
      attempt_(attempt),
      one_at_end_(run.kinks.one_at_end() || DriveKinks(run.model, DriveKinks::Of::loads).one_at_end()),
      speed_jumps_(run.model.drivers.size()),
      motion_before_(run.model.drivers.size()),
      motion_after_(run.model.drivers.size()),
      q_before_(run.e_accepted->q.size()),
      v_before_(run.e_accepted->v.size()),
      driven_change_(run.e_accepted->driven_a.size()),
      impulses_(at(run.system.layout().all_rows())) {
  if (!run.adaptive) return;
  inputs_.emplace(run.system, shortest_change(run.settings), run.allowed, &run.idle_loads);
  too_short_ = inputs_->look_closer(shortest_part * (run.settings.end - run.settings.start));
}

void Corners::save(ArchiveWriter& archive) const {
  archive(speed_jumps_, corner_kind_, inputs_.has_value());
  if (inputs_) archive(*inputs_);
}

void Corners::restore(ArchiveReader& archive) {
  bool has_inputs = false;
  archive(speed_jumps_, corner_kind_, has_inputs);
  if (!has_inputs) inputs_.reset();
  ArchiveReader::require(has_inputs == inputs_.has_value());
  if (inputs_) archive(*inputs_);
}

CornerKind Corners::end_step(std::optional<double> corner) {
  if (!inputs_) return corner_kind_ = CornerKind::motion;
  if (!corner) return corner_kind_ = CornerKind::smooth;
  return corner_kind_ = inputs_->kind_of(*corner, *corner - run_.trial.t());
}

bool Corners::next_corner(double dt, double& corner) {
  Fault fault;
  const double until = run_.accepted.t() + most_lengthened * dt;
  const auto next = [&](double t) {
    if (inputs_) return inputs_->next_corner(t, until, corner, fault);
    corner = run_.kinks.next(t, until);
    return true;
  };
  bool good = next(run_.accepted.t());
  while (good && std::isfinite(corner) && corner - margin(corner) <= run_.accepted.t()) good = next(corner);
  const double end = run_.settings.end;
  if (one_at_end_ && before(end) > run_.accepted.t() && end <= until) corner = std::min(corner, end);
  return good || failure_.fail_with(fault, run_.accepted.t());
}

bool Corners::resolve_inputs(double& dt) {
  if (run_.adaptive) dt = run_.path_edges.longest_step(run_.accepted.t(), dt);
  if (!inputs_) return true;
  run_.idle_loads.look(run_.solver.rows(), run_.e_accepted);
  dt = inputs_->resolved(run_.accepted.t(), dt);
  if (!inputs_->watches_joints()) return true;
  const Profile::Timer timer(run_.evaluations.profile, Phase::joints);
  Fault fault;
  return inputs_->resolved_by_joints(point(run_.accepted), run_.e_accepted, run_.accepted.t(), dt, fault) ||
         failure_.fail_with(fault, run_.accepted.t());
}

bool Corners::resolves_joints(double& dt) {
  if (!inputs_ || !inputs_->watches_joints()) return true;
  const Profile::Timer timer(run_.evaluations.profile, Phase::joints);
  Fault fault;
  return inputs_->resolved_by_joints(point(run_.trial), run_.e_trial, run_.accepted.t(), dt, fault) ||
         failure_.fail_with(fault, run_.trial.t());
}

// Whether an effort or a force is another one after the corner.
bool Corners::loads_jump(double corner) {
  const double before = corner - margin(corner), after = corner + margin(corner);
  const auto jumps = [&](double from, double to, double rates) {
    return std::abs(to - from) > smallest_jump * std::max(std::abs(from), std::abs(to)) + 4.0 * margin(corner) * rates;
  };
  if (!look_beside(corner)) return true;  // the run will meet it
  for (std::size_t d = 0; d < run_.model.drivers.size(); ++d) {
    if (prescribes(run_.model.drivers[d].kind)) continue;
    const TimeValue &from = motion_before_[d], &to = motion_after_[d];
    if (jumps(from.value, to.value, std::abs(from.rate) + std::abs(to.rate))) return true;
  }
  const auto one_jumps = [&](const std::vector<Expression>& components) {
    return std::ranges::any_of(components, [&](const Expression& component) {
      Jet from, to;
      EvaluationFailure failure;
      if (!component.evaluate(before, from, failure) || !component.evaluate(after, to, failure)) return true;
      return jumps(from.value, to.value, std::abs(from.rate) + std::abs(to.rate));
    });
  };
  return std::ranges::any_of(run_.model.forces, one_jumps, &AppliedForce::in_time) ||
         std::ranges::any_of(run_.model.drivers, one_jumps, &Driver::in_time) ||
         std::ranges::any_of(run_.model.joints, one_jumps, &JointElement::in_time);
}

double Corners::before(double kink) { return kink - margin(kink); }

// Nothing follows a corner at which the run ends. Else to just after others as well that rounding cannot separate from
// it. Positions stay, the velocities follow the drivers by the least impulse.
bool Corners::pass_kink(double kink) {
  if (run_.settings.end - kink <= margin(kink)) {
    run_.accepted.t() = run_.settings.end;
    return true;
  }
  if (corner_kind_ == CornerKind::smooth || (corner_kind_ == CornerKind::load && !loads_jump(kink))) {
    run_.accepted.t() = kink;
    return true;
  }
  note_jumps(kink);
  const double from = run_.accepted.t();
  for (double next = kink; next - kink <= margin(kink); next = run_.kinks.next(next, kink + margin(kink))) {
    run_.accepted.t() = next + margin(next);
  }
  note_driven(run_.e_accepted);
  StateView view = run_.accepted.view();
  run_.solver.use_history(run_.accepted.h());
  const bool good = run_.solver.project_velocity(view);
  if (!good || !attempt_.evaluate_all(run_.accepted, run_.e_accepted)) {
    const Fault& fault = good ? run_.e_accepted->fault : run_.solver.fault();
    if (fault.kind != Fault::Kind::none) return failure_.fail_with(fault, kink);
    return failure_.fail(4, fmt::format("t = {:.9g} s: {}", kink, run_.solver.trouble()));
  }
  if (const int jumping = row_that_jumps(run_.accepted.t() - from); jumping >= 0) {
    return fail_at_jump(kink, jumping);
  }
  std::ranges::copy(run_.solver.impulse(), impulses_.begin());
  book_impulses(run_.e_accepted);
  if (!attempt_.restart()) return false;
  run_.accepted.t() = kink;
  return true;
}

bool Corners::fail_at_jump(double kink, int row) {
  return failure_.fail(4, fmt::format("t = {:.9g} s: {}: the prescribed position jumps; no motion follows it", kink,
                                      failure_.row_name(row)));
}

bool Corners::stops_at_jump(double kink) {
  if (!look_beside(kink)) return false;
  for (int d = 0; d < static_cast<int>(run_.model.drivers.size()); ++d) {
    const int row = run_.system.layout().driver_row(d);
    const TimeValue &from = motion_before_[at(d)], &to = motion_after_[at(d)];
    const double moves = 4.0 * margin(kink) * (std::abs(from.rate) + std::abs(to.rate));
    const double rounded = smallest_jump * std::max(std::abs(from.value), std::abs(to.value));
    const double least = std::max(smallest_jump * run_.system.size(), rounded) + moves;
    // After a turn a driven body is where it was, as by a table from 0 to 360 degrees that repeats; rows count turns.
    const bool angle = row >= run_.system.layout().nc() &&
                       run_.system.joints().layout(run_.model.drivers[at(d)].joint).coordinate == Coordinate::angle;
    const double by = angle ? wrapped(to.value - from.value) : to.value - from.value;
    if (row >= 0 && std::abs(by) > least) return !fail_at_jump(kink, row);
  }
  return false;
}

// Where drivers and driven bodies are, to be compared with how they go on.
void Corners::note_driven(const Evaluation& e) {
  std::ranges::copy(e.motion, motion_before_.begin());
  std::ranges::copy(e.q, q_before_.begin());
  std::ranges::copy(e.v, v_before_.begin());
}

// By how much positions move in the `passed` time around a kink, and by the rounding of large ones, as after many
// turns.
double Corners::moved_around_kink(double passed) const {
  constexpr double ulps = 16.0 * std::numeric_limits<double>::epsilon();
  double fastest = 0.0, rounding = 0.0;
  for (std::size_t i = run_.accepted.v().size(); i < v_before_.size(); ++i) {
    fastest = std::max({fastest, std::abs(v_before_[i]), std::abs(run_.e_accepted->v[i])});
  }
  for (std::size_t d = 0; d < motion_before_.size(); ++d) {
    if (!prescribes(run_.model.drivers[d].kind)) continue;
    const TimeValue &from = motion_before_[d], &to = run_.e_accepted->motion[d];
    fastest = std::max({fastest, std::abs(from.rate), std::abs(to.rate)});
    rounding = std::max(rounding, ulps * std::abs(to.value));
  }
  return 4.0 * passed * fastest * (1.0 + run_.system.size()) + rounding;
}

// A row that holds a driven body which is elsewhere `passed` after a kink, or that does not hold any more; -1: none.
int Corners::row_that_jumps(double passed) const {
  const double allowed_gap = 1e-9 * run_.system.size() + moved_around_kink(passed);
  for (std::size_t i = run_.accepted.q().size(); i < q_before_.size(); ++i) {
    const std::size_t driven = (i - run_.accepted.q().size()) / 3, part = (i - run_.accepted.q().size()) % 3;
    const double by = run_.e_accepted->q[i] - q_before_[i];
    if (std::abs(part == 2 ? wrapped(by) : by) > allowed_gap) return run_.system.driven().last_row(driven);
  }
  for (std::size_t r = 0; r < run_.e_accepted->phi.size(); ++r) {
    if (std::abs(run_.e_accepted->phi[r]) > allowed_gap) return static_cast<int>(r);
  }
  return -1;
}

// The work of `impulses` in rows of unknowns, and of those that changed the velocities of driven bodies to those in
// `after`. At rows that do not move by themselves an impulse does no work.
void Corners::book_impulses(Evaluation& after) {
  const std::size_t first = run_.accepted.v().size();
  for (std::size_t i = 0; i < driven_change_.size(); ++i) driven_change_[i] = after.v[first + i] - v_before_[first + i];
  run_.system.driven().recover_impulses(after, driven_change_, impulses_);
  for (int d = 0; d < static_cast<int>(run_.model.drivers.size()); ++d) {
    const int r = run_.system.layout().driver_row(d);
    if (r < 0) continue;
    const double work = -impulses_[at(r)] * 0.5 * (motion_before_[at(d)].rate + after.motion[at(d)].rate);
    run_.energy.add_driver_work(d, work);
    if (run_.flows > 0) run_.accepted.z().last(at(run_.flows))[at(d)] += work;
  }
}

// Of a step of fixed size that went over a kink: the work of the blow on driven bodies. That on others is part of the
// step.
void Corners::book_jump(double kink) {
  Point here = point(run_.accepted);
  const auto look = [&](double t) {
    here.t = t;
    return run_.system.evaluate(here, term_position, run_.e_between);
  };
  if (!look(kink - margin(kink))) return;
  note_driven(run_.e_between);
  if (!look(kink + margin(kink))) return;
  std::ranges::fill(impulses_, 0.0);
  book_impulses(run_.e_between);
}

// Motions before and after a kink. False where there is none, which the run will meet.
bool Corners::look_beside(double kink) {
  MotionFault fault;
  return run_.system.motions().evaluate(kink - margin(kink), {motion_before_.data(), motion_before_.size()},
                                        run_.motion_work, fault) &&
         run_.system.motions().evaluate(kink + margin(kink), {motion_after_.data(), motion_after_.size()},
                                        run_.motion_work, fault);
}

// Whether the speed of a driver jumps.
bool Corners::note_jumps(double kink) {
  if (!look_beside(kink)) return false;
  bool any = false;
  for (std::size_t d = 0; d < speed_jumps_.size(); ++d) {
    if (run_.system.layout().driver_row(static_cast<int>(d)) < 0) continue;
    const double from = motion_before_[d].rate, to = motion_after_[d].rate;
    const double steady = std::abs(motion_before_[d].acceleration) + std::abs(motion_after_[d].acceleration);
    if (std::abs(to - from) <= smallest_jump * std::max(std::abs(from), std::abs(to)) + 4.0 * margin(kink) * steady) {
      continue;
    }
    any = true;
    if (speed_jumps_[d].count++ == 0) speed_jumps_[d] = {1, kink, from, to};
  }
  return any;
}

// What a joint of a plugin declares of its dependence on time, where no change was seen.
void Corners::format_declared(double step, std::span<const std::string> said) {
  for (int j = 0; j < static_cast<int>(run_.model.joints.size()); ++j) {
    const double scale = run_.system.joints().layout(j).time_scale;
    const std::string element = written_name(run_.model.joints[at(j)]);
    if (!(scale > 0.0 && scale < step * (1.0 - nearly_a_step)) || std::ranges::count(said, element) > 0) continue;
    run_.warnings.push_back(
        fmt::format("{}: it declares that it changes within {:.2g} s, which the step of {:.3g} s goes over; ask for an "
                    "accuracy instead, or for steps of {:.2g} s",
                    element, scale, step, 0.25 * scale));
    run_.outcome.doubts.push_back(
        {.id = "unresolved-input",
         .level = Trust::doubtful,
         .message =
             fmt::format("{} declares changes within {:.2g} s, which steps of {:.3g} s go over", element, scale, step),
         .element = element,
         .value = scale,
         .limit = step});
  }
}

namespace {

/// What is wrong with a step, in words of a warning and of a verdict, and how long it may be.
struct Unseen {
  std::string warning, message;
  double wanted, value, limit;
};

Unseen words_of(const InputActivity::Unresolved& input, double step) {
  const double apart = input.to - input.from;
  if (input.corners) {
    return {
        fmt::format("it has corners at {:.9g} s and {:.9g} s, closer than the step of {:.3g} s, which goes over what "
                    "it does between them",
                    input.from, input.to, step),
        fmt::format("has corners {:.3g} s apart, closer than the step of {:.3g} s", apart, step), 0.1 * apart, apart,
        step};
  }
  if (const JumpError& error = input.jumps; error.jumps > 0) {
    return {fmt::format("it jumps inside {} steps of {:.3g} s, which take a jump for one in their middle: that makes "
                        "{:.0f} % of the way that it would move a free mass",
                        error.jumps, step, 100.0 * error.part),
            fmt::format("jumps inside {} steps of {:.3g} s, which are {:.0f} % off what it does", error.jumps, step,
                        100.0 * error.part),
            0.1 * step * InputActivity::off_by_jumps / error.part, error.part, InputActivity::off_by_jumps};
  }
  return {fmt::format("it changes at t = {:.9g} s for some {:.2g} s, which the step of {:.3g} s goes over",
                      input.from + 0.5 * apart, apart, step),
          fmt::format("changes at t = {:.9g} s in a way that steps of {:.3g} s do not show", input.from + 0.5 * apart,
                      step),
          0.25 * apart, apart, step};
}

}  // namespace

void Corners::format_unresolved() {
  if (run_.adaptive) return format_too_short();
  const double step = std::min(run_.settings.step, run_.settings.interval);
  std::vector<std::string> said;
  for (const InputActivity::Unresolved& input : InputActivity(run_.system, run_.settings.interval, 0.0)
                                                    .unresolved_by(step, point(run_.accepted), run_.e_accepted)) {
    const std::string element = said.emplace_back(fmt::format("{} '{}'", input.section, *input.name));
    const Unseen words = words_of(input, step);
    run_.warnings.push_back(fmt::format("{}: {}; ask for an accuracy instead, or for steps of {:.2g} s", element,
                                        words.warning, words.wanted));
    run_.outcome.doubts.push_back({.id = "unresolved-input",
                                   .level = Trust::doubtful,
                                   .message = fmt::format("{} {}", element, words.message),
                                   .element = element,
                                   .value = words.value,
                                   .limit = words.limit});
  }
  format_declared(step, said);
}

// With error control nothing is gone over but what lasts less than the times of the run are looked at.
void Corners::format_too_short() {
  const double least = shortest_part * (run_.settings.end - run_.settings.start);
  for (const InputActivity::Unresolved& input : too_short_) {
    const std::string element = fmt::format("{} '{}'", input.section, *input.name);
    const double lasts = input.to - input.from;
    const std::string what = fmt::format("changes at t = {:.9g} s for some {:.2g} s, less than a millionth of the run",
                                         input.from + 0.5 * lasts, lasts);
    run_.warnings.push_back(
        fmt::format("{}: it {}, which steps may go over; write it with smooth(), min(), max() or a table, at whose "
                    "corners steps end, or end the run earlier",
                    element, what));
    run_.outcome.doubts.push_back({.id = "unresolved-input",
                                   .level = Trust::doubtful,
                                   .message = fmt::format("{} {}, which steps may go over", element, what),
                                   .element = element,
                                   .value = lasts,
                                   .limit = least});
  }
}

void Corners::format_jumps() {
  for (std::size_t d = 0; d < speed_jumps_.size(); ++d) {
    const SpeedJump& jump = speed_jumps_[d];
    if (jump.count == 0) continue;
    const Driver& driver = run_.model.drivers[d];
    const bool angle = run_.system.joints().layout(driver.joint).coordinate == Coordinate::angle;
    std::string text =
        fmt::format("driver '{}' at t = {:.9g} s: the speed that it prescribes jumps from {:.4g} to {:.4g} {}",
                    driver.name, jump.time, jump.from, jump.to, angle ? "rad/s" : "m/s");
    if (jump.count > 1) text += fmt::format(", the first of {} jumps", jump.count);
    run_.warnings.push_back(
        text + (run_.adaptive
                    ? ": taken as a blow, whose work is booked and whose force is not in the results"
                    : ": a blow, of which a step of this size makes a large force; ask for an accuracy instead"));
  }
}

}  // namespace freeplay
