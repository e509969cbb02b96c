#include "run/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "component/declared.h"
#include "run/energy_account.h"
#include "run/newton_stage_solver.h"
#include "run/observer.h"
#include "run/step_events.h"

namespace freeplay {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
constexpr double smallest_step = 1e-3;  // of the step asked for

std::string integrator_words(const Model& model) {
  return "the integrator of " + model.instances.words_of(*model.settings.integrator_parameters.component);
}

IntegratorLayout declare(const System& system) {
  const Layout& layout = system.layout();
  IntegratorLayout out;
  out.sizes = {layout.nq(), layout.nv(), layout.nc(), layout.nz()};
  Message message;
  const bool good = system.model().settings.integrator.declare(out, message);
  const std::string fault = good ? declaration_fault(out) : message.text;
  if (!good || !fault.empty()) {
    throw Error(Error::Category::plugin, "plugin-failed",
                fmt::format("{} failed: {}", integrator_words(system.model()), fault));
  }
  return out;
}

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

struct Simulation::Impl {
  Impl(System& owner, const Start& start, const Channels& all_channels, std::span<Sink* const> all_sinks)
      : system(owner),
        model(owner.model()),
        settings(model.settings),
        channels(all_channels),
        sinks(all_sinks.begin(), all_sinks.end()),
        integrator_layout(declare(owner)),
        solver(owner, {integrator_layout.newton_tolerance, integrator_layout.newton_max_iterations}),
        accepted(owner.layout(), integrator_layout.memory),
        trial(owner.layout(), integrator_layout.memory),
        e_accepted(owner),
        e_trial(owner),
        observer(owner, all_channels),
        energy(owner),
        events(owner),
        statistics(model, all_channels),
        scratch(at(integrator_layout.scratch) + guard::marks),
        row(all_channels.all().size(), 0.0),
        flow(at(owner.layout().nc())) {
    accepted.assign(start.state);
    for (const StopCondition& stop : settings.stop) stop_columns.push_back(channels.find(stop.channel));
    for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
      const JointLayout& layout = owner.joint_layout(j);
      if (layout.history > 0) with_history.push_back(j);
    }
  }

  Outcome run(const RunHooks& hooks);

  // The parts of a run; each returns false when the run is over, with `outcome` filled.
  bool begin();
  bool advance_to(double target, const RunHooks& hooks);
  bool step(double dt, bool& converged);
  bool check_step(double dt);
  /// The numbers that an attempt may use as it likes; behind them stand marks.
  Span<double> scratch_space() { return {scratch.data(), scratch.size() - guard::marks}; }
  bool prepare_trial(double dt);
  bool accept();
  bool record_row();
  bool tell_sinks();
  bool check_stop();
  bool check_interrupt(const RunHooks& hooks);

  bool fail(int exit_code, std::string reason);
  bool fail_with(const Fault& fault, double t);
  bool fail_beside(int joint);
  std::string why_not_converged(double dt) const;
  std::string row_name(int row_index) const;

  System& system;
  const Model& model;
  const Settings& settings;
  const Channels& channels;
  std::vector<Sink*> sinks;
  IntegratorLayout integrator_layout;
  NewtonStageSolver solver;
  State accepted, trial;
  Evaluation e_accepted, e_trial;
  Observer observer;
  EnergyAccount energy;
  StepEvents events;
  Statistics statistics;
  std::vector<double> scratch, row, flow;
  std::vector<int> stop_columns, with_history;
  std::vector<std::string> warnings;
  Outcome outcome;
  Fault plugin_fault;  // of the last attempt
  Clock::time_point started;
  double last_progress = 0.0;
  static constexpr unsigned all_terms = term_position | term_velocity | term_force | term_coordinate;
};

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

std::string Simulation::Impl::why_not_converged(double dt) const {
  std::string text = fmt::format("t = {:.9g} s: no step of {:.3g} s or longer could be made: {}", accepted.t(), dt,
                                 *solver.trouble() ? solver.trouble() : "the integrator gave up");
  if (const std::string worst = row_name(solver.worst_row()); !worst.empty()) text += "; worst is " + worst;
  // A force law that pulls hardest is the usual suspect where no constraint is.
  double largest = 0.0;
  int suspect = -1;
  for (const ForceBlock& block : system.force_blocks()) {
    const double* wrench = &e_accepted.wrench[12 * at(block.joint) + 6];
    const double force = std::hypot(wrench[0], wrench[1]);
    if (force > largest) largest = force, suspect = block.joint;
  }
  if (suspect >= 0) {
    text += fmt::format("; the largest force is {:.4g} N in joint '{}'", largest, model.joints[at(suspect)].name);
  }
  return text + "; try a smaller step";
}

