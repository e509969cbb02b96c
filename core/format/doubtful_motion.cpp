#include "format/doubtful_motion.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "format/doubtful_body.h"
#include "format/doubtful_number.h"
#include "format/doubtful_points.h"
#include "format/doubtful_threshold.h"
#include "format/motion_course.h"
#include "model/force_element.h"
#include "model/rotation.h"

namespace freeplay {
namespace {

constexpr std::size_t most_drivers = 2000;  // that are looked at
constexpr double table_beyond = 50.0;       // the end of a table, in runs
constexpr double largest_turn = 0.5;        // in a fixed step [rad]

std::string_view word_after(std::string_view text, std::size_t i) {
  const std::size_t begin = std::min(text.find_first_not_of(' ', i), text.size());
  std::size_t end = begin;
  while (end < text.size() && std::isalpha(static_cast<unsigned char>(text[end]))) ++end;
  return text.substr(begin, end - begin);
}

/// Numbers that are written in the text without a unit, and those of its parameters that have no dimension.
std::vector<double> numbers_in(const CheckedValue& written) {
  const std::string& text = written.node().text;
  std::vector<double> numbers;
  for (std::size_t i = 0; i < text.size();) {
    const auto digit = [&](std::size_t at) { return at < text.size() && text[at] >= '0' && text[at] <= '9'; };
    if (digit(i) || (text[i] == '.' && digit(i + 1))) {
      double number = 0.0;
      const auto read = std::from_chars(text.data() + i, text.data() + text.size(), number);
      i = std::max(static_cast<std::size_t>(read.ptr - text.data()), i + 1);
      if (!is_unit_name(word_after(text, i))) numbers.push_back(number);
    } else if (std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_') {
      while (i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_')) ++i;
    } else {
      ++i;
    }
  }
  for (const std::string& name : referenced_parameters(text)) {
    const Quantity* quantity = written.reading().scope->find(name);
    if (quantity != nullptr && quantity->kind != DimensionKind::dimensioned) numbers.push_back(quantity->value);
  }
  return numbers;
}

class MotionDoubts {
 public:
  explicit MotionDoubts(const Draft& draft) : draft_(draft), settings_(draft.model.settings) {}

  void judge(const Driver& driver) const {
    const Coordinate coordinate = draft_.model.joints[static_cast<std::size_t>(driver.joint)].ideal_layout().coordinate;
    const Course course = course_of(driver.value, settings_);
    if (!course.known) return;
    const auto written = key_of(driver, "value");
    if (!written) return;
    const bool speeds = driver.kind == DriverKind::velocity;
    const double peak =
        speeds ? std::max(std::abs(course.low), std::abs(course.high)) : peak_speed(driver.value, settings_);
    if (doubt_peak(driver, peak, *written)) return;
    if (coordinate == Coordinate::angle) {
      judge_turns(driver, course, *written);
    } else {
      judge_slide(driver, course, *written);
    }
  }

  void judge_table(const Driver& driver) {
    const auto written = key_of(driver, "table");
    if (!written) return;
    const TimeTable& table = *driver.table;
    const double last = table.times().back(), span = settings_.end - settings_.start;
    const TableSource& source = driver.table_source;
    if (source.time_unit.empty() && !points_say_unit(*written, 0) && last - settings_.start > table_beyond * span) {
      written->warn("doubtful-time", fmt::format("'{}' goes on to {:.4g} s, but the run takes {:.4g} s: write "
                                                 "'time_unit: ms' if milliseconds are meant",
                                                 written->path(), last, span));
    }
    // Drivers may share a long table: it is looked at once.
    if (looked_at_.insert(&table).second) doubt_overshoot(table, *written, {"t", " s"});
    if (!prescribes(driver.kind)) return;
    const auto [low, high] = std::ranges::minmax(table.values());
    const bool speeds = driver.kind == DriverKind::velocity,
               bare = source.unit.empty() && !points_say_unit(*written, 1);
    const double fastest = speeds ? std::max(std::abs(low), std::abs(high)) : steepest(table);
    if (!bare && doubt_peak(driver, fastest, *written)) return;
    if (coordinate(driver) != Coordinate::angle) return judge_table_of_slide(driver, high - low, fastest, bare);
    const bool begins_far = settings_.start == 0.0 && std::abs(table.values()[0]) > bare_limit::angle;
    if (bare && !speeds &&
        (begins_far || looks_like_degrees(table.values()) || rests_at_round_number(table.values()))) {
      written->warn("doubtful-angle",
                    fmt::format("'{}' goes from {:.6g} to {:.6g} rad: write 'unit: deg' if degrees are meant, else "
                                "'unit: rad'",
                                written->path(), low, high));
    } else if (bare && doubt_pins(driver, fastest, *written, speeds ? "unit: rpm" : "unit: deg")) {
      return;
    } else if (bare && fastest >= bare_limit::angular_speed) {
      written->warn("doubtful-speed",
                    fmt::format("'{}' comes to {:.6g} rad/s, that is {:.0f} rpm: write 'unit: {}' if that is meant, "
                                "else 'unit: {}'",
                                written->path(), fastest, fastest * 30.0 / M_PI, speeds ? "rpm" : "deg",
                                speeds ? "rad/s" : "rad"));
    }
  }

 private:
  std::optional<CheckedValue> key_of(const Driver& driver, const char* key) const {
    const auto entry = entry_of(draft_, "drivers", driver.name);
    if (!entry || !entry->node().is_map()) return std::nullopt;
    return MapReader(*entry, "driver").find(key);
  }

  /// Is some time (0) or value (1) of the points of a table written with a unit?
  static bool points_say_unit(const CheckedValue& table, std::size_t which) {
    if (!table.node().is_map()) return false;
    const auto points = MapReader(table, "table").find("points");
    if (!points || !points->node().is_list()) return false;
    for (std::size_t i = 0; i < points->node().items.size(); ++i) {
      const CheckedValue point = points->item(i);
      if (point.node().is_list() && which < point.node().items.size() && says_unit(point.item(which))) return true;
    }
    return false;
  }

  Coordinate coordinate(const Driver& driver) const {
    return draft_.model.joints[static_cast<std::size_t>(driver.joint)].ideal_layout().coordinate;
  }

  /// A speed that no machine has, be its unit written or not. True after a message.
  bool doubt_peak(const Driver& driver, double speed, const CheckedValue& written) const {
    const bool turns = coordinate(driver) == Coordinate::angle;
    if (turns && speed <= fastest_motion::turn) return doubt_rim(driver, speed, written);
    if (!(speed > (turns ? fastest_motion::turn : fastest_motion::slide))) return false;
    written.warn("doubtful-speed",
                 fmt::format("'{}' comes to {:.3g} {}, faster than any machine: check its numbers, its "
                             "times and their units",
                             written.path(), speed, turns ? "rad/s" : "m/s"));
    return true;
  }

  /// A body that is turned so fast that it would burst. True after a message.
  bool doubt_rim(const Driver& driver, double speed, const CheckedValue& written) const {
    const JointElement& joint = draft_.model.joints[static_cast<std::size_t>(driver.joint)];
    for (const int marker : {joint.marker_a, joint.marker_b}) {
      const BodyId b = draft_.model.markers[static_cast<std::size_t>(marker)].body;
      if (b == ground) continue;
      const Body& body = draft_.model.bodies[static_cast<std::size_t>(b)];
      // In space any axis may be meant: the least moment is about it at least.
      const double least = draft_.model.space == Space::spatial ? principal_moments(body.inertia)[0] : body.inertia[8];
      const double rim = speed * std::sqrt(std::max(least, 0.0) / body.mass);
      if (!(rim > fastest_motion::rim)) continue;
      written.warn("doubtful-speed",
                   fmt::format("'{}' comes to {:.3g} rad/s, where '{}' would turn with {:.3g} m/s at its radius of "
                               "gyration and burst: check speed, mass and inertia and their units",
                               written.path(), speed, body.name, rim));
      return true;
    }
    return false;
  }

  /// Largest slope between two points.
  static double steepest(const TimeTable& table) {
    double most = 0.0;
    for (std::size_t i = 1; i < table.times().size(); ++i) {
      const double step = table.times()[i] - table.times()[i - 1];
      most = std::max(most, std::abs(table.values()[i] - table.values()[i - 1]) / step);
    }
    return most;
  }

  void judge_table_of_slide(const Driver& driver, double range, double fastest, bool bare) const {
    const auto written = key_of(driver, "table");
    const double scale = draft_.length_scale;
    if (!bare) return;
    if (driver.kind == DriverKind::position && scale > 0.0 && range > bare_limit::length * scale) {
      written->warn("doubtful-length",
                    fmt::format("'{}' moves by {:.4g} m where the lengths of the mechanism are about "
                                "{:.3g} m: write 'unit: mm' if millimetres are meant, else 'unit: m'",
                                written->path(), range, scale));
    } else if (fastest > bare_limit::slide_speed) {
      written->warn("doubtful-speed",
                    fmt::format("'{}' comes to {:.4g} m/s: write its unit, as in 'unit: {}'", written->path(), fastest,
                                driver.kind == DriverKind::position ? "mm" : "mm/s"));
    }
  }

  /// To and fro by more than a turn in radians, as of formulas; or multiples of 45 beyond it.
  static bool looks_like_degrees(std::span<const double> values) {
    bool forward = false, back = false, eighths = true;
    for (std::size_t i = 0; i < values.size(); ++i) {
      eighths = eighths && std::abs(std::remainder(values[i], 45.0)) < 1e-9 && std::abs(values[i]) <= 720.0;
      if (i > 0) (values[i] > values[i - 1] ? forward : back) |= values[i] != values[i - 1];
    }
    const auto [low, high] = std::ranges::minmax(values);
    return high - low > bare_limit::angle && (eighths || (forward && back));
  }

  /// Comes to rest more than a turn away at a whole number or a half, as formulas do at a written one: no radian is
  /// a part of a turn.
  static bool rests_at_round_number(std::span<const double> values) {
    const std::size_t n = values.size();
    return n > 1 && values[n - 1] == values[n - 2] && std::abs(values[n - 1] - values[0]) > bare_limit::angle &&
           std::abs(std::remainder(values[n - 1], 0.5)) < 1e-9;
  }

  void judge_turns(const Driver& driver, const Course& course, const CheckedValue& written) const {
    const bool angle = driver.kind == DriverKind::angle;
    const double speed = angle ? course.fastest : std::max(std::abs(course.low), std::abs(course.high));
    judge_step(speed, written);
    // Degrees of one term are not those of another, as in '-70 deg - 40*smooth(t, 1 s, 2 s)'.
    const bool united = names_a_unit(written);
    if (united && angle && doubt_bare_term(written)) return;
    if (united && (!angle || written.node().text.find("rad") != std::string::npos)) return;
    const bool far = angle && settings_.start == 0.0 && std::abs(course.begin) > bare_limit::angle;
    if (far && doubt_angle(written, course.begin)) return;
    const double swing = angle ? amplitude(driver.value, written) : 0.0;
    if (swing > bare_limit::angle) {
      written.warn("doubtful-angle", fmt::format("'{0}' swings or turns by {1:.6g} rad: write '{1:.6g} deg' if degrees "
                                                 "are meant, else '{1:.6g} rad'",
                                                 written.path(), swing));
    } else if (!united) {
      if (!doubt_pins(driver, speed, written, fmt::format("{:.6g} rpm", speed))) doubt_angular_speed(written, speed);
    }
  }

  /// The joint that goes round farthest from the axis of a driven one, on the link that is turned.
  struct Pin {
    const Marker* marker = nullptr;
    double arm = 0.0;  ///< [m]
  };
  Pin farthest_pin(const JointElement& driven) const {
    const Model& model = draft_.model;
    Pin farthest;
    for (const int axle : {driven.marker_a, driven.marker_b}) {
      const Marker& here = model.markers[static_cast<std::size_t>(axle)];
      if (here.body == ground) continue;
      for (const JointElement& joint : model.joints) {
        if (is_force_element(joint) || joint.gear >= 0 || &joint == &driven) continue;
        for (const int end : {joint.marker_a, joint.marker_b}) {
          const Marker& there = model.markers[static_cast<std::size_t>(end)];
          if (there.body != here.body) continue;
          const double arm = distance_from_axis(here, there);
          if (arm > farthest.arm) farthest = {&there, arm};
        }
      }
    }
    return farthest;
  }

  double distance_from_axis(const Marker& axle, const Marker& pin) const {
    Vector3 apart;
    for (std::size_t i = 0; i < 3; ++i) apart[i] = pin.position[i] - axle.position[i];
    if (draft_.model.space == Space::spatial) {
      double along = 0.0;
      for (std::size_t i = 0; i < 3; ++i) along += apart[i] * axle.rotation[3 * i + 2];
      for (std::size_t i = 0; i < 3; ++i) apart[i] -= along * axle.rotation[3 * i + 2];
    }
    return std::hypot(apart[0], apart[1], apart[2]);
  }

  /// A crank whose pin outruns those of all engines. True after a message.
  bool doubt_pins(const Driver& driver, double speed, const CheckedValue& written, const std::string& instead) const {
    const Pin pin = farthest_pin(draft_.model.joints[static_cast<std::size_t>(driver.joint)]);
    if (!(speed * pin.arm > bare_limit::pin_speed)) return false;
    written.warn("doubtful-speed",
                 fmt::format("'{}' comes to {:.6g} rad/s, that is {:.0f} rpm, with which the joint at '{}' would go "
                             "round at {:.3g} m/s (pins of fast engines do at 40): write '{}' if that is meant, else "
                             "the unit rad/s",
                             written.path(), speed, speed * 30.0 / M_PI, pin.marker->name, speed * pin.arm, instead));
    return true;
  }

  /// The written number by which the motion swings to each side, or which it goes through in all, in the run or in a
  /// longer one; 0 when there is none.
  double amplitude(const Expression& motion, const CheckedValue& written) const {
    for (const double spans : {1.0, 30.0, 1000.0}) {
      const Course course = course_of(motion, settings_, spans);
      if (!course.known || !course.returns) continue;
      const double range = course.high - course.low;
      for (const double number : numbers_in(written)) {
        const auto is = [&](double value) { return std::abs(value - number) <= 0.03 * number; };
        if (number > bare_limit::angle && (is(range) || is(0.5 * range))) return number;
      }
    }
    return 0.0;
  }

  void judge_slide(const Driver& driver, const Course& course, const CheckedValue& written) const {
    const double range = course.high - course.low, scale = draft_.length_scale;
    if (names_a_unit(written)) {
      if (driver.kind == DriverKind::position) doubt_bare_place(written, scale);
      return;
    }
    if (driver.kind != DriverKind::position) {
      return doubt_slide_speed(written, std::max(std::abs(course.low), std::abs(course.high)));
    }
    if (!course.returns || !(scale > 0.0) || range <= bare_limit::length * scale) {
      return doubt_slide_speed(written, course.fastest);
    }
    written.warn("doubtful-length", fmt::format("'{}' moves by {:.4g} m where the lengths of the mechanism are about "
                                                "{:.3g} m: write the unit after the number, as in 'mm'",
                                                written.path(), range, scale));
  }

  void judge_step(double speed, const CheckedValue& written) const {
    const double step = std::min(settings_.step, settings_.interval);  // steps end at rows
    if (settings_.adaptive || speed * step <= largest_turn) return;
    written.warn("doubtful-time",
                 fmt::format("'{}' turns the joint by {:.3g} rad in one step of {:.3g} s: shorten 'step', or give "
                             "'accuracy' in its place",
                             written.path(), speed * step, step));
  }

  const Draft& draft_;
  const Settings& settings_;
  std::set<const TimeTable*> looked_at_{};
};

}  // namespace

void doubt_motions(const Draft& draft) {
  MotionDoubts doubts(draft);
  const std::vector<Driver>& drivers = draft.model.drivers;
  for (std::size_t i = 0; i < std::min(drivers.size(), most_drivers); ++i) {
    if (drivers[i].kinematics >= 0) continue;
    if (drivers[i].table != nullptr) {
      doubts.judge_table(drivers[i]);
    } else if (prescribes(drivers[i].kind)) {
      doubts.judge(drivers[i]);
    }
  }
}

}  // namespace freeplay
