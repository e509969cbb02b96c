#include "cli/run_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/text_table.h"

namespace freeplay {
namespace {

using Align = TextTable::Align;

constexpr const char* gear_sentence =
    "  a gear couples two motions: the forces of its teeth on the bearings are not modelled\n";

std::string quantity(double value, const char* unit, int digits = 4) {
  return std::isfinite(value) ? fmt::format("{:.{}g} {}", value, digits, unit) : "-";
}

/// With the prefix that leaves one to three digits before the point.
std::string prefixed(double value, const char* unit) {
  if (!std::isfinite(value)) return "-";
  constexpr std::pair<double, const char*> prefixes[] = {{1.0, ""}, {1e-3, "m"}, {1e-6, "u"}, {1e-9, "n"}};
  for (const auto& [factor, prefix] : prefixes) {
    if (std::abs(value) >= factor) return fmt::format("{:.4g} {}{}", value / factor, prefix, unit);
  }
  return fmt::format("{:.4g} {}", value, unit);
}

/// The steps that were taken, where these are not simply the one that was asked for.
std::string fixed_steps(const RunRecord& record) {
  const double asked = record.model.settings.step, interval = record.model.settings.interval;
  const double smallest = record.outcome.smallest_step, largest = record.outcome.largest_step;
  const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-6 * b; };
  if (record.outcome.steps == 0 || (same(smallest, asked) && same(largest, asked))) return fmt::format("{:g} s", asked);
  const bool cut = largest < asked && asked > interval;
  std::string text = same(smallest, largest) || (cut && same(largest, interval))
                         ? fmt::format("{:.4g} s", largest)
                         : fmt::format("{:.4g} to {:.4g} s", smallest, largest);
  if (cut) text += fmt::format(": the step of {:g} s is longer than the output interval", asked);
  return text;
}

std::string first_line(const RunRecord& record) {
  const Settings& settings = record.model.settings;
  std::string steps = settings.adaptive ? fmt::format("tolerance {:g}, steps of {:.2g} to {:.2g} s", settings.tolerance,
                                                      record.outcome.smallest_step, record.outcome.largest_step)
                                        : fixed_steps(record);
  if (settings.accuracy > 0.0) steps = fmt::format("accuracy {:g} m", settings.accuracy);
  return fmt::format("{}: {}, {:g} s in {} steps ({}, {}), {:.3g} s wall\n", record.model.name,
                     status_word(record.outcome.status), record.outcome.time, record.outcome.steps,
                     settings.integrator_parameters.component->description.name, steps, record.outcome.wall_seconds);
}

/// The heading of the first column, as wide as the longest name of all tables.
std::string heading(const RunRecord& record, const char* word) {
  std::size_t width = 0;
  for (const JointElement& joint : record.model.joints) width = std::max(width, joint.name.size());
  for (const Driver& driver : record.model.drivers) width = std::max(width, driver.name.size());
  for (const InverseKinematics& path : record.model.kinematics) width = std::max(width, path.name.size());
  for (int f = 0; f < static_cast<int>(record.model.force_elements.size()); ++f) {
    width = std::max(width, force_words(record.model, f).name.size());
  }
  return fmt::format("{:<{}}", word, width);
}

/// A moment that is no more than the rounding of the force beside it is none.
bool holds_moment(const JointStatistics& seen) { return seen.max_torque > 1e-9 * seen.max_force; }

bool is_listed(const JointElement& joint) { return !joint.is_force && joint.gear < 0; }

/// Joints without gears and entries of `forces`. Moments have a column where a joint without play holds one.
void add_joints(const RunRecord& record, TextTable& table) {
  const std::vector<JointElement>& joints = record.model.joints;
  const auto seen_of = [&](std::size_t i) { return record.statistics.joint(static_cast<int>(i)); };
  bool moments = false;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    moments = moments ||
              (is_listed(joints[i]) && !has_contact_statistics(record.channels.joints[i]) && holds_moment(seen_of(i)));
  }
  std::vector<std::string> head{heading(record, "joint"), "max |F|", "contacts", "in contact", "max delta"};
  if (moments) head.emplace_back("max |torque|");
  table.add_row(std::move(head));
  const bool any = has_statistics(record.model.settings, record.outcome);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!is_listed(joints[i])) continue;
    const JointStatistics seen = seen_of(i);
    const bool touches = any && has_contact_statistics(record.channels.joints[i]);
    std::vector<std::string> row{joints[i].name, quantity(seen.max_force, "N"),
                                 touches ? std::to_string(seen.contacts) : "-",
                                 touches ? fmt::format("{:.1f} %", 100.0 * seen.contact_fraction) : "-",
                                 touches ? quantity(seen.max_penetration, "m", 2) : "-"};
    if (moments) row.push_back(holds_moment(seen) ? quantity(seen.max_torque, "N*m") : "-");
    table.add_row(std::move(row));
  }
}

