#include "run/simulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "base/index.h"
#include "component/declared.h"
#include "component/joint_answer.h"
#include "component/own_types.h"
#include "run/simulation_impl.h"
#include "system/finite.h"

namespace freeplay {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double unnoticed_turn = 1e-3;     // of a body [rad]
constexpr double largest_uninformed = 0.2;  // of the largest step, with an accuracy: see StepLimits
constexpr double shortest_part = 1e-6;      // of the run, see shortest_change()
constexpr double accuracy_per_step = 0.15;  // part of the accuracy per second that one step may cost

std::string integrator_words(const Model& model) {
  return "the integrator of " + model.instances.words_of(*model.settings.integrator_parameters.component);
}

// `flows`: integrals that the host would like to be carried along; taken by integrators that can.
IntegratorLayout declare(const System& system, int flows) {
  const Layout& layout = system.layout();
  const auto ask = [&](int more) {
    IntegratorLayout out;
    out.sizes = {layout.nq(), layout.nv(), layout.nc(), layout.nz() + more};
    Message message;
    const bool good = system.model().settings.integrator.declare(out, message);
    const std::string fault = good ? declaration_fault(out) : message.text;
    if (!good || !fault.empty()) {
      throw Error(Error::Category::plugin, "plugin-failed",
                  fmt::format("{} failed: {}", integrator_words(system.model()), fault));
    }
    return out;
  };
  const IntegratorLayout plain = ask(0);
  return plain.explicit_stages != 0 ? ask(flows) : plain;
}

// Length by which positions may err in one step [m].
double local_tolerance(const System& system) {
  const Settings& settings = system.model().settings;
  if (settings.accuracy > 0.0) return accuracy_per_step * settings.accuracy;
  double unit = system.size();
  for (int j = 0; j < static_cast<int>(system.model().joints.size()); ++j) {
    const double clearance = system.joint_layout(j).clearance;
    if (clearance > 0.0) unit = std::min(unit, clearance);
  }
  return settings.tolerance * unit;
}

// What depends on time in a way that cannot be analysed is looked at so closely that no change this long is missed [s].
double shortest_change(const Settings& settings) {
  return std::max(shortest_part * (settings.end - settings.start), settings.interval);
}

StepLimits step_limits(const Settings& settings) {
  return {settings.step, settings.smallest_step, settings.largest_step,
          settings.accuracy > 0.0 ? largest_uninformed * settings.largest_step : settings.largest_step};
}

EventStorm::Limits storm_limits(const Settings& settings, bool adaptive) {
  const double latest = std::max(std::abs(settings.start), std::abs(settings.end));
  const double instant = std::max(2048.0 * rounding * latest, adaptive ? settings.smallest_step : 0.0);
  return {instant, adaptive ? settings.step : 0.0, StepEvents::most_per_step};
}

// Multipliers that are not determined come out with efforts of drivers as small as can be: these must be among the
// unknowns.
Unknowns unknowns_of(const ModelFacts& facts) {
  const bool determined = facts.actual.redundant == 0 && facts.actual.driver_redundant == 0;
  return determined ? Unknowns::free_bodies : Unknowns::all_bodies;
}

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

Simulation::Impl::Impl(const System& owner, const Start& start, const Channels& all_channels,
                       std::span<Sink* const> all_sinks)
    : all_bodies(owner),
      first_start(start),
      system(owner.model(), Variant::released, unknowns_of(start.facts)),
      model(owner.model()),
      settings(model.settings),
      channels(all_channels),
      sinks(all_sinks.begin(), all_sinks.end()),
      energy(system),
      integrator_layout(declare(system, energy.flows())),
      adaptive(settings.adaptive || integrator_layout.always_adaptive != 0),
      flows(integrator_layout.explicit_stages != 0 ? energy.flows() : 0),
      solver(system, {.tolerance = integrator_layout.newton_tolerance,
                      .max_iterations = integrator_layout.newton_max_iterations}),
      control(step_limits(settings),
              integrator_layout.error_order > 0 ? integrator_layout.error_order : integrator_layout.order + 1),
      accepted(system.layout(), integrator_layout.memory, flows),
      trial(system.layout(), integrator_layout.memory, flows),
      between(system.layout(), integrator_layout.memory, flows),
      e_accepted(system),
      e_trial(system),
      own_between(adaptive ? std::optional<KeptEvaluation>(std::in_place, system) : std::nullopt),
      e_between(own_between ? *own_between : solver.evaluation()),
      observer(system, all_channels),
      events(system, adaptive, between, e_between),
      storm(model.joints.size(), storm_limits(settings, adaptive)),
      resting(system),
      kinks(model),
      statistics(model, all_channels, adaptive),
      watch(system, all_channels),
      peaks(statistics.peak_values().size()),
      scratch(at(integrator_layout.scratch) + guard::marks),
      row(all_channels.all().size(), 0.0),
      row_between(all_channels.all().size(), 0.0),
      residual(at(system.layout().nc())),
      z_rate(at(system.layout().nz() + flows)),
      flow_half_way(at(energy.flows())),
      defect(at(system.layout().nv())),
      inner(at(system.layout().nv()), z_rate.size()),
      inner_before(defect.size()),
      rate_defect(defect.size()),
      start_rate(z_rate.size()),
      end_rate(z_rate.size()),
      joint_warnings(model.joints.size()),
      speed_jumps(model.drivers.size()),
      motion_before(model.drivers.size()),
      motion_behind(model.drivers.size()),
      q_before(e_accepted->q.size()),
      v_before(e_accepted->v.size()),
      driven_change(e_accepted->driven_a.size()),
      impulses(at(system.layout().all_rows())) {
  if (adaptive) {
    allowed = local_tolerance(system);
    require_attainable_accuracy(system);
    // An accuracy is kept per second; a tolerance is relative in velocity, too.
    solver.control_error(allowed, allowed, settings.accuracy > 0.0 ? 0.0 : settings.tolerance);
    system.end_steps_at_events(settings.per_contact);
    inputs.emplace(system, shortest_change(settings), allowed);
  }
  if (flows > 0) solver.integrate_flows(energy);
  system.begin_at(owner, start.state, accepted);
  for (const StopCondition& stop : settings.stop) stop_columns.push_back(channels.find(stop.channel));
  std::size_t values = 0;
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointLayout& layout = system.joint_layout(j);
    if (layout.history > 0) with_history.push_back(j);
    if (const int turn = system.layout().turn(j); turn >= 0) turns.push_back({at(turn), at(j)});
    joint_warnings[at(j)].values = values;
    values += layout.channels.size;
  }
  warning_values.resize(values);
  if (system.angles_follow_bodies())
    angle_then.assign(e_accepted->q.size() / 3, std::numeric_limits<double>::quiet_NaN());
}

