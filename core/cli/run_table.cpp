#include "cli/run_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/text_table.h"

namespace freeplay {
namespace {

using Align = TextTable::Align;

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

std::string first_line(const RunRecord& record) {
  const Settings& settings = record.model.settings;
  std::string steps = fmt::format("{:g} s", settings.step);
  if (settings.adaptive) steps = fmt::format("tolerance {:g}", settings.tolerance);
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
  return fmt::format("{:<{}}", word, width);
}

void add_joints(const RunRecord& record, TextTable& table) {
  table.add_row({heading(record, "joint"), "max |F|", "contacts", "in contact", "max delta"});
  const bool any = has_statistics(record.model.settings, record.outcome);
  for (std::size_t i = 0; i < record.model.joints.size(); ++i) {
    if (record.model.joints[i].is_force) continue;
    const JointStatistics seen = record.statistics.joint(static_cast<int>(i));
    const bool touches = any && has_contact_statistics(record.channels.joints[i]);
    table.add_row({record.model.joints[i].name, quantity(seen.max_force, "N"),
                   touches ? std::to_string(seen.contacts) : "-",
                   touches ? fmt::format("{:.1f} %", 100.0 * seen.contact_fraction) : "-",
                   touches ? quantity(seen.max_penetration, "m", 2) : "-"});
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
  TextTable joints({Align::left, Align::left, Align::right, Align::right, Align::left}), drivers, paths;
  if (!record.model.joints.empty()) add_joints(record, joints);
  if (!record.model.drivers.empty()) add_drivers(record, drivers);
  if (!record.model.kinematics.empty()) add_paths(record, paths);
  text += joints.text("  ") + drivers.text("  ") + paths.text("  ");
  const bool any = has_statistics(record.model.settings, record.outcome);
  text += steps_per_impact(record);
  text += fmt::format("  energy residual {}   position residual {}\n",
                      any ? quantity(record.statistics.energy_residual(), "J", 2) : "-",
                      any ? quantity(record.statistics.position_residual(), "m", 2) : "-");
  return text + trust_line(record.trust);
}

}  // namespace freeplay