bool Simulation::Impl::begin() {
  e_accepted.motion_time = std::numeric_limits<double>::quiet_NaN();
  if (!system.evaluate(point(accepted), all_terms, e_accepted)) return fail_with(e_accepted.fault, accepted.t());
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
  return record_row() && tell_sinks();
}

bool Simulation::Impl::prepare_trial(double dt) {
  trial.assign(accepted);
  const Point here{accepted.t(), accepted.q(), accepted.v(), accepted.z(), accepted.h()};
  for (const int j : with_history) {
    const Slice h = system.layout().history(j);
    MarkerAccelerations accelerations;
    system.marker_accelerations(j, e_accepted, accepted.a(), accelerations);
    if (!system.joint(j).begin_step(system.input(j, here, e_accepted), accelerations, dt,
                                    Span<double>(trial.h()).part(at(h.offset), at(h.size)), e_trial.fault.message)) {
      e_trial.fault.kind = Fault::Kind::plugin;
      e_trial.fault.joint = j;
      return fail_with(e_trial.fault, accepted.t());
    }
    if (!trial.intact()) return fail_beside(j);
  }
  return true;
}

bool Simulation::Impl::step(double dt, bool& converged) {
  converged = false;
  plugin_fault.kind = Fault::Kind::none;
  if (!prepare_trial(dt)) return false;
  solver.use_history(trial.h());
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
  return !converged || check_step(dt);
}

/// What an integrator that says that it converged must have left.
bool Simulation::Impl::check_step(double dt) {
  const double expected = accepted.t() + dt, rounding = 4.0 * std::numeric_limits<double>::epsilon();
  if (!(std::abs(trial.t() - expected) <= 1e-9 * dt + rounding * std::abs(expected))) {
    return fail(5, fmt::format("t = {:.9g} s: {} failed: a step to {:.9g} s ends at {:.9g} s [plugin-failed]",
                               accepted.t(), integrator_words(model), expected, trial.t()));
  }
  double sum = 0.0;  // finite only if every term is
  for (const std::span<const double> part : {trial.q(), trial.v(), trial.a(), trial.lambda(), trial.z()}) {
    for (const double x : part) sum += x;
  }
  if (std::isfinite(sum)) return true;
  return fail(5, fmt::format("t = {:.9g} s: {} failed: it left a state that is not a finite number [plugin-failed]",
                             accepted.t(), integrator_words(model)));
}

// Events first, then the joints' history, then the state is the accepted one.
bool Simulation::Impl::accept() {
  if (!system.evaluate(point(trial), all_terms, e_trial)) return fail_with(e_trial.fault, trial.t());
  Fault fault;
  if (!events.apply(accepted, e_accepted, trial, e_trial, fault)) return fail_with(fault, trial.t());
  for (const int j : with_history) {
    const Slice h = system.layout().history(j), rows = system.layout().rows(j);
    if (!system.joint(j).commit(system.input(j, point(trial), e_trial),
                                {trial.lambda().data() + rows.offset, at(rows.size)},
                                Span<double>(trial.h()).part(at(h.offset), at(h.size)), fault.message)) {
      fault.kind = Fault::Kind::plugin;
      fault.joint = j;
      return fail_with(fault, trial.t());
    }
    if (!trial.intact()) return fail_beside(j);
  }
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    if (const int turn = system.layout().turn(j); turn >= 0) trial.h()[at(turn)] = e_trial.coordinate[at(j)];
  }
  std::swap(accepted, trial);
  std::swap(e_accepted, e_trial);
  ++outcome.steps;
  outcome.time = accepted.t();
  return record_row() && tell_sinks();
}

