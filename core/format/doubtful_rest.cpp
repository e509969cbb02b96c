#include "format/doubtful_rest.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "format/doubtful_body.h"
#include "format/doubtful_number.h"
#include "format/motion_course.h"

namespace freeplay {
namespace {

constexpr std::size_t most_formulas = 2000;  // that are looked at
constexpr double runs = 10.0;                // for which nothing happens

// A polynomial of low degree that has one value at many instants is that value.
bool stays(const Expression& formula, const Settings& settings) {
  const Course course = course_of(formula, settings, runs);
  if (!course.known || course.low != course.high) return false;
  const Outline outline = formula.outline(settings.start, settings.start + runs * (settings.end - settings.start));
  return outline.corners.empty() && std::ranges::all_of(outline.rates, [](double rate) { return rate == 0.0; });
}

/// Of what depends on time, all rests.
bool all_stay(const std::vector<const Expression*>& formulas, const Settings& settings) {
  bool any = false;
  for (const Expression* formula : formulas) {
    if (!formula->depends_on_time()) continue;
    if (!stays(*formula, settings)) return false;
    any = true;
  }
  return any;
}

void judge(const Draft& draft, const char* section, const std::string& name, const char* format,
           const std::vector<const Expression*>& formulas) {
  const Settings& settings = draft.model.settings;
  if (!all_stay(formulas, settings)) return;
  const auto entry = entry_of(draft, section, name);
  if (!entry || !entry->node().is_map()) return;
  MapReader map(*entry, format == nullptr ? "driver" : "force");
  if (format != nullptr) map.follow(format);
  const auto written = map.find("value");
  if (!written || says_unit(*written, Arguments::read)) return;
  written->warn(
      "doubtful-time",
      fmt::format("'{}' depends on t, but the run ends at {:.4g} s, long before it begins to change: write the "
                  "unit after its times, as in 'ms', or check the end of the run",
                  written->path(), settings.end));
}

}  // namespace

void doubt_rests(const Draft& draft) {
  if (draft.options.end) return;  // an end given to the run, not by the file, may cut it short on purpose
  const Model& model = draft.model;
  std::vector<const Expression*> formulas;
  const auto take = [&](const std::vector<Expression>& parts) {
    for (const Expression& part : parts) formulas.push_back(&part);
  };
  for (std::size_t i = 0; i < std::min(model.drivers.size(), most_formulas); ++i) {
    const Driver& driver = model.drivers[i];
    if (driver.table || driver.kinematics >= 0) continue;
    formulas.clear();
    if (driver.by_motion.empty()) {
      formulas.push_back(&driver.value);
    } else {
      take(driver.in_time);
    }
    judge(draft, "drivers", driver.name, nullptr, formulas);
  }
  for (std::size_t i = 0; i < std::min(model.forces.size(), most_formulas); ++i) {
    const AppliedForce& force = model.forces[i];
    formulas.clear();
    take(force.in_time);
    judge(draft, "forces", force.name, force.kind == ForceKind::torque ? "force torque" : "force force", formulas);
  }
}

}  // namespace freeplay
