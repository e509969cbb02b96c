#include "run/failure.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "assembly/dead_point.h"
#include "assembly/out_of_reach.h"
#include "base/index.h"
#include "component/own_types.h"
#include "model/element_name.h"
#include "model/whole_mass.h"
#include "run/likely_cause.h"

namespace freeplay {
namespace {
constexpr double singular = 1e-4;      // regularity
constexpr double fast_for_all = 50.0;  // speed of all masses at the energy of motion [m/s]
constexpr double most_of_energy = 0.5;
}  // namespace

bool RunFailure::fail(int exit_code, std::string reason) {
  run_.outcome.status = RunStatus::failed;
  run_.outcome.exit_code = exit_code;
  run_.outcome.reason = std::move(reason);
  return false;
}

bool RunFailure::fail_with(const Fault& fault, double t) {
  if (fault.kind == Fault::Kind::motion) {
    MotionFault motion = fault.motion;
    if (motion.force < 0) locate_end_of_motion(t, motion);
    std::string who;
    if (motion.driver >= 0) who = fmt::format("driver '{}': ", run_.model.drivers[at(motion.driver)].name);
    if (motion.force >= 0) who = fmt::format("force '{}': ", run_.model.forces[at(motion.force)].name);
    if (motion.kinematics >= 0) who = fmt::format("driver '{}': ", run_.model.kinematics[at(motion.kinematics)].name);
    return fail(4, fmt::format("t = {:.9g} s: {}{} [{}]", t, who, motion.text, motion.id));
  }
  const JointElement& joint = run_.model.joints[at(fault.joint)];
  if (fault.of_expression()) {
    return fail(4,
                fmt::format("t = {:.9g} s: joint '{}': {} [{}]", t, joint.name, fault.message.text, fault.message.id));
  }
  if (std::string_view(fault.message.text).ends_with("not a finite number") && all_built_in()) {
    return fail(4, why_beyond_bounds(t, fault.joint));
  }
  // A law of the program has an end: numbers of the model have led there, and no plugin is at fault.
  if (is_built_in(run_.model.instances, *joint.component, joint.parameters.get())) {
    failed_joint_ = fault.joint;
    return fail(4, fmt::format("t = {:.9g} s: joint '{}': {} [law-range]", t, joint.name, fault.message.text));
  }
  return fail(5, fmt::format("t = {:.9g} s: joint '{}' of {} failed: {} [plugin-failed]", t, joint.name,
                             run_.model.instances.words_of(*joint.component), fault.message.text));
}

// A stage of a step finds that drivers have no value at some later time: since when they have none, to rounding.
void RunFailure::locate_end_of_motion(double& t, MotionFault& fault) {
  std::vector<TimeValue> values(run_.model.drivers.size());
  MotionFault found = fault;
  const auto has_value = [&](double time) {
    MotionFault there;
    if (run_.system.motions().evaluate(time, {values.data(), values.size()}, run_.motion_work, there)) return true;
    found = there;
    return false;
  };
  double known = run_.accepted.t(), lost = t;
  if (!(known < lost) || !has_value(known) || has_value(lost)) return;
  fault = found;
  for (;;) {
    const double middle = known + 0.5 * (lost - known);
    if (!(known < middle && middle < lost)) break;
    if (has_value(middle)) {
      known = middle;
    } else {
      lost = middle, fault = found;
    }
  }
  t = lost;
}

bool RunFailure::fail_beside(int joint) {
  Fault fault;
  fault.kind = Fault::Kind::plugin;
  fault.joint = joint;
  abi::copy_text(fault.message.text, sizeof fault.message.text, "it wrote beside its history");
  return fail_with(fault, run_.accepted.t());
}

std::string RunFailure::row_name(int row_index) const {
  for (int d = 0; d < static_cast<int>(run_.model.drivers.size()); ++d) {
    if (run_.system.layout().driver_row(d) == row_index)
      return fmt::format("driver '{}'", run_.model.drivers[at(d)].name);
  }
  for (int j = 0; j < static_cast<int>(run_.model.joints.size()); ++j) {
    const Slice rows = run_.system.layout().rows(j);
    if (row_index >= rows.offset && row_index < rows.offset + rows.size) {
      return written_name(run_.model.joints[at(j)]);
    }
  }
  return {};
}

// Of the joints at a body, or of all (ground), the one that pulls hardest; -1 when none has a force.
int RunFailure::hardest_joint(BodyId body) const {
  double largest = 0.0;
  int hardest = -1;
  for (int j = 0; j < static_cast<int>(run_.model.joints.size()); ++j) {
    const JointElement& joint = run_.model.joints[at(j)];
    if (joint.gear >= 0) continue;
    if (body != ground && run_.model.markers[at(joint.marker_a)].body != body &&
        run_.model.markers[at(joint.marker_b)].body != body) {
      continue;
    }
    double wrench[6];
    run_.system.constraints().reaction(j, run_.e_accepted, run_.accepted.lambda(), wrench);
    const double force = std::hypot(std::hypot(wrench[0], wrench[1]), wrench[2]);
    if (force > largest) largest = force, hardest = j;
  }
  return hardest;
}

std::string RunFailure::why_not_converged(double dt) const {
  if (run_.left_bounds) return why_beyond_bounds(run_.accepted.t(), -1);
  std::string text = fmt::format("t = {:.9g} s: no step of {:.3g} s or longer could be made: {}", run_.accepted.t(), dt,
                                 *run_.solver.trouble() ? run_.solver.trouble() : "the integrator gave up");
  if (const std::string worst = row_name(run_.solver.worst_row()); !worst.empty()) text += "; worst is " + worst;
  // A force law that pulls hardest is the usual suspect where no constraint is.
  double largest = 0.0;
  int suspect = -1;
  for (const ForceBlock& block : run_.system.forces().blocks()) {
    const double* wrench = &run_.e_accepted->wrench[12 * at(block.joint) + 6];
    const double force = std::hypot(std::hypot(wrench[0], wrench[1]), wrench[2]);
    if (force > largest) largest = force, suspect = block.joint;
  }
  if (suspect >= 0) {
    text += fmt::format("; the largest force is {:.4g} N in joint '{}'", largest, run_.model.joints[at(suspect)].name);
  }
  return text + std::string(advice::smaller_step);
}

// Roundings of coordinates that have grown without bound, as after a dead point, can pass for rows that hold.
std::string RunFailure::why_open(double position) const {
  int worst = 0;
  for (int r = 0; r < run_.system.layout().nc(); ++r) {
    if (!(std::abs(run_.e_accepted->phi[at(r)]) <= std::abs(run_.e_accepted->phi[at(worst)]))) worst = r;
  }
  return fmt::format("t = {:.9g} s: the mechanism has come apart: {} stays open by {:.4g} m", run_.accepted.t(),
                     row_name(worst), position);
}

std::string RunFailure::why_singular() const { return why_singular(run_.accepted.t()); }

std::string RunFailure::why_singular(double t) const {
  std::string text = fmt::format(
      "t = {:.9g} s: the mechanism comes to a singular position, as of links in line: it cannot go on, or rounding "
      "hides how",
      t);
  if (const std::string worst = row_name(run_.solver.rows().weakest(run_.solver.evaluation())); !worst.empty()) {
    text += "; first to depend on the other constraints is " + worst;
  }
  return text + std::string(advice::other_steps);
}

std::string RunFailure::why_so_small(double dt, double smallest, int limiting_joint) const {
  std::string text = fmt::format("t = {:.9g} s: ", run_.accepted.t());
  // Two lengths that differ by little would read as the same.
  text += dt < smallest ? fmt::format("a step below {:.3g} s is needed, the smallest allowed", smallest)
                        : fmt::format("a step of {:.3g} s is needed, which is lost in the rounding of the time", dt);
  if (limiting_joint >= 0)
    return text + fmt::format("; joint '{}' asks for it", run_.model.joints[at(limiting_joint)].name);
  const int worst = run_.solver.local_error().worst_component();
  if (worst < 0) {
    if (const int joint = hardest_joint(ground); joint >= 0)
      text += fmt::format("; joint '{}' pulls hardest", run_.model.joints[at(joint)].name);
    return text + std::string(advice::error);
  }
  const int width = run_.system.layout().body_velocities(), part = worst % width;
  const BodyId body = run_.system.layout().body_at(worst / width);
  constexpr const char* planar[] = {"x", "y", "angle"};
  constexpr const char* spatial[] = {"x", "y", "z", "rotation", "rotation", "rotation"};
  text += fmt::format("; the error is largest in body '{}' ({})", run_.model.bodies[at(body)].name,
                      width == 3 ? planar[part] : spatial[part]);
  if (const int joint = hardest_joint(body); joint >= 0) {
    text += fmt::format(", on which joint '{}' pulls hardest", run_.model.joints[at(joint)].name);
  }
  return text + std::string(advice::error);
}

std::string RunFailure::likely_cause_at(double t, double dt, int joint) const {
  // A contact that is pressed to the core holds what was motion before.
  const double mass = whole_mass(run_.model).mass;
  double energy = run_.system.inertia().kinetic_energy(run_.e_accepted->v);
  for (const double stored : run_.e_accepted->potential) energy += std::max(stored, 0.0);
  const double speed = std::sqrt(2.0 * energy / mass);
  std::string worker;
  if (speed > fast_for_all && is_on_ground(run_.model)) worker = hardest_worker(most_of_energy * energy);
  if (!worker.empty())
    worker += fmt::format(", the energy of all of it at {:.3g} m/s: check its number and unit", speed);
  return likely_cause(run_.system, run_.e_accepted,
                      {t, run_.adaptive ? 0.0 : dt, joint, run_.first_forces, std::move(worker)});
}

// Of drivers and forces the one with the largest work above `least` [J], which nothing takes out of the mechanism.
std::string RunFailure::hardest_worker(double least) const {
  std::string text;
  const auto look = [&](double work, const char* kind, const std::string& name) {
    if (!(work > least)) return;
    least = work;
    text = fmt::format("{} '{}' has put {:.3g} J into {:.3g} kg", kind, name, work, whole_mass(run_.model).mass);
  };
  for (std::size_t d = 0; d < run_.model.drivers.size(); ++d)
    look(run_.energy.driver_work()[d], "driver", run_.model.drivers[d].name);
  for (std::size_t f = 0; f < run_.model.force_elements.size(); ++f) {
    const ForceElement& element = run_.model.force_elements[f];
    look(
        run_.energy.force_work()[f], "force",
        element.applied >= 0 ? run_.model.forces[at(element.applied)].name : run_.model.joints[at(element.joint)].name);
  }
  return text;
}

// Of joints and springs the one that stores most at the end of the step that was made, if it is more than `least` [J].
std::string RunFailure::what_stores(double least) const {
  std::string text;
  for (std::size_t j = 0; j < run_.model.joints.size(); ++j) {
    const double stored = run_.e_trial->potential[j];
    if (!(stored > least)) continue;
    least = stored;
    text = fmt::format("; {} would store {:.3g} J", written_name(run_.model.joints[j]), stored);
  }
  return text;
}

// Contacts are overshot by steps; constraints alone come to this where the mechanism cannot go on.
std::string RunFailure::why_energy_grows(double dt, double gained) {
  if (run_.model.clearance_joints() == 0) {
    if (run_.adaptive && run_.solver.regularity() < singular) return why_singular();
    if (*run_.solver.trouble()) return why_not_converged(dt);
  }
  std::string text = fmt::format(
      "t = {:.9g} s: energy would grow by {:.3g} J in a step of {:.3g} s, more than everything that acts could put in",
      run_.accepted.t(), gained, dt);
  const int joint = hardest_joint(ground);
  if (joint >= 0) {
    text += fmt::format("; joint '{}' pulls hardest", run_.model.joints[static_cast<std::size_t>(joint)].name);
  } else {
    text += what_stores(0.5 * gained);
  }
  const std::string cause = likely_cause_at(run_.accepted.t(), dt, joint);
  if (!cause.empty()) return text + std::string(cause_words) + cause;
  return text + std::string(run_.settings.accuracy > 0.0 ? advice::jump : advice::accuracy);
}

std::string RunFailure::why_unsolved(double t) const {
  if (run_.solver.regularity() < near_singular) return why_singular(t);
  return fmt::format("t = {:.9g} s: {}", t, run_.solver.trouble());
}

/// Numbers of the program's own types that are not finite any more come of the model or of the step.
std::string RunFailure::why_beyond_bounds(double t, int joint) const {
  std::string text = fmt::format("t = {:.9g} s: forces and speeds grow beyond all bounds", t);
  const int hardest = joint >= 0 ? joint : hardest_joint(ground);
  if (hardest >= 0)
    text += fmt::format(", first in joint '{}'", run_.model.joints[static_cast<std::size_t>(hardest)].name);
  const std::string cause = likely_cause_at(t, run_.settings.step, hardest);
  return text + (cause.empty() ? std::string(advice::accuracy) : std::string(cause_words) + cause);
}

bool RunFailure::all_built_in() const {
  return std::ranges::all_of(run_.model.instances.libraries(),
                             [](const RegisteredLibrary& library) { return library.path == "built-in"; });
}

bool RunFailure::fail_in_storm(const StepEvents::Happening& last, const EventStorm::Finding& found) {
  return fail(4, fmt::format("t = {:.9g} s: the events of joint '{}' do not end: {} within {:.2g} s, the last '{}'; {}",
                             last.time, run_.model.joints[at(last.joint)].name, found.events, found.within,
                             run_.system.joints().layout(last.joint).events[at(last.event)].name, event_rule));
}

bool RunFailure::fail_in_switching(const EventStorm::Finding& found) {
  return fail(4,
              fmt::format("t = {:.9g} s: the formula of {} changes its form without end: {} times within "
                          "{:.2g} s; a force that jumps back whenever it has acted holds a body still as dry friction "
                          "does: write it with smooth(), or as the friction of a joint [event-storm]",
                          run_.accepted.t(), run_.events.switched_words(), found.events, found.within));
}

// Where a driver asks for what the mechanism cannot do, what failed there says little: neither does what was blamed.
bool RunFailure::explain_dead_point() {
  if (run_.outcome.status != RunStatus::failed || run_.outcome.exit_code != 4) return false;
  auto why = why_out_of_reach(run_.equations->whole(), run_.equations->start().state, run_.outcome.time);
  if (!why) {
    explain_singular_position();
    return false;
  }
  run_.outcome.reason = std::move(*why);
  const bool locked = run_.outcome.reason.ends_with("[locked]");
  for (TrustReason& reason : run_.outcome.doubts) {
    reason.message = fmt::format("the mechanism {}: {}", locked ? "is locked" : "comes to a dead point",
                                 reason.message.substr(0, reason.message.find(cause_words)));
  }
  return true;
}

// Before a path leaves what the mechanism reaches, its inputs turn faster and faster, and no step is short enough; so
// they do where a formula that finds them comes to the end of where it has a value.
bool RunFailure::explain_end_of_path() {
  const double whole = run_.settings.end - run_.settings.start;
  const double step = run_.adaptive ? 0.0 : run_.settings.step;
  for (const double ahead : {1e-9 * whole, 1e-6 * whole, 1e-4 * whole, std::max(1e-3 * whole, step)}) {
    if (ends_within(ahead)) return true;
  }
  return false;
}

// Whether drivers lose their value so soon after the accepted state; the run is over then.
bool RunFailure::ends_within(double ahead) {
  std::vector<TimeValue> values(run_.model.drivers.size());
  Fault fault;
  fault.kind = Fault::Kind::motion;
  const double t = run_.accepted.t() + ahead;
  if (run_.system.motions().evaluate(t, {values.data(), values.size()}, run_.motion_work, fault.motion)) return false;
  const std::string_view id = fault.motion.id;
  if (id != "ik-unreachable" && id != "bad-expression") return false;
  fail_with(fault, t);
  return true;
}

// Before a path leaves what the mechanism reaches, its inputs turn as one over the root of the time left: steps get
// shorter with it, and rounding of what is prescribed makes them shorter without end.
bool RunFailure::comes_to_end_of_path(double dt) {
  constexpr double hopeless_step = 1e-9, near_end = 1e-6;  // of the run
  const double whole = run_.settings.end - run_.settings.start, ahead = near_end * whole;
  return dt < hopeless_step * whole && run_.accepted.t() + ahead < run_.settings.end && ends_within(ahead);
}

// Where constraints have lost rank no step is short enough.
void RunFailure::explain_singular_position() {
  if (explain_end_of_path()) return;
  const auto advises = [&](std::string_view advice) { return run_.outcome.reason.ends_with(advice); };
  const bool grew = run_.model.clearance_joints() == 0 && (advises(advice::jump) || advises(advice::accuracy));
  if (!grew && !advises(advice::smaller_step) && !advises(advice::error)) return;
  std::optional<SingularPosition> position;
  try {
    position = singular_position(run_.system, run_.accepted);
  } catch (const Error&) {
    return;  // a joint or a driver that cannot answer there has been reported already
  }
  if (!position) return;
  const bool at_start = !(run_.accepted.t() > run_.model.settings.start);
  run_.outcome.reason = fmt::format("t = {:.9g} s: the mechanism {} {} [dead-point]", run_.accepted.t(),
                                    at_start ? "stands in" : "comes to", words(*position, run_.model));
}

// A number of the model that no machine has is worth more than any advice about steps.
void RunFailure::explain_failure() {
  if (run_.outcome.exit_code != 4 || run_.outcome.reason.find(cause_words) != std::string::npos) return;
  for (const std::string_view id :
       {"[dead-point]", "[locked]", "[ik-unreachable]", "[bad-expression]", "[event-storm]"}) {
    if (run_.outcome.reason.ends_with(id)) return;
  }
  const std::string cause = likely_cause_at(run_.accepted.t(), run_.settings.step, failed_joint_);
  if (cause.empty()) return;
  for (const std::string_view advice :
       {advice::smaller_step, advice::accuracy, advice::other_steps, advice::jump, advice::error}) {
    if (run_.outcome.reason.ends_with(advice)) run_.outcome.reason.resize(run_.outcome.reason.size() - advice.size());
  }
  run_.outcome.reason += std::string(cause_words) + cause;
}

}  // namespace freeplay
