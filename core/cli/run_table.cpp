#include "cli/run_table.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "cli/text_table.h"
#include "cli/window_lines.h"
#include "model/gear_teeth.h"
#include "results/figure_text.h"
#include "results/play_noise.h"
#include "run/figure_noise.h"
#include "run/play_start.h"

namespace freeplay {
namespace {

using Align = TextTable::Align;

constexpr const char* gear_sentence =
    "  a gear couples two motions: the forces of its teeth on the bearings are not modelled\n";

std::string quantity(double value, const char* unit, int digits = 4) {
  return std::isfinite(value) ? fmt::format("{:.{}g} {}", value, digits, unit) : "-";
}

/// A figure of the tables: that of the run, or what repeated runs found of it.
struct Figures {
  const RunRecord& record;

  std::string operator()(const char* part, const std::string& name, const char* quantity, double value,
                         const char* unit, double noise = 0.0, FigureStyle style = {}) const {
    if (const Json* const spread = spread_of(part, name, quantity)) return range_text(*spread, unit);
    return figure_text(value, unit, noise, style);
  }
  /// Of a value of PeakValues.
  double noise_of(std::size_t peak) const { return record.statistics.largest().noise().of(peak); }
  /// A number of events of a joint.
  std::string count(int joint, const char* quantity, long value) const {
    const Json* const spread = spread_of("joints", name(joint), quantity);
    return spread ? range_text(*spread, "") : count_text(value, FigureNoise(record.statistics).joint(joint).contacts);
  }
  /// A part of the whole time of a joint, in per cent.
  std::string share(int joint, const char* quantity, double value) const {
    const Json* const spread = spread_of("joints", name(joint), quantity);
    if (!spread || !(*spread)["median"].is_number())
      return share_text(value, FigureNoise(record.statistics).joint(joint).contact_fraction);
    const auto percent = [&](const char* key) { return 100.0 * (*spread)[key].get<double>(); };
    return fmt::format("{:.1f} % ({:.1f} to {:.1f})", percent("median"), percent("min"), percent("max"));
  }

 private:
  const std::string& name(int joint) const { return record.model.joints[static_cast<std::size_t>(joint)].name; }
  const Json* spread_of(const char* part, const std::string& name, const char* quantity) const {
    if (record.repeat.is_null() || record.repeat["completed"] == 0) return nullptr;
    const auto element = record.repeat[part].find(name);
    return element == record.repeat[part].end() || !element->contains(quantity) ? nullptr : &(*element)[quantity];
  }
};

constexpr FigureStyle short_figure{.digits = 2}, prefixed{.prefixed = true};

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
  const std::string from = settings.start == 0.0 ? "" : fmt::format("{:g} s to ", settings.start);
  return fmt::format("{}: {}, {}{:g} s in {} steps ({}, {}), {:.3g} s wall\n", record.model.name,
                     status_word(record.outcome.status), from, record.outcome.time, record.outcome.steps,
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
  const bool any = record.statistics.any();
  const Figures figure{record};
  const PeakValues& peaks = record.statistics.largest().places();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!is_listed(joints[i])) continue;
    const JointStatistics seen = seen_of(i);
    const bool touches = any && has_contact_statistics(record.channels.joints[i]);
    const std::string& name = joints[i].name;
    std::vector<std::string> row{name, figure("joints", name, "max_force", seen.max_force, "N",
                                              figure.noise_of(peaks.force(static_cast<int>(i))))};
    row.push_back(touches ? figure.count(static_cast<int>(i), "contacts", seen.contacts) : "-");
    row.push_back(touches ? figure.share(static_cast<int>(i), "contact_fraction", seen.contact_fraction) : "-");
    row.push_back(touches ? figure("joints", name, "max_delta", seen.max_penetration, "m",
                                   figure.noise_of(peaks.penetration(static_cast<int>(i))), short_figure)
                          : "-");
    if (moments) {
      row.push_back(holds_moment(seen) ? figure("joints", name, "max_torque", seen.max_torque, "N*m",
                                                figure.noise_of(peaks.torque(static_cast<int>(i))))
                                       : "-");
    }
    table.add_row(std::move(row));
  }
}