bool Simulation::Impl::fail(int exit_code, std::string reason) {
  outcome.status = RunStatus::failed;
  outcome.exit_code = exit_code;
  outcome.reason = std::move(reason);
  return false;
}

bool Simulation::Impl::fail_with(const Fault& fault, double t) {
  if (fault.kind == Fault::Kind::motion) {
    const MotionFault& motion = fault.motion;
    std::string who;
    if (motion.driver >= 0) who = fmt::format("driver '{}': ", model.drivers[at(motion.driver)].name);
    if (motion.force >= 0) who = fmt::format("force '{}': ", model.forces[at(motion.force)].name);
    if (motion.kinematics >= 0) who = fmt::format("driver '{}': ", model.kinematics[at(motion.kinematics)].name);
    return fail(4, fmt::format("t = {:.9g} s: {}{} [{}]", t, who, motion.text, motion.id));
  }
  const JointElement& joint = model.joints[at(fault.joint)];
  if (fault.of_expression()) {
    return fail(4,
                fmt::format("t = {:.9g} s: joint '{}': {} [{}]", t, joint.name, fault.message.text, fault.message.id));
  }
  if (std::string_view(fault.message.text).ends_with("not a finite number") && all_built_in()) {
    return fail(4, why_beyond_bounds(t, fault.joint));
  }
  // A law of the program has an end: numbers of the model have led there, and no plugin is at fault.
  if (is_built_in(model.instances, *joint.component, joint.parameters.get())) {
    failed_joint = fault.joint;
    return fail(4, fmt::format("t = {:.9g} s: joint '{}': {} [law-range]", t, joint.name, fault.message.text));
  }
  return fail(5, fmt::format("t = {:.9g} s: joint '{}' of {} failed: {} [plugin-failed]", t, joint.name,
                             model.instances.words_of(*joint.component), fault.message.text));
}