bool Simulation::Impl::record_row() {
  Fault fault;
  if (!observer.observe(point(accepted), e_accepted, accepted.lambda(), row, fault)) {
    return fail_with(fault, accepted.t());
  }
  energy.add(system, e_accepted, channels, row);
  double position = 0.0, velocity = 0.0;
  system.multiply(e_accepted, accepted.v(), flow);
  for (std::size_t r = 0; r < flow.size(); ++r) {
    position = std::max(position, std::abs(e_accepted.phi[r]));
    velocity = std::max(velocity, std::abs(flow[r] - e_accepted.nu[r]));
  }
  statistics.add(row, energy.driver_work(), energy.joint_loss(), position, velocity);
  return true;
}

bool Simulation::Impl::tell_sinks() {
  for (const StepEvents::Happening& happening : events.happenings()) {
    const char* name = system.joint_layout(happening.joint).events[at(happening.event)].name;
    if (std::strcmp(name, "contact_begin") == 0) statistics.add_contact(happening.joint, happening.time);
    for (Sink* sink : sinks) {
      sink->event({happening.time, happening.joint, happening.event, events.fields(happening)});
    }
  }
  for (Sink* sink : sinks) {
    if (!sink->ok()) return fail(6, "a result file could not be written");
  }
  return true;
}

bool Simulation::Impl::check_stop() {
  for (std::size_t i = 0; i < settings.stop.size(); ++i) {
    const StopCondition& stop = settings.stop[i];
    if (stop_columns[i] < 0 || accepted.t() < stop.after) continue;
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

// Fixed steps to an output instant. A step that does not converge is halved and resumed.
bool Simulation::Impl::advance_to(double target, const RunHooks& hooks) {
  const double from = accepted.t(), size = settings.step;
  const double smallest = smallest_step * size;
  // Beyond this the time itself could not be advanced: t + dt would round to t.
  if (!((target - from) / size < 1e15)) {
    return fail(4, fmt::format("t = {:.9g} s: a step of {:.3g} s is too small to advance the time", from, size));
  }
  const long count = std::max(1L, std::lround(std::ceil((target - from) / size - 1e-6)));
  for (long i = 1; i <= count; ++i) {
    const double goal = i == count ? target : from + static_cast<double>(i) * size;
    double dt = goal - accepted.t();
    while (accepted.t() < goal) {
      const bool last = accepted.t() + dt >= goal - 0.5 * smallest;
      if (last) dt = goal - accepted.t();
      bool converged = false;
      if (!step(dt, converged)) return false;
      if (!converged) {
        ++outcome.rejected;
        dt *= 0.5;
        if (dt < smallest && plugin_fault.kind == Fault::Kind::plugin) return fail_with(plugin_fault, accepted.t());
        if (dt < smallest) return fail(4, why_not_converged(dt));
        continue;
      }
      if (last) trial.t() = goal;
      if (!accept() || !check_stop() || !check_interrupt(hooks)) return false;
    }
  }
  return true;
}

Outcome Simulation::Impl::run(const RunHooks& hooks) {
  started = Clock::now();
  outcome.time = accepted.t();
  const auto write_row = [&] {
    ++outcome.rows;
    for (Sink* sink : sinks) sink->row(row);
  };
  bool going = begin();
  if (going) write_row();
  const double start = settings.start, end = settings.end;
  for (long k = 1; going && accepted.t() < end; ++k) {
    double target = start + static_cast<double>(k) * settings.interval;
    if (target > end - 1e-9 * settings.interval) target = end;
    const long before = outcome.steps;
    going = advance_to(target, hooks);
    // A run that was stopped keeps the state it stopped in.
    if (going || outcome.steps > before) write_row();
  }
  outcome.wall_seconds = seconds_since(started);
  outcome.iterations = solver.iterations();
  outcome.factorizations = solver.factorizations();
  return outcome;
}

Simulation::Simulation(System& system, const Start& start, const Channels& channels, std::span<Sink* const> sinks)
    : impl_(std::make_unique<Impl>(system, start, channels, sinks)) {}
Simulation::~Simulation() = default;
Outcome Simulation::run(const RunHooks& hooks) { return impl_->run(hooks); }
const Statistics& Simulation::statistics() const { return impl_->statistics; }
std::span<const double> Simulation::last_row() const { return impl_->row; }
std::span<const std::string> Simulation::warnings() const { return impl_->warnings; }

}  // namespace freeplay