/// What all that touches goes through in the time that counts, of the run that is written.
void add_play(const RunRecord& record, TextTable& table) {
  table.add_row({heading(record, "play"), "in flight", "in impact", "lasting", "impacts", "sliding", "load x slip"});
  for (std::size_t i = 0; i < record.model.joints.size(); ++i) {
    if (!record.clearances.has(static_cast<int>(i))) continue;
    const PlayFigures seen = record.clearances.figures(static_cast<int>(i));
    const PlayNoise noise = play_noise(record, static_cast<int>(i));
    constexpr FigureStyle sum{.digits = 3, .prefixed = true};
    table.add_row({record.model.joints[i].name, share_text(seen.flight, noise.flight),
                   share_text(seen.impact, noise.impact), share_text(seen.lasting, noise.lasting),
                   count_text(seen.impacts, noise.impacts), figure_text(seen.sliding, "m", noise.sliding, sum),
                   figure_text(seen.work, "J", noise.work, sum)});
  }
}

/// "  twin: bodies up to 0.41 mm (slider) from those of the ideal one, efforts up to 12.3 % (motor)"
std::string twin_line(const Json& twin) {
  if (twin.is_null()) return {};
  const auto largest = [](const Json& part, const char* figure) {
    std::pair<double, std::string> most{-1.0, ""};
    for (const auto& [name, figures] : part.items()) {
      if (!figures[figure].is_number() || figures[figure].get<double>() <= most.first) continue;
      most = {figures[figure].get<double>(), name};
    }
    return most;
  };
  const auto [distance, body] = largest(twin["bodies"], "max_position");
  const auto [ripple, driver] = largest(twin["drivers"], "ripple");
  std::string text = "  against the ideal twin:";
  if (distance >= 0.0)
    text += fmt::format(" bodies up to {} off ({})", figure_text(distance, "m", 0.0, {.digits = 3, .prefixed = true}),
                        body);
  if (distance >= 0.0 && ripple >= 0.0) text += ",";
  if (ripple >= 0.0) text += fmt::format(" ripple of efforts up to {:.3g} % ({})", 100.0 * ripple, driver);
  return text + "\n";
}

/// A gear between turns passes a torque, one to a slide a force; teeth without play press with a force, too.
void add_gears(const RunRecord& record, TextTable& table) {
  table.add_row({heading(record, "gear"), "max |force|", "max |torque|"});
  const Figures figure{record};
  const PeakValues& peaks = record.statistics.largest().places();
  for (const Gear& gear : record.model.gears) {
    const JointElement& second = record.model.joints[static_cast<std::size_t>(gear.second)];
    const bool turns = second.ideal_layout().coordinate == Coordinate::angle;
    const JointStatistics seen = record.statistics.joint(gear.joint);
    const JointElement& element = record.model.joints[static_cast<std::size_t>(gear.joint)];
    const std::string& name = element.name;
    table.add_row(
        {name,
         turns && !has_teeth(element)
             ? "-"
             : figure("joints", name, "max_force", seen.max_force, "N", figure.noise_of(peaks.force(gear.joint))),
         turns ? figure("joints", name, "max_torque", seen.max_torque, "N*m", figure.noise_of(peaks.torque(gear.joint)))
               : "-"});
  }
}

