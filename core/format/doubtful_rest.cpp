#include "format/doubtful_rest.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "format/doubtful_body.h"
#include "format/doubtful_number.h"
#include "format/motion_course.h"

namespace freeplay {
namespace {

constexpr std::size_t most_formulas = 2000;   // that are looked at
constexpr double later[] = {10.0, 1e3, 1e6};  // runs in which what rests may begin
constexpr double inside = 1.0 - 1e-9;         // part of the run: what begins at its very end does so after it
constexpr double ramp_beyond = 20.0;          // the end of a ramp that begins in the run, in runs
constexpr double ramp_within = 2000.0;        // and that is looked for: a second in milliseconds is a thousand
constexpr double late_runs = 100.0;           // after what changes in the run
constexpr double most_of_ramp = 0.05;         // of its change, in the run
constexpr std::size_t most_corners = 64;      // of a motion that is a ramp

/// What is written of formulas, or a table, that depend on time.
struct Waiting {
  CheckedValue written;
  bool is_load = false;  ///< a force, torque, effort or what makes one: zero is nothing at all
  bool zero = true;      ///< in the whole run
  double begins = unbounded;
};

class RestDoubts {
 public:
  explicit RestDoubts(const Draft& draft) : draft_(draft), settings_(draft.model.settings) {}

  void judge(const Driver& driver) const {
    const auto entry = map_of("drivers", driver.name);
    if (!entry) return;
    MapReader map(*entry, "driver");
    const bool is_load = !prescribes(driver.kind);
    if (driver.table) {
      const auto written = map.find("table");
      if (written) judge(*driver.table, {.written = *written, .is_load = is_load});
      return;
    }
    const bool plain = driver.by_motion.empty();
    judge(map, "value", plain ? std::span(&driver.value, 1) : std::span(driver.in_time), is_load, plain);
  }

  void judge(const AppliedForce& force) const {
    const auto entry = map_of("forces", force.name);
    if (!entry) return;
    MapReader map(*entry, "force");
    map.follow(force.kind == ForceKind::torque ? "force torque" : "force force");
    const bool plain = force.by_motion.empty();
    judge(map, "value", plain ? force.value : force.in_time, true, plain);
  }

  void judge(const Draft::Timed& timed) const {
    judge(timed.parts, {.written = timed.written, .is_load = timed.is_load, .zero = timed.whole});
  }

 private:
  std::optional<CheckedValue> map_of(const char* section, const std::string& name) const {
    const auto entry = entry_of(draft_, section, name);
    return entry && entry->node().is_map() ? entry : std::nullopt;
  }

  void judge(MapReader& map, const char* key, std::span<const Expression> formulas, bool is_load, bool whole) const {
    const auto written = map.find(key);
    if (written) judge(formulas, {.written = *written, .is_load = is_load, .zero = whole});
  }

  double span() const { return settings_.end - settings_.start; }

  /// A polynomial of low degree that has one value at many instants is that value.
  bool stays(const Expression& formula, double runs) const {
    const Course course = course_of(formula, settings_, runs);
    if (!course.known || course.low != course.high) return false;
    const Outline outline = formula.outline(settings_.start, settings_.start + runs * span());
    return outline.corners.empty() && std::ranges::all_of(outline.rates, [](double rate) { return rate == 0.0; });
  }

  /// When a formula that rests in the run begins to change; infinite where it does not in a very long time.
  double beginning(const Expression& formula) const {
    for (const double runs : later) {
      const Outline outline = formula.outline(settings_.start + inside * span(), settings_.start + runs * span());
      if (!outline.corners.empty()) return outline.corners.front().time;
    }
    return unbounded;
  }

  void judge(std::span<const Expression> formulas, Waiting waiting) const {
    bool any = false;
    for (const Expression& formula : formulas) {
      if (formula.depends_on_time() && !stays(formula, inside)) return doubt_ramps(formulas, waiting.written);
      any = any || formula.depends_on_time();
      const Course course = course_of(formula, settings_, inside);
      waiting.zero = waiting.zero && course.known && course.low == 0.0 && course.high == 0.0;
    }
    if (!any) return;
    for (const Expression& formula : formulas) {
      if (formula.depends_on_time()) waiting.begins = std::min(waiting.begins, beginning(formula));
    }
    if (!says_time(waiting.written)) {
      warn(waiting, "write the unit after its times, as in 'ms', or check the end of the run");
    } else if (waiting.is_load && waiting.zero) {
      warn(waiting, "check its times and the end of the run");
    }
  }

  void doubt_ramps(std::span<const Expression> formulas, const CheckedValue& written) const {
    if (says_time(written)) return;
    for (const Expression& formula : formulas) {
      if (!formula.depends_on_time()) continue;
      if (const double late = late_change(formula); late < unbounded) {
        written.warn(
            "doubtful-time",
            fmt::format("'{}' changes in the run, which ends at {:.4g} s, and again at {:.4g} s: write the unit "
                        "after its times, as in 'ms', or check the end of the run",
                        written.path(), settings_.end, late));
        return;
      }
      const double end = end_of_ramp(formula);
      if (!(end < unbounded)) continue;
      written.warn("doubtful-time",
                   fmt::format("'{}' has only begun to change when the run ends at {:.4g} s, and goes on to {:.4g} s: "
                               "write the unit after its times, as in 'ms', or check the end of the run",
                               written.path(), settings_.end, end));
      return;
    }
  }

  /// A polynomial of low degree that has one value at three instants is that value.
  static bool rests_between(const Expression& formula, double from, double until) {
    Jet first, jet;
    EvaluationFailure failure;
    if (!formula.evaluate(from, first, failure)) return false;
    constexpr double parts[] = {0.23, 0.5, 0.77};
    return std::ranges::all_of(parts, [&](double part) {
      return formula.evaluate(from + part * (until - from), jet, failure) && jet.value == first.value;
    });
  }

