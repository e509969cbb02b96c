#include "format/doubtful_end.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "format/doubtful_number.h"
#include "format/map_reader.h"

namespace freeplay {
namespace {

constexpr std::size_t most_counted = 200;  // drivers and forces whose periods are counted
constexpr int looks = 211;                 // at a driver in the run: a prime, so that few periods are in step with it
constexpr int fewest_reversals = 16;       // between them, of what swings all the time
constexpr double most_steps = 1e9, most_bare_steps = 1e7, many_steps = 1e6;
constexpr double many_turns = 1000.0, most_turns = 1500.0;

struct Turns {
  const Driver* driver = nullptr;
  double count = 0.0;
};

/// Revolutions or swings of a driver in the run; 0 for one that does neither all the time.
double turns_of(const Driver& driver, const Model& model) {
  const Settings& settings = model.settings;
  if (driver.table || driver.kinematics >= 0 || !driver.by_motion.empty()) return 0.0;
  const bool speeds = driver.kind == DriverKind::velocity;
  const double span = settings.end - settings.start;
  int reversals = 0;
  double before = 0.0, sum = 0.0, fastest = 0.0, low = unbounded, high = -unbounded;
  for (int i = 0; i <= looks; ++i) {
    Jet jet;
    EvaluationFailure failure;
    if (!driver.value.evaluate(settings.start + span * i / looks, jet, failure)) return 0.0;
    const double rate = speeds ? jet.value : jet.rate;
    if (rate * before < 0.0) ++reversals;
    if (rate != 0.0) before = rate;
    sum += rate;
    fastest = std::max(fastest, std::abs(rate));
    low = std::min(low, jet.value), high = std::max(high, jet.value);
  }
  // A sine of this range and rate has this many periods.
  if (reversals >= fewest_reversals) return speeds ? 0.0 : fastest / (0.5 * (high - low)) * span / (2.0 * M_PI);
  const bool turns =
      model.joints[static_cast<std::size_t>(driver.joint)].ideal_layout().coordinate == Coordinate::angle;
  if (reversals > 0 || !turns || !prescribes(driver.kind)) return 0.0;
  return std::abs(sum) / (looks + 1) * span / (2.0 * M_PI);
}

Turns slowest_of(const Model& model) {
  Turns slowest;
  for (std::size_t i = 0; i < std::min(model.drivers.size(), most_counted); ++i) {
    const double count = turns_of(model.drivers[i], model);
    if (count > 0.0 && (slowest.driver == nullptr || count < slowest.count)) slowest = {&model.drivers[i], count};
  }
  return slowest;
}

}  // namespace

void doubt_end(const Draft& draft, const CheckedValue& simulation) {
  const Settings& settings = draft.model.settings;
  if (draft.options.end || draft.options.step || draft.options.accuracy || draft.model.bodies.empty()) return;
  if (!simulation.node().is_map()) return;
  const auto written = MapReader(simulation, "simulation").find("end");
  if (!written || !written->node().is_scalar()) return;
  const double span = settings.end - settings.start;
  const double steps = settings.adaptive ? 0.0 : span / std::min(settings.step, settings.interval);
  const bool bare = !names_a_unit(*written);
  if (!bare && steps <= most_steps) return;
  const Turns turns = slowest_of(draft.model);
  const bool goes_on = settings.adaptive ? turns.count > most_turns : steps > many_steps && turns.count > many_turns;
  if (steps <= (bare ? most_bare_steps : most_steps) && !goes_on) return;
  std::string takes;
  if (steps > 0.0) takes = fmt::format("{:.3g} steps of {:.3g} s", steps, span / steps);
  if (turns.driver != nullptr) {
    takes += fmt::format("{}{:.3g} turns or swings of driver '{}'", takes.empty() ? "" : " and ", turns.count,
                         turns.driver->name);
  }
  const std::string remedy =
      bare ? fmt::format("write '{0:.6g} ms' if milliseconds are meant, else '{0:.6g} s'", settings.end)
           : std::string("check it, and the step");
  written->warn("doubtful-time",
                fmt::format("'{}' is {:.6g} s, which takes {}: {}", written->path(), settings.end, takes, remedy));
}

}  // namespace freeplay
