#include "results/judgement.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/index.h"
#include "model/element_name.h"
#include "results/load_judgement.h"
#include "results/path_judgement.h"
#include "results/singular_judgement.h"
#include "results/slide_judgement.h"
#include "results/touch_judgement.h"
#include "run/lasting_blows.h"
#include "run/motion_period.h"
#include "run/slowest_turn.h"

namespace freeplay {
namespace {

/// Limits of a number from which on a run is doubtful and bad. docs/trust.md says where they come from.
struct Limits {
  double doubtful, bad;
};
constexpr Limits of_energy{1e-2, 1e-1};           // residual by what was moved
constexpr double part_of_kinetic = 0.1;           // of the largest kinetic energy counts as moved
constexpr double least_energy = 1e-6;             // by masses lifted by the model's size, or crossing it in the run
constexpr Limits of_position{1e-6, 1e-3};         // residual of the constraints by the model's size
constexpr double fewest_steps_of_accuracy = 5.0;  // of a hard impact: the error is controlled besides
constexpr Limits of_radius{1e-2, 1e-1};           // penetration by the smaller radius
constexpr double of_clearance = 1.0;              // penetration by the clearance
constexpr Limits of_open_radius{1e-1, 0.5};       // by a radius without a clearance, as of discs
constexpr Limits of_size{1e-2, 1e-1};             // by the size of the model without either
constexpr double of_strength = 0.1;               // mean pressure by that at which a run ends
constexpr double typical_density = 7800.0;        // steel [kg/m^3]
constexpr Limits of_sound{2e-3, 1e-1};            // approach speed by that of sound
constexpr double of_reach = 1.1;                  // distance by what the lengths allow
constexpr double of_energy_inside = 0.2;          // of a row inside of a step
constexpr double moves_nothing = 1e-9;            // of the model's size, in the whole run
constexpr Limits of_drives{1e3, 1e6};             // force of a joint by those that drive and move the mechanism
constexpr double most_play = 0.1;                 // clearance by the model's size
constexpr double fewest_impacts = 10.0;           // in a window of statistics without a period
constexpr double fewest_instants = 10.0, fewest_instants_of_accuracy = 2.0;  // that statistics are of
constexpr double longest_periods[] = {20.0, 1e6};                            // looked for, by the length of the run
constexpr double least_slew = M_PI / 18.0;  // a turn that is the whole of a motion [rad]
constexpr double whole_period = 0.99;       // of a window
constexpr double lasting = 0.5;             // part of the time in contact that is no series of impacts,
constexpr double long_enough = 0.1;         // in a window of this part of the run
constexpr double shortest_window = 0.01;    // of what is left out

/// One reason, if `value` passes a limit.
void judge(double value, const Limits& limits, TrustReason reason, Verdict& verdict) {
  if (!(value > limits.doubtful)) return;
  reason.level = value > limits.bad ? Trust::bad : Trust::doubtful;
  reason.value = value;
  reason.limit = value > limits.bad ? limits.bad : limits.doubtful;
  verdict.add(std::move(reason));
}

double mass(const Model& model) {
  double sum = 0.0;
  for (const Body& body : model.bodies) sum += body.mass;
  return sum;
}
/// Radius of gyration [m].
double largest_gyration(const Model& model) {
  double largest = 0.0;
  for (const Body& body : model.bodies) {
    const double moment = std::max({body.inertia[0], body.inertia[4], body.inertia[8]});
    if (body.mass > 0.0) largest = std::max(largest, std::sqrt(moment / body.mass));
  }
  return largest;
}
double weight(const Model& model) {
  double sum = 0.0;
  for (const Body& body : model.bodies)
    sum += body.mass * std::hypot(body.gravity[0], body.gravity[1], body.gravity[2]);
  return sum;
}

void judge_end(const RunRecord& record, Verdict& verdict) {
  const Outcome& outcome = record.outcome;
  const Settings& settings = record.model.settings;
  if (outcome.status == RunStatus::interrupted && outcome.time < settings.end) {
    verdict.add(
        {.id = "run-interrupted",
         .level = Trust::doubtful,
         .message = fmt::format("the run was interrupted at t = {:.9g} s of {:.9g} s: nothing is known of the rest",
                                outcome.time, settings.end),
         .value = outcome.time,
         .limit = settings.end});
  }
  if (outcome.status != RunStatus::failed) return;
  // A cause with a name of its own explains what else is bad.
  const bool named = outcome.reason.ends_with(']');
  if (!named && verdict.level() == Trust::bad) return;
  verdict.lead({.id = "run-failed",
                .level = Trust::bad,
                .message = named ? "the run failed: " + outcome.reason
                                 : fmt::format("the run failed at t = {:.9g} s, and what came just before may be wrong",
                                               outcome.time)});
}

void judge_energy(const RunRecord& record, Verdict& verdict) {
  const RunExtremes& seen = record.extremes;
  const double time = record.outcome.time - record.model.settings.start, size = seen.size;
  const double speed = time > 0.0 ? size / time : 0.0;
  const double least = least_energy * (weight(record.model) * size + mass(record.model) * speed * speed);
  const double range = seen.kinetic.span() + seen.potential.span() +
                       std::max(std::abs(seen.work.least), std::abs(seen.work.most)) +
                       std::max(0.0, seen.dissipated.most) + part_of_kinetic * seen.kinetic.most;
  if (!std::isfinite(range)) return;                     // no row was seen
  const double moved = std::max(range, seen.exchanged);  // what comes and goes may leave no net work
  const double part = seen.residual / std::max(moved, least);
  std::string text = fmt::format("the energy residual of {:.2g} J is {:.3g} % of the {:.3g} J that were moved",
                                 seen.residual, 100.0 * part, std::max(moved, least));
  if (seen.passed_at < unbounded) {
    text += fmt::format("; a singular position was passed at t = {:.6g} s", seen.passed_at);
  } else {
    text += fmt::format("; most of it came from t = {:.4g} s on", seen.residual_time);
  }
  judge(part, of_energy, {.id = "energy-residual", .level = {}, .message = text}, verdict);
  const double inside = seen.residual_inside / std::max(moved, least);
  if (part >= of_energy.doubtful || !(inside > of_energy_inside)) return;
  verdict.add(
      {.id = "energy-residual",
       .level = Trust::doubtful,
       .message = fmt::format("at t = {:.4g} s, inside of a step, the energy is off by {:.2g} J, {:.3g} % of what "
                              "was moved: the step went over something that acts there; ask for shorter steps",
                              seen.residual_inside_time, seen.residual_inside, 100.0 * inside),
       .value = inside,
       .limit = of_energy_inside});
}

void judge_constraints(const RunRecord& record, Verdict& verdict) {
  const double residual = std::max(record.statistics.position_residual(), record.extremes.open);
  const double part = residual / record.extremes.size;
  judge(part, of_position,
        {.id = "constraint-residual",
         .level = {},
         .message = fmt::format("joints are up to {:.2g} m apart where they should hold", residual)},
        verdict);
}

void judge_steps_per_impact(const RunRecord& record, Verdict& verdict) {
  const double steps = record.advice.fewest_steps_of_hard();
  const double limit = record.model.settings.adaptive ? fewest_steps_of_accuracy : fewest_steps_of_blow;
  if (!(steps < limit)) return;
  verdict.add({.id = "impact-steps",
               .level = Trust::doubtful,
               .message = fmt::format("a hard impact took {:g} steps, fewer than {:g}", steps, limit),
               .value = steps,
               .limit = limit});
}

void judge_redundancy(const RunRecord& record, Verdict& verdict) {
  const int redundant = record.facts.actual.redundant;
  if (redundant <= 0) return;
  verdict.add({.id = "undetermined-forces",
               .level = Trust::doubtful,
               .message = fmt::format("{} of the constraints follow{} from the others: how forces are shared among the "
                                      "joints in these loops is not determined, and the least ones are shown",
                                      redundant, redundant == 1 ? "s" : ""),
               .value = static_cast<double>(redundant),
               .limit = 0.0});
}

/// Penetration, with what `discard` leaves out [m].
double deepest(const RunRecord& record, int j) {
  const LargestValues& largest = record.statistics.largest();
  return std::fmax(record.statistics.joint(j).max_penetration, largest.before()[largest.places().penetration(j)]);
}

void judge_contact(const RunRecord& record, int j, Verdict& verdict) {
  const JointElement& joint = record.model.joints[at(j)];
  const JointLayout& layout = joint.layout;
  const JointStatistics seen = record.statistics.joint(j);
  const std::span<const double> discarded = record.statistics.largest().before();
  const PeakValues& values = record.statistics.largest().places();
  const double depth = deepest(record, j);
  const double force = std::fmax(seen.max_normal_force, discarded[values.normal_force(j)]);
  const double radius = layout.smaller_radius;
  // Of a rotor that turns about its centre of mass frames say no size.
  const double size = std::max(record.extremes.size, largest_gyration(record.model));
  if (radius > 0.0 && layout.clearance > most_play * size) {
    verdict.add({.id = "clearance-size",
                 .level = Trust::doubtful,
                 .message = fmt::format("{}: its clearance of {:.3g} m is no play in a mechanism of {:.2g} m",
                                        written_name(joint), layout.clearance, size),
                 .element = written_name(joint),
                 .value = layout.clearance,
                 .limit = most_play * size});
  }
  const auto deep = [&](const char* of, double length) {
    return TrustReason{.id = "penetration",
                       .level = {},
                       .message = fmt::format("{}: its surfaces are up to {:.2g} m deep in each other, {:.2g} times {}",
                                              written_name(joint), depth, depth / length, of),
                       .element = written_name(joint)};
  };
  const std::size_t before = verdict.reasons().size();
  if (radius > 0.0) judge(depth / radius, of_radius, deep("the smaller radius", radius), verdict);
  if (verdict.reasons().size() == before) {
    judge(depth / layout.clearance, {of_clearance, unbounded}, deep("the clearance", layout.clearance), verdict);
  }
  const double length = layout.contact_length > 0.0 ? layout.contact_length : 2.0 * radius;
  const double pressure = force / (2.0 * radius * length);
  judge(pressure / (trust::ideal_strength * layout.contact_modulus), {of_strength, 1.0},
        {.id = "material-strength",
         .level = {},
         .message = fmt::format("{}: {:.3g} N press with {:.2g} Pa on average, more than a hundredth of E*",
                                written_name(joint), force, pressure),
         .element = written_name(joint)},
        verdict);
  const double sound = std::sqrt(layout.contact_modulus / typical_density), speed = record.advice.approach_speed(j);
  judge(
      speed / sound, of_sound,
      {.id = "impact-speed",
       .level = {},
       .message = fmt::format("{}: surfaces meet with {:.3g} m/s, {:.2g} % of the speed of sound; impacts so fast are "
                              "not elastic",
                              written_name(joint), speed, 100.0 * speed / sound),
       .element = written_name(joint)},
      verdict);
}

// Teeth, ends, cams and arcs, which no clearance measures: surfaces that have gone through each other.
void judge_open_contact(const RunRecord& record, int j, Verdict& verdict) {
  const JointElement& joint = record.model.joints[at(j)];
  const double depth = deepest(record, j), radius = joint.layout.smaller_radius;
  const bool known = radius > 0.0;
  const double size = std::max(record.extremes.size, largest_gyration(record.model));
  if (!known && !(size > 0.0)) return;
  const double length = known ? radius : size;
  judge(depth / length, known ? of_open_radius : of_size,
        {.id = "penetration",
         .level = {},
         .message =
             fmt::format("{}: its surfaces are up to {:.2g} m deep in each other, {:.2g} times {}; check the "
                         "stiffness of the contact and what presses",
                         written_name(joint), depth, depth / length, known ? "the smaller radius" : "the model's size"),
         .element = written_name(joint)},
        verdict);
}

void judge_contacts(const RunRecord& record, Verdict& verdict) {
  for (int j = 0; j < static_cast<int>(record.model.joints.size()); ++j) {
    if (!has_contact_statistics(record.channels.joints[at(j)])) continue;
    if (record.model.joints[at(j)].layout.clearance > 0.0) {
      judge_contact(record, j, verdict);
    } else {
      judge_open_contact(record, j, verdict);
    }
  }
}

void judge_reach(const RunRecord& record, Verdict& verdict) {
  const RunExtremes& seen = record.extremes;
  if (!(seen.beyond_reach > of_reach)) return;
  const std::string body = fmt::format("body '{}'", record.model.bodies[at(seen.farthest_body)].name);
  verdict.add({.id = "out-of-reach",
               .level = Trust::bad,
               .message = fmt::format("{} was {:.3g} times as far away as the lengths of its joints and links allow",
                                      body, seen.beyond_reach),
               .element = body,
               .value = seen.beyond_reach,
               .limit = of_reach});
}

/// The largest force of a constraint against everything that moves the mechanism: weights, applied forces and contacts,
/// prescribed motions times the masses, and the kinetic energy of the other parts of the run over the model's size. A
/// force that moves nothing by a billionth of that size in the run is left alone.
void judge_largest_force(const RunRecord& record, Verdict& verdict) {
  const RunExtremes& seen = record.extremes;
  const double time = record.outcome.time - record.model.settings.start;
  if (seen.row_force_joint < 0) return;
  if (!(seen.row_force * time * time > moves_nothing * mass(record.model) * seen.size)) return;
  const auto peak = std::ranges::max_element(seen.part_force);
  double kinetic = 0.0;
  for (std::size_t i = 0; i < RunExtremes::parts; ++i) {
    if (&seen.part_force[i] != &*peak) kinetic = std::max(kinetic, seen.part_kinetic[i]);
  }
  const double drives = std::max({weight(record.model), seen.applied_force, seen.drive_effort,
                                  mass(record.model) * seen.drive_motion, kinetic / seen.size});
  if (!(drives > 0.0)) return;
  const JointElement& joint = record.model.joints[at(seen.row_force_joint)];
  judge(seen.row_force / drives, of_drives,
        {.id = "largest-force",
         .level = {},
         .message = fmt::format("{}: {:.3g} N at t = {:.6g} s are {:.2g} times what drives, weights, loads and inertia "
                                "come to: the mechanism is close to a singular position, or the numbers are",
                                written_name(joint), seen.row_force, seen.row_force_time, seen.row_force / drives),
         .element = written_name(joint)},
        verdict);
}

/// A steady turn of less than one revolution in the whole run, as of a crane that slews: nothing of it comes again. A
/// turn of less than ten degrees is an instant of one that goes on.
bool turns_in_part(const Model& model, const Driver& driver, double period) {
  const double turns = (model.settings.end - model.settings.start) / period;
  if (driver.kinematics >= 0 || driver.table || turns >= 1.0) return false;
  if (model.settings.discard > 0.0 || 2.0 * M_PI * turns < least_slew) return false;
  if (!prescribes(driver.kind) || model.joints[at(driver.joint)].layout.coordinate != Coordinate::angle) return false;
  const bool angle = driver.kind == DriverKind::angle;
  double first = 0.0;
  for (int i = 0; i <= 64; ++i) {
    Jet jet;
    EvaluationFailure failure;
    const double t = model.settings.start + (model.settings.end - model.settings.start) * i / 64.0;
    if (!driver.value.evaluate(t, jet, failure)) return false;
    const double rate = angle ? jet.rate : jet.value;
    if (i == 0) first = rate;
    if (std::abs(rate - first) > 1e-6 * std::abs(first)) return false;
  }
  return true;
}

struct Slowest {
  double period = 0.0;      ///< [s]; 0: nothing has one
  std::string element{};    ///< "driver 'm'", or the joint that it turns most slowly
  std::string by_driver{};  ///< ", which driver 'm' turns"
};
/// A driver, or a joint that one turns through gears and belts.
Slowest slowest_motion(const Model& model, double from) {
  Slowest slowest;
  const double run = model.settings.end - model.settings.start;
  for (const Driver& driver : model.drivers) {
    std::optional<double> period;
    for (const double longest_by_run : longest_periods) {
      if (!period) period = motion_period(model, driver, from, longest_by_run * run);
    }
    const std::string own = fmt::format("driver '{}'", driver.name);
    if (period && *period > slowest.period && !turns_in_part(model, driver, *period)) slowest = {*period, own};
    const auto turn = turn_period(model, driver, from, run);
    // A part of a turn without `discard` is a motion of its own, as that of a crane.
    if (!turn || model.settings.discard == 0.0) continue;
    const SlowestTurn geared = slowest_turn(model, driver.joint);
    if (geared.joint != driver.joint && *turn > slowest.period * geared.ratio)
      slowest = {*turn / geared.ratio, written_name(model.joints[at(geared.joint)]),
                 fmt::format(", which {} turns", own)};
  }
  for (const AppliedForce& force : model.forces) {
    const auto period = model.settings.discard > 0.0 ? load_period(force, from, run) : std::nullopt;
    if (period && *period > slowest.period) slowest = {*period, fmt::format("force '{}'", force.name)};
  }
  return slowest;
}

void judge_instant(const Settings& settings, double window, Verdict& verdict) {
  verdict.add({.id = "statistics-window",
               .level = Trust::doubtful,
               .message = fmt::format("statistics cover {:.3g} s, less than a hundredth of the {:.3g} s that 'discard' "
                                      "leaves out",
                                      window, settings.discard),
               .value = window,
               .limit = shortest_window * settings.discard});
}

bool judge_period(double window, double period, const std::string& element, const std::string& by, Verdict& verdict) {
  if (window >= period * whole_period) return false;
  verdict.add({.id = "statistics-window",
               .level = Trust::doubtful,
               .message = fmt::format("statistics cover {:.3g} s, less than the period of {:.3g} s of {}{}", window,
                                      period, element, by),
               .element = element,
               .value = window,
               .limit = period});
  return true;
}

void judge_window(const RunRecord& record, Verdict& verdict) {
  const Settings& settings = record.model.settings;
  const double from = settings.start + settings.discard, window = record.outcome.time - from;
  if (record.model.bodies.empty() || record.outcome.status == RunStatus::failed) return;
  if (!(window > 0.0)) {
    verdict.add({.id = "statistics-window",
                 .level = Trust::doubtful,
                 .message = "the run ended before its statistics began: 'discard' leaves nothing",
                 .value = std::max(window, 0.0),
                 .limit = 0.0});
    return;
  }
  const auto instants = static_cast<double>(record.statistics.instants());
  const double fewest = settings.adaptive ? fewest_instants_of_accuracy : fewest_instants;
  // What stopped at once has said so.
  const auto said = [](const TrustReason& reason) { return reason.id == "statistics-window"; };
  if (std::ranges::any_of(record.outcome.doubts, said)) return;
  const bool stopped = record.outcome.status == RunStatus::stopped && !settings.stop.empty();
  if ((settings.discard > 0.0 || stopped) && instants < fewest) {
    verdict.add({.id = "statistics-window",
                 .level = Trust::doubtful,
                 .message = fmt::format("statistics from {:.6g} s on are of {:g} instant{}: {}a later end would do",
                                        from, instants, instants == 1.0 ? "" : "s",
                                        settings.discard > 0.0 ? "an earlier 'discard' or " : ""),
                 .value = instants,
                 .limit = fewest});
    return;
  }
  const Slowest slowest = slowest_motion(record.model, from);
  if (slowest.period > 0.0) {
    judge_period(window, slowest.period, slowest.element, slowest.by_driver, verdict);
    return;
  }
  if (settings.discard > 0.0 && window < shortest_window * settings.discard)
    return judge_instant(settings, window, verdict);
  const Swing& swing = record.outcome.slowest;
  if (swing.body >= 0) {
    const std::string& body = record.model.bodies[at(swing.body)].name;
    if (judge_period(window, swing.period, fmt::format("body '{}'", body), "", verdict)) return;
  }
  // Without a period what was left out at the start says that a lasting state is looked for.
  const auto impacts = static_cast<double>(record.statistics.contacts());
  if (settings.discard == 0.0 || record.statistics.contacts_total() == 0 || impacts >= fewest_impacts) return;
  // Surfaces that stay in contact have few impacts, and a lasting state all the more.
  for (int j = 0; j < static_cast<int>(record.model.joints.size()); ++j) {
    const bool touches = has_contact_statistics(record.channels.joints[at(j)]);
    const bool rests = touches && record.statistics.joint(j).contact_fraction > lasting;
    if (rests && window > long_enough * (record.outcome.time - settings.start)) return;
  }
  verdict.add({.id = "statistics-window",
               .level = Trust::doubtful,
               .message = fmt::format("statistics from {:.3g} s on hold {:g} impacts, fewer than {:g}", from, impacts,
                                      fewest_impacts),
               .value = impacts,
               .limit = fewest_impacts});
}

}  // namespace

void judge(const RunRecord& record, Verdict& verdict) {
  judge_end(record, verdict);
  judge_energy(record, verdict);
  judge_constraints(record, verdict);
  judge_redundancy(record, verdict);
  judge_contacts(record, verdict);
  judge_touch(record, verdict);
  judge_steps_per_impact(record, verdict);
  judge_reach(record, verdict);
  judge_slides(record, verdict);
  judge_paths(record, verdict);
  judge_singular(record, verdict);
  judge_largest_force(record, verdict);
  judge_loads(record, verdict);
  judge_window(record, verdict);
}

}  // namespace freeplay