/// A joint has written past the end of the state's history.
bool Simulation::Impl::fail_beside(int joint) {
  Fault fault;
  fault.kind = Fault::Kind::plugin;
  fault.joint = joint;
  abi::copy_text(fault.message.text, sizeof fault.message.text, "it wrote beside its history");
  return fail_with(fault, accepted.t());
}

std::string Simulation::Impl::row_name(int row_index) const {
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    if (system.layout().driver_row(d) == row_index) return fmt::format("driver '{}'", model.drivers[at(d)].name);
  }
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const Slice rows = system.layout().rows(j);
    if (row_index >= rows.offset && row_index < rows.offset + rows.size) {
      return fmt::format("joint '{}'", model.joints[at(j)].name);
    }
  }
  return {};
}

// Of the joints at a body, or of all (ground), the one that pulls hardest; -1 when none has a force.
int Simulation::Impl::hardest_joint(BodyId body) const {
  double largest = 0.0;
  int hardest = -1;
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointElement& joint = model.joints[at(j)];
    if (joint.gear >= 0) continue;
    if (body != ground && model.markers[at(joint.marker_a)].body != body &&
        model.markers[at(joint.marker_b)].body != body) {
      continue;
    }
    double wrench[6];
    system.reaction(j, e_accepted, accepted.lambda(), wrench);
    const double force = std::hypot(std::hypot(wrench[0], wrench[1]), wrench[2]);
    if (force > largest) largest = force, hardest = j;
  }
  return hardest;
}

std::string Simulation::Impl::why_not_converged(double dt) const {
  if (left_bounds) return why_beyond_bounds(accepted.t(), -1);
  std::string text = fmt::format("t = {:.9g} s: no step of {:.3g} s or longer could be made: {}", accepted.t(), dt,
                                 *solver.trouble() ? solver.trouble() : "the integrator gave up");
  if (const std::string worst = row_name(solver.worst_row()); !worst.empty()) text += "; worst is " + worst;
  // A force law that pulls hardest is the usual suspect where no constraint is.
  double largest = 0.0;
  int suspect = -1;
  for (const ForceBlock& block : system.force_blocks()) {
    const double* wrench = &e_accepted->wrench[12 * at(block.joint) + 6];
    const double force = std::hypot(std::hypot(wrench[0], wrench[1]), wrench[2]);
    if (force > largest) largest = force, suspect = block.joint;
  }
  if (suspect >= 0) {
    text += fmt::format("; the largest force is {:.4g} N in joint '{}'", largest, model.joints[at(suspect)].name);
  }
  return text + std::string(advice::smaller_step);
}

bool Simulation::Impl::begin() {
  const Profile::Timer timer(system.profile(), Phase::start);
  e_accepted->forget_motions();
  if (!system.evaluate(point(accepted), all_terms, e_accepted)) return fail_with(e_accepted->fault, accepted.t());
  system.fill_driven_jacobian(e_accepted);
  system.recover_loads(e_accepted, accepted.lambda());
  StateView view = accepted.view();
  Message message;
  solver.use_history(accepted.h());
  if (!settings.integrator.restart(view, solver.table(), message)) {
    if (solver.fault().kind != Fault::Kind::none) return fail_with(solver.fault(), accepted.t());
    return fail(5, fmt::format("t = {:.9g} s: {} failed at the start: {} [plugin-failed]", accepted.t(),
                               integrator_words(model), message.text));
  }
  Fault fault;
  if (!events.at_start(accepted, e_accepted, fault)) return fail_with(fault, accepted.t());
  if (!observer.observe(point(accepted), e_accepted, accepted.lambda(), row, fault)) {
    return fail_with(fault, accepted.t());
  }
  energy.start(e_accepted, accepted.lambda(), channels, row);
  explained_energy = energy_of(e_accepted);
  note_event_directions();
  note_first_forces();
  row_is_known = true;
  return record_step() && watch_row(0.0) && tell_sinks();
}