void add_forces(const RunRecord& record, TextTable& table) {
  table.add_row({heading(record, "force"), "max |F|", "max |torque|", "work"});
  const Figures figure{record};
  const PeakValues& peaks = record.statistics.largest().places();
  for (int f = 0; f < static_cast<int>(record.model.force_elements.size()); ++f) {
    const ForceStatistics seen = record.statistics.force(f);
    // A lever shorter than any is what rounding leaves of a force through the origin.
    const bool pure_force = seen.max_torque <= 1e-14 * seen.max_force,
               pure_torque = seen.max_force == 0.0 && !pure_force;
    const std::string name = force_words(record.model, f).name;
    table.add_row({name,
                   pure_torque ? "-"
                               : figure("forces", name, "max_force", seen.max_force, "N",
                                        figure.noise_of(peaks.applied_force(f))),
                   pure_force ? "-"
                              : figure("forces", name, "max_torque", seen.max_torque, "N*m",
                                       figure.noise_of(peaks.applied_torque(f))),
                   figure("forces", name, "work", seen.work, "J")});
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
  const Figures figure{record};
  const PeakValues& peaks = record.statistics.largest().places();
  for (std::size_t i = 0; i < drivers.size(); ++i) {
    const DriverStatistics seen = record.statistics.driver(static_cast<int>(i));
    const char* unit = is_slide(record.model, drivers[i]) ? "N" : "N*m";
    table.add_row({drivers[i].name,
                   figure("drivers", drivers[i].name, "max_abs", seen.max_abs, unit,
                          figure.noise_of(peaks.effort(static_cast<int>(i)))),
                   figure("drivers", drivers[i].name, "rms", seen.rms, unit,
                          FigureNoise(record.statistics).rms_of_driver(static_cast<int>(i)))});
  }
}

void add_paths(const RunRecord& record, TextTable& table) {
  table.add_row({heading(record, "path"), "max error", "rms", "max angle", "rms"});
  const Figures figure{record};
  const PeakValues& peaks = record.statistics.largest().places();
  for (std::size_t i = 0; i < record.model.kinematics.size(); ++i) {
    const PathStatistics seen = record.statistics.path(static_cast<int>(i));
    const FigureNoise::OfPath noise = FigureNoise(record.statistics).path(static_cast<int>(i));
    const std::string& name = record.model.kinematics[i].name;
    table.add_row({name,
                   figure("paths", name, "max_position", seen.max_position, "m",
                          figure.noise_of(peaks.position_error(static_cast<int>(i))), prefixed),
                   figure("paths", name, "rms_position", seen.rms_position, "m", noise.rms_position, prefixed),
                   figure("paths", name, "max_angle", seen.max_angle, "rad",
                          figure.noise_of(peaks.angle_error(static_cast<int>(i))), prefixed),
                   figure("paths", name, "rms_angle", seen.rms_angle, "rad", noise.rms_angle, prefixed)});
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

/// What a figure with its noise says, where there is one.
std::string noise_line(const Model& model, const std::string& tables) {
  if (tables.find(" +- ") == std::string::npos) return {};
  return fmt::format("  +-: another step, accuracy or build may change a figure by so much{}\n",
                     can_be_repeated(model) ? ", another start by more (--repeat N)" : "");
}

std::string how_others_start(const Json& repeat) {
  const double moved = repeat["moved"].get<double>();
  return moved > 0.0 ? fmt::format("moved in their play by up to {:g} % of it", 100.0 * moved)
                     : fmt::format("pushed by up to {:g} % of their speed", 100.0 * repeat["pushed"].get<double>());
}

/// From which starts the medians and ranges are, and which runs are not among them.
std::string repeat_lines(const Json& repeat) {
  if (repeat.is_null()) return {};
  const auto runs = repeat["runs"].get<std::size_t>(), completed = repeat["completed"].get<std::size_t>();
  std::string text = completed == 0
                         ? "  figures are those of the first run: none was completed\n"
                         : fmt::format("  median (range) of {} runs: the model's own start, the others {} (seed {})\n",
                                       completed, how_others_start(repeat), repeat["seed"].get<std::uint64_t>());
  for (const Json& failed : repeat["failed"]) {
    text += fmt::format("  run {} of {} failed: {}\n", failed["run"].get<std::size_t>(), runs,
                        failed["reason"].get<std::string>());
  }
  const std::size_t missing = runs - completed - repeat["failed"].size();
  return missing == 0 ? text : text + fmt::format("  {} of {} runs were not finished\n", missing, runs);
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
  TextTable play({Align::left, Align::right, Align::right, Align::right, Align::right});
  if (std::ranges::any_of(record.model.joints, is_listed)) add_joints(record, joints);
  bool plays = false;
  for (int j = 0; j < static_cast<int>(record.model.joints.size()); ++j) plays = plays || record.clearances.has(j);
  if (plays && record.repeat.is_null() && record.statistics.any()) add_play(record, play);
  if (!record.model.drivers.empty()) add_drivers(record, drivers);
  if (!record.model.kinematics.empty()) add_paths(record, paths);
  if (!record.model.gears.empty()) add_gears(record, gears);
  if (!record.model.force_elements.empty()) add_forces(record, forces);
  const std::string tables = joints.text("  ") + play.text("  ") + gears.text("  ") + drivers.text("  ") +
                             forces.text("  ") + paths.text("  ");
  text += tables + noise_line(record.model, tables) + window_lines(record);
  if (std::ranges::any_of(record.model.joints, couples_alone)) text += gear_sentence;
  text += twin_line(record.twin);
  text += repeat_lines(record.repeat);
  const bool any = record.statistics.any();
  text += steps_per_impact(record);
  text += fmt::format("  energy residual {}   position residual {}\n",
                      any ? quantity(record.statistics.energy_residual(), "J", 2) : "-",
                      any ? quantity(record.statistics.position_residual(), "m", 2) : "-");
  return text + trust_line(record.trust);
}

}  // namespace freeplay