  /// The first change long after the run of what has some within it and is at rest in between; infinite without.
  double late_change(const Expression& formula) const {
    const double from = settings_.start, until = from + ramp_within * span();
    const Outline outline = formula.outline(from, until);
    if (outline.corners.empty() || outline.corners.size() > most_corners) return unbounded;
    for (std::size_t i = 1; i < outline.corners.size(); ++i) {
      const double time = outline.corners[i].time;
      if (outline.corners[i - 1].time >= from + inside * span()) return unbounded;
      if (time > from + late_runs * span() && rests_between(formula, outline.corners[i - 1].time, time)) return time;
    }
    return unbounded;
  }

  /// When a motion comes gently to rest that begins in the run and has hardly changed at its end; else infinite.
  double end_of_ramp(const Expression& formula) const {
    // What swings has changed as much in the run as in a longer one, and has many corners.
    const Course here = course_of(formula, settings_), longer = course_of(formula, settings_, ramp_beyond);
    if (!here.known || !longer.known || here.high - here.low > 0.5 * (longer.high - longer.low)) return unbounded;
    const double from = settings_.start, until = from + ramp_within * span();
    const Outline outline = formula.outline(from, until);
    if (outline.corners.empty() || outline.corners.size() > most_corners || outline.rates.back() != 0.0)
      return unbounded;
    const double end = outline.corners.back().time;
    if (!(end - from > ramp_beyond * span())) return unbounded;
    Jet begin, before, at_rest, after;
    EvaluationFailure failure;
    if (!formula.evaluate(from, begin, failure) || !formula.evaluate(end - 1e-6 * (end - from), before, failure) ||
        !formula.evaluate(end, at_rest, failure) || !formula.evaluate(2.0 * end - from, after, failure))
      return unbounded;
    // What rises and falls again changes by more than from its begin to its end.
    const Course whole = course_of(formula, settings_, (end - from) / span());
    const double change = std::max(std::abs(at_rest.value - begin.value), whole.known ? whole.high - whole.low : 0.0);
    const bool rests = std::abs(after.value - at_rest.value) <= 1e-9 * change;
    // A limit that min() sets to what grows is a kink, and of no time.
    const bool gently = std::abs(before.rate) * (end - from) <= 1e-3 * change;
    return rests && gently && here.high - here.low <= most_of_ramp * change ? end : unbounded;
  }

  /// The last point before a table that has `value` at `start` leaves it; infinite where it keeps it for good.
  static double leaving(const TimeTable& table, double start, double value) {
    double point = start;
    // Of one that repeats each point comes within a period, and those at its ends may come twice.
    for (std::size_t i = 0; i < table.times().size() + 3; ++i) {
      const double next = table.next_point(point);
      if (!(next < unbounded)) break;
      for (const double t : {0.5 * (point + next), next}) {
        Jet jet;
        EvaluationFailure failure;
        if (table.evaluate(t, jet, failure) && jet.value != value) return point;
      }
      point = next;
    }
    return unbounded;
  }

  void judge(const TimeTable& table, Waiting waiting) const {
    const double end = settings_.start + inside * span();
    Jet first, jet;
    EvaluationFailure failure;
    if (!table.evaluate(settings_.start, first, failure)) return;
    for (std::size_t i = 0; i <= 128; ++i) {
      const double t = settings_.start + (end - settings_.start) * static_cast<double>(i) / 128.0;
      if (!table.evaluate(t, jet, failure) || jet.value != first.value) return;
    }
    if (std::ranges::all_of(table.values(), [&](double value) { return value == first.value; })) return;
    waiting.zero = first.value == 0.0, waiting.begins = leaving(table, settings_.start, first.value);
    if (!(waiting.begins >= end && waiting.begins < unbounded)) return;
    // What has changed before the run does not begin to.
    for (std::size_t i = 0; i < table.times().size() && table.times()[i] <= settings_.start; ++i) {
      if (table.values()[i] != first.value) return;
    }
    warn(waiting, "check the unit of its times, or the end of the run");
  }

  void warn(const Waiting& waiting, const char* remedy) const {
    const bool nothing = waiting.is_load && waiting.zero;
    std::string begins;
    if (waiting.begins < unbounded) begins = fmt::format(", at {:.4g} s", waiting.begins);
    const bool is_long = !(waiting.begins < settings_.start + later[0] * span());
    waiting.written.warn(
        "doubtful-time",
        fmt::format("'{}' depends on t, but the run ends at {:.4g} s, {}before it begins to change{}{}: {}",
                    waiting.written.path(), settings_.end, is_long ? "long " : "", begins,
                    nothing ? ", so that it is zero all the time" : "", remedy));
  }

  const Draft& draft_;
  const Settings& settings_;
};

}  // namespace

void doubt_rests(const Draft& draft) {
  if (draft.options.end) return;  // an end given to the run, not by the file, may cut it short on purpose
  const RestDoubts doubts(draft);
  const Model& model = draft.model;
  for (std::size_t i = 0; i < std::min(model.drivers.size(), most_formulas); ++i) {
    if (model.drivers[i].kinematics < 0) doubts.judge(model.drivers[i]);
  }
  for (std::size_t i = 0; i < std::min(model.forces.size(), most_formulas); ++i) doubts.judge(model.forces[i]);
  for (std::size_t i = 0; i < std::min(draft.timed.size(), most_formulas); ++i) doubts.judge(draft.timed[i]);
}

}  // namespace freeplay