// The joints' history in `state` at the begin of a step of the length dt from the accepted state.
bool Simulation::Impl::begin_steps(double dt, State& state) {
  const Profile::Timer timer(system.profile(), Phase::joints);
  std::ranges::copy(accepted.h(), state.h().begin());
  const Point here{accepted.t(), accepted.q(), accepted.v(), accepted.z(), accepted.h()};
  if (!adaptive && !resting.begin(dt, here, e_accepted, e_trial->fault)) {
    return fail_with(e_trial->fault, accepted.t());
  }
  for (const int j : with_history) {
    if (system.rest(j).now) continue;
    const Slice h = system.layout().history(j);
    MarkerAccelerations accelerations;
    system.marker_accelerations(j, e_accepted, accepted.a(), accelerations);
    const Span<double> history = Span<double>(state.h()).part(at(h.offset), at(h.size));
    if (!system.joint(j).begin_step(system.input(j, here, e_accepted), accelerations, dt, history,
                                    e_trial->fault.message) ||
        !keeps_finite({}, history, "begin_step", e_trial->fault.message)) {
      e_trial->fault.kind = Fault::Kind::plugin;
      e_trial->fault.joint = j;
      return fail_with(e_trial->fault, accepted.t());
    }
    if (!state.intact()) return fail_beside(j);
  }
  return true;
}

// Everything about a state whose accelerations the solver knows, and the loads of driven bodies; at the end of a fixed
// step only what joints ask for: the rest is completed for a row.
bool Simulation::Impl::evaluate_all(State& state, KeptEvaluation& e) {
  turns_are_due = adaptive || have_turned(solver.evaluation());
  const unsigned in_step = of_equations | term_event | (turns_are_due ? term_turn : 0u) | only_asked;
  const unsigned terms = adaptive ? all_terms : in_step;
  if (!system.evaluate(point(state), terms, solver.evaluation(), e)) return false;
  system.fill_driven_jacobian(e);
  system.recover_loads(e, state.lambda());
  return true;
}

// In fixed steps angles of joints that follow those of bodies are looked at where one has turned a little: the next
// look finds the turn nearest to the last.
bool Simulation::Impl::have_turned(const Evaluation& e) const {
  if (angle_then.empty()) return true;
  int turned = 0;
  for (std::size_t b = 0; b < angle_then.size(); ++b) {
    turned += std::abs(e.q[3 * b + 2] - angle_then[b]) <= unnoticed_turn ? 0 : 1;
  }
  return turned != 0;
}

void Simulation::Impl::note_turns(const Evaluation& e, std::span<double> history) {
  for (const auto [turn, joint] : turns) history[turn] = e.coordinate[joint];
  for (std::size_t b = 0; b < angle_then.size(); ++b) angle_then[b] = e.q[3 * b + 2];
}

bool Simulation::Impl::step(double dt, bool& converged) {
  converged = false;
  plugin_fault.kind = Fault::Kind::none;
  inner.forget();
  trial.assign(accepted);
  if (!begin_steps(dt, trial)) return false;
  solver.use_history(trial.h());
  if (adaptive) solver.local_error().begin_attempt(accepted.v());
  const Profile::Timer timer(system.profile(), Phase::integrator);
  StateView view = trial.view();
  Attempt attempt{};
  Message message;
  guard::set(scratch_space().end());
  const bool good = settings.integrator.attempt(dt, view, scratch_space(), solver.table(), attempt, message);
  if (!guard::intact(scratch_space().end()) || !trial.intact()) {
    return fail(5, fmt::format("t = {:.9g} s: {} failed: it wrote beside the state, its memory or its scratch "
                               "[plugin-failed]",
                               accepted.t(), integrator_words(model)));
  }
  if (!good) {
    // A joint may fail at a trial state that a shorter step does not meet; a driver fails by its time alone.
    plugin_fault = solver.fault();
    if (plugin_fault.kind == Fault::Kind::plugin) return true;
    if (plugin_fault.kind == Fault::Kind::motion) return fail_with(plugin_fault, *view.t);
    if (!*solver.trouble()) {
      return fail(5, fmt::format("t = {:.9g} s: {} failed: {} [plugin-failed]", accepted.t(), integrator_words(model),
                                 message.text));
    }
    return true;  // the solver gave up: a shorter step may do
  }
  converged = attempt.converged != 0;
  error = attempt.error;
  const bool rejected = adaptive && !(error <= 1.0);  // whatever it left
  left_bounds = false;
  if (!converged || rejected) return true;
  if (!check_step(dt)) return false;
  converged = !left_bounds;
  return true;
}