/// A gear between turns passes a torque, one to a slide a force.
void add_gears(const RunRecord& record, TextTable& table) {
  table.add_row({heading(record, "gear"), "max |force|", "max |torque|"});
  for (const Gear& gear : record.model.gears) {
    const JointElement& second = record.model.joints[static_cast<std::size_t>(gear.second)];
    const bool turns = second.ideal_layout.coordinate == Coordinate::angle;
    const JointStatistics seen = record.statistics.joint(gear.joint);
    table.add_row({record.model.joints[static_cast<std::size_t>(gear.joint)].name,
                   turns ? "-" : quantity(seen.max_force, "N"), turns ? quantity(seen.max_torque, "N*m") : "-"});
  }
}

void add_forces(const RunRecord& record, TextTable& table) {
  table.add_row({heading(record, "force"), "max |F|", "max |torque|", "work"});
  for (int f = 0; f < static_cast<int>(record.model.force_elements.size()); ++f) {
    const ForceStatistics seen = record.statistics.force(f);
    const bool pure_force = seen.max_torque == 0.0, pure_torque = seen.max_force == 0.0 && !pure_force;
    table.add_row({force_words(record.model, f).name, pure_torque ? "-" : quantity(seen.max_force, "N"),
                   pure_force ? "-" : quantity(seen.max_torque, "N*m"), quantity(seen.work, "J")});
  }
}

bool is_slide(const Model& model, const Driver& driver) {
  return model.joints[static_cast<std::size_t>(driver.joint)].layout.coordinate == Coordinate::position;
}

void add_drivers(const RunRecord& record, TextTable& table) {
  const std::vector<Driver>& drivers = record.model.drivers;
  const auto slides = std::ranges::count_if(drivers, [&](const Driver& d) { return is_slide(record.model, d); });
  const bool all = slides == static_cast<std::ptrdiff_t>(drivers.size());
  table.add_row({heading(record, "driver"),
                 slides == 0 ? "max |torque|"
                 : all       ? "max |force|"
                             : "max |effort|",
                 "rms"});
  for (std::size_t i = 0; i < drivers.size(); ++i) {
    const DriverStatistics seen = record.statistics.driver(static_cast<int>(i));
    const char* unit = is_slide(record.model, drivers[i]) ? "N" : "N*m";
    table.add_row({drivers[i].name, quantity(seen.max_abs, unit), quantity(seen.rms, unit)});
  }
}

void add_paths(const RunRecord& record, TextTable& table) {
  table.add_row({heading(record, "path"), "max error", "rms", "max angle", "rms"});
  for (std::size_t i = 0; i < record.model.kinematics.size(); ++i) {
    const PathStatistics seen = record.statistics.path(static_cast<int>(i));
    table.add_row({record.model.kinematics[i].name, prefixed(seen.max_position, "m"), prefixed(seen.rms_position, "m"),
                   prefixed(seen.max_angle, "rad"), prefixed(seen.rms_angle, "rad")});
  }
}

/// How well the impacts that ended were resolved, and what would do.
std::string steps_per_impact(const RunRecord& record) {
  const ContactAdvice& advice = record.advice;
  if (advice.ended() == 0) return {};
  std::string text = fmt::format("  steps per impact: {:g} or more", advice.fewest_steps());
  if (advice.under_resolved() == 0) return text + "\n";
  text += fmt::format("; {} of {} impacts took fewer than {:g}: ", advice.under_resolved(), advice.ended(),
                      advice.per_contact());
  const bool adaptive = record.model.settings.adaptive;
  return text + (adaptive ? "a larger per_contact or a smaller tolerance would do\n"
                          : fmt::format("--step {:.2g}, or an accuracy in its place, would do\n", advice.step()));
}

/// "trust: good", or the level and the reasons.
std::string trust_line(const Verdict& trust) {
  std::string text = fmt::format("  trust: {}", word(trust.level()));
  std::string list;
  for (const TrustReason& reason : trust.reasons()) list += (list.empty() ? "" : "; ") + reason.message;
  return text + (list.empty() ? "\n" : fmt::format(" ({})\n", list));
}

}  // namespace

std::string run_table(const RunRecord& record) {
  std::string text = first_line(record);
  if (!record.outcome.reason.empty()) text += fmt::format("  {}\n", record.outcome.reason);
  TextTable joints({Align::left, Align::left, Align::right, Align::right, Align::left}), drivers, paths, gears, forces;
  if (std::ranges::any_of(record.model.joints, is_listed)) add_joints(record, joints);
  if (!record.model.drivers.empty()) add_drivers(record, drivers);
  if (!record.model.kinematics.empty()) add_paths(record, paths);
  if (!record.model.gears.empty()) add_gears(record, gears);
  if (!record.model.force_elements.empty()) add_forces(record, forces);
  text += joints.text("  ") + gears.text("  ") + drivers.text("  ") + forces.text("  ") + paths.text("  ");
  if (!record.model.gears.empty()) text += gear_sentence;
  const bool any = has_statistics(record.model.settings, record.outcome);
  text += steps_per_impact(record);
  text += fmt::format("  energy residual {}   position residual {}\n",
                      any ? quantity(record.statistics.energy_residual(), "J", 2) : "-",
                      any ? quantity(record.statistics.position_residual(), "m", 2) : "-");
  return text + trust_line(record.trust);
}

}  // namespace freeplay