/// What an integrator that says that it converged must have left.
bool Simulation::Impl::check_step(double dt) {
  const double expected = accepted.t() + dt;
  if (!(std::abs(trial.t() - expected) <= 1e-9 * dt + 4.0 * rounding * std::abs(expected))) {
    return fail(5, fmt::format("t = {:.9g} s: {} failed: a step to {:.9g} s ends at {:.9g} s [plugin-failed]",
                               accepted.t(), integrator_words(model), expected, trial.t()));
  }
  if (is_finite(Span<const double>(trial.before_history()))) return true;
  if (all_built_in()) {
    left_bounds = true;  // a step that was too long for the forces: a shorter one may do
    return true;
  }
  return fail(5, fmt::format("t = {:.9g} s: {} failed: it left a state that is not a finite number [plugin-failed]",
                             accepted.t(), integrator_words(model)));
}

// Where neither the integrator carries the flows nor the steps before tell how they go, forces are looked at once more
// in the middle of the step.
void Simulation::Impl::add_energy() {
  const double dt = trial.t() - accepted.t();
  if (flows > 0 || energy.flows() == 0) {
    return energy.take(dt, e_trial, trial.lambda(), std::span<const double>(trial.z()).last(at(flows)));
  }
  if (energy.add_smooth(dt, e_trial, trial.lambda())) return;
  DenseStep(system, accepted, e_accepted->internal_rate, trial, e_trial->internal_rate).at(0.5, between);
  std::ranges::copy(trial.h(), between.h().begin());  // as the attempt had it
  // A state that no joint can be asked at is left out of the sum: the ends speak for it.
  const bool seen = system.evaluate(point(between), term_force | only_asked, e_between);
  energy.flow(seen ? e_between : e_trial, between.lambda(), flow_half_way);
  energy.add(dt, flow_half_way, e_trial, trial.lambda());
}

// Of a step whose end is evaluated in e_trial: events first, then the joints' history, then it is the accepted state.
// A finite `kink` lies at its end.
bool Simulation::Impl::accept(const StepEvents::Passage& located, double kink) {
  const double dt = trial.t() - accepted.t();
  add_energy();
  if (adaptive && (!write_rows_inside() || !begin_statistics_inside())) return false;
  const bool expected = adaptive && (located.joint >= 0 || kink < unbounded);
  if (expected && !note_abrupt_end()) return false;
  Fault fault;
  const auto mobility = [](void* self, int joint, double* out) {
    auto& run = *static_cast<Impl*>(self);
    return run.solver.mobility(run.trial, joint, {out, 9});
  };
  {
    const Profile::Timer timer(system.profile(), Phase::events);
    if (!events.apply(accepted, e_accepted, trial, e_trial, fault) ||
        !events.tell_at_end(located, adaptive ? event_lateness() : 0.0, trial, e_trial, mobility, this, fault)) {
      return fail_with(fault, trial.t());
    }
  }
  const Point end = point(trial);
  const Span<double> all_history(trial.h());
  const double* const lambda = trial.lambda().data();
  for (const int j : with_history) {
    if (system.rest(j).now) continue;
    const Slice h = system.layout().history(j), rows = system.layout().rows(j);
    const Span<double> history = all_history.part(at(h.offset), at(h.size));
    if (!system.joint(j).commit(system.input(j, end, e_trial), {lambda + rows.offset, at(rows.size)}, history,
                                fault.message) ||
        !keeps_finite({}, history, "commit", fault.message)) {
      fault.kind = Fault::Kind::plugin;
      fault.joint = j;
      return fail_with(fault, trial.t());
    }
    if (!trial.intact()) return fail_beside(j);
  }
  if (turns_are_due) note_turns(e_trial, trial.h());
  std::swap(accepted, trial);
  swap(e_accepted, e_trial);
  outcome.time = accepted.t();
  const bool changed = !events.happenings().empty() || ended_inside;
  ended_inside = false;
  ended_abruptly = changed || expected;
  if ((changed && !refresh()) || (kink < unbounded && !pass_kink(kink))) {
    // The row of the last state from which the run could go on may still be asked for.
    std::swap(accepted, trial);
    swap(e_accepted, e_trial);
    return false;
  }
  row_is_known = false;
  if (!record_step()) return false;
  outcome.smallest_step = outcome.steps == 0 ? dt : std::min(outcome.smallest_step, dt);
  outcome.largest_step = std::max(outcome.largest_step, dt);
  ++outcome.steps;  // from now on its row may be written
  return watch_row(dt) && note_warnings() && tell_sinks();
}

// An event changes history or internal variables, and with them what acts: the integrator starts again from here.
bool Simulation::Impl::refresh() {
  StateView view = accepted.view();
  solver.use_history(accepted.h());
  Message message;
  const bool solved = solver.accelerate(view, {z_rate.data(), z_rate.size()});
  if (!solved || !settings.integrator.restart(view, solver.table(), message)) {
    if (solver.fault().kind != Fault::Kind::none) return fail_with(solver.fault(), accepted.t());
    if (!solved) return fail(4, fmt::format("t = {:.9g} s: {}", accepted.t(), solver.trouble()));
    return fail(5, fmt::format("t = {:.9g} s: {} failed: {} [plugin-failed]", accepted.t(), integrator_words(model),
                               message.text));
  }
  if (!evaluate_all(accepted, e_accepted)) return fail_with(e_accepted->fault, accepted.t());
  energy.renew(e_accepted, accepted.lambda());
  return true;
}

bool Simulation::Impl::check_stop() {
  for (std::size_t i = 0; i < settings.stop.size(); ++i) {
    const StopCondition& stop = settings.stop[i];
    if (stop_columns[i] < 0 || accepted.t() < stop.after) continue;
    if (!know_row()) return false;
    const double value = row[at(stop_columns[i])];
    if (stop.above ? value <= stop.limit : value >= stop.limit) continue;
    outcome.status = RunStatus::stopped;
    outcome.reason = fmt::format("{} = {:.9g} is {} {:.9g} at t = {:.9g} s", stop.channel, value,
                                 stop.above ? "above" : "below", stop.limit, accepted.t());
    return false;
  }
  return true;
}

bool Simulation::Impl::check_interrupt(const RunHooks& hooks) {
  if (hooks.interrupt && hooks.interrupt->load(std::memory_order_relaxed) != 0) {
    outcome.status = RunStatus::interrupted;
    outcome.exit_code = 130;
    outcome.reason = fmt::format("interrupted at t = {:.9g} s", accepted.t());
    return false;
  }
  if (hooks.progress && outcome.steps % 16 == 0) {
    const double now = seconds_since(started);
    if (now - last_progress >= 0.1) {
      last_progress = now;
      hooks.progress(accepted.t(), outcome.steps);
    }
  }
  return true;
}

double Simulation::Impl::row_time(long index) const {
  const double t = settings.start + static_cast<double>(index) * settings.interval;
  return t > settings.end - 1e-9 * settings.interval ? settings.end : t;
}

Outcome Simulation::Impl::run(const RunHooks& hooks) {
  started = Clock::now();
  system.set_profile(hooks.profile);
  if (hooks.profile != nullptr) hooks.profile->start();
  if (hooks.blind_to_inputs) inputs.reset();
  outcome.time = accepted.t();
  if (begin() && write_row()) adaptive ? run_adaptive(hooks) : run_fixed(hooks);
  outcome.wall_seconds = seconds_since(started);
  explain_dead_point();
  if (hooks.profile != nullptr) hooks.profile->stop();
  system.set_profile(nullptr);
  outcome.iterations = solver.iterations();
  outcome.factorizations = solver.factorizations();
  format_warnings();
  note_unused_play();
  explain_failure();
  format_jumps();
  format_unresolved();
  return outcome;
}

Simulation::Simulation(System& system, const Start& start, const Channels& channels, std::span<Sink* const> sinks)
    : impl_(std::make_unique<Impl>(system, start, channels, sinks)) {}
Simulation::~Simulation() = default;
Outcome Simulation::run(const RunHooks& hooks) { return impl_->run(hooks); }
const Statistics& Simulation::statistics() const { return impl_->statistics; }
const RunExtremes& Simulation::extremes() const { return impl_->watch.seen(); }
std::span<const double> Simulation::last_row() const { return impl_->row; }
std::span<const std::string> Simulation::warnings() const { return impl_->warnings; }

void require_sound_integrator(const System& system) { declare(system, EnergyAccount(system).flows()); }

void require_attainable_accuracy(const System& system) {
  const Settings& settings = system.model().settings;
  const double tolerance = local_tolerance(system), smallest = 8.0 * rounding * system.size();
  if (tolerance >= smallest || !(settings.adaptive || settings.accuracy > 0.0)) return;
  throw Error(Error::Category::input, "out-of-range",
              fmt::format("a step may err by {:.3g} m, but positions of a model of {:.3g} m are rounded to {:.3g} m",
                          tolerance, system.size(), smallest),
              settings.accuracy_location, "ask for less accuracy");
}

}  // namespace freeplay
