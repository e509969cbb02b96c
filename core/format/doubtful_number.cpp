#include "format/doubtful_number.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "component/contact_stiffness.h"
#include "format/doubtful_threshold.h"
#include "format/parameter_scope.h"
#include "format/parameter_tree.h"

namespace freeplay {
namespace {

using std::numbers::pi;

/// What engineering knows of a quantity. Values outside are doubted with a unit, too; 0 means "none of it".
struct UsualRange {
  std::string_view unit;   ///< as in the table of a component
  std::string_view names;  ///< last words of keys that it is for, each between blanks; empty: all of this unit
  double least, most;      ///< with a unit
  double least_bare;       ///< without
  std::string_view words;  ///< of the range
};

// Moduli: gels have some 10 kPa, rubber 1 MPa (Ashby, Materials Selection), diamond 1.2 TPa. Densities: aerogel 1
// kg/m^3, osmium 22 590. Stiffness: a steel cube of 1 m has 2e11 N/m. Surfaces in rest creep with nm/s (Heslot and
// others 1994, Phys Rev E 49), and what smooths friction over more than bodies move with is a damper.
constexpr UsualRange usual_ranges[] = {
    {"Pa", " E modulus youngs_modulus young ", 1e3, 2e12, 1e6, "moduli go from 1 MPa (rubber) to 1200 GPa (diamond)"},
    {"N/m", "", 0.0, 1e12, 0.0, "a steel cube of 1 m has 2e11 N/m"},
    {"N*m/rad", "", 0.0, 1e12, 0.0, "a steel shaft of 1 m has 1e10 N*m/rad"},
    {"1", " mu mu_s mu_k ", 0.0, 3.0, 0.0, "coefficients of friction go up to about 1.5 (rubber)"},
    {"m/s", " vs ", 1e-9, 10.0, 1e-9, "friction is smoothed over 1 nm/s to 10 m/s"},
    {"rad/s", " vs ", 1e-7, 1e3, 1e-7, "friction is smoothed over 1e-7 to 1000 rad/s"},
    {"kg/m^3", "", 1.0, 3e4, 1.0, "densities go from 1 (aerogel) to 22590 kg/m^3 (osmium)"},
};

// Moduli of the bodies that a contact is as stiff as: a tenth of soft rubber's, ten times diamond's.
constexpr double softest_contact = 1e5, hardest_contact = 1.2e13;  // [Pa]
constexpr double most_off = 1e3;                                   // from the material beside it

constexpr double shortest_long_step = 2e-3;  // of the run: below, hours are simulated
constexpr double earth_gravity = 9.81;       // [m/s^2], within 3 %: 9.78 to 9.83 on the ground, 10 in schools

bool begins_word(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool is_number_part(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_'; }
bool is_word_part(char c) { return begins_word(c) || std::isdigit(static_cast<unsigned char>(c)); }

/// Functions whose result is a plain number, whatever stands in their brackets.
constexpr std::string_view plain_functions[] = {"sin", "cos", "tan", "exp", "log", "smooth", "trapezoid", "s_curve"};

/// The place after the bracket that closes the one at `open`.
std::size_t after_bracket(std::string_view text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
    if (depth == 0) return i + 1;
  }
  return text.size();
}

/// Calls `use(word, is_parameter)` for every word of an expression; the exponent of a number is none, nor is what
/// stands in the brackets of a function that makes a plain number of it, where these are passed over: the pi of
/// `30*sin(2*pi*t)` says nothing of 30.
template <class Use>
bool any_word(std::string_view text, Use&& use, Arguments arguments = Arguments::passed_over) {
  for (std::size_t i = 0; i < text.size();) {
    const unsigned char c = static_cast<unsigned char>(text[i]);
    const bool micro = c >= 0x80;  // of µm
    if (!begins_word(text[i]) && !micro) {
      // 1e5: digits, then the letter of the exponent
      const bool number = std::isdigit(c) || c == '.';
      ++i;
      if (number && i < text.size() && (text[i] == 'e' || text[i] == 'E')) ++i;
      continue;
    }
    const std::size_t begin = i;
    while (i < text.size() && (is_word_part(text[i]) || static_cast<unsigned char>(text[i]) >= 0x80)) ++i;
    const bool parameter = begin > 0 && (text[begin - 1] == '$' || text[begin - 1] == '{');
    const std::size_t bracket = std::min(text.find_first_not_of(' ', i), text.size());
    if (arguments == Arguments::passed_over && !parameter && bracket < text.size() && text[bracket] == '(' &&
        std::ranges::count(plain_functions, text.substr(begin, i - begin)) > 0) {
      i = after_bracket(text, bracket);
      continue;
    }
    if (use(text.substr(begin, i - begin), parameter)) return true;
  }
  return false;
}

/// Functions of an angle.
constexpr std::string_view circular_functions[] = {"sin", "cos", "tan"};

bool ends_in_word(std::string_view text, std::string_view word) {
  return text.ends_with(word) && (text.size() == word.size() || !is_word_part(text[text.size() - word.size() - 1]));
}

/// An angle of more than a turn in whole fives, or a multiple of 180 times t; 0: another, or none that is known.
struct RoundAngle {
  double number;  ///< [rad] or [rad/s]
  bool in_time;
};
RoundAngle round_angle(std::string_view text, const Scope& scope) {
  const auto is_multiple = [](double value, double of) {
    return std::abs(value) < 1e6 && std::abs(value / of - std::round(value / of)) <= 1e-9;
  };
  try {
    const Expression angle = Expression::compile(text, scope, true);
    Jet value;
    EvaluationFailure failure;
    if (!angle.evaluate(0.3711, value, failure)) return {};
    if (!angle.depends_on_time())
      return {std::abs(value.value) > bare_limit::angle && is_multiple(value.value, 5.0) ? value.value : 0.0, false};
    return {value.acceleration == 0.0 && is_multiple(value.rate, 180.0) ? value.rate : 0.0, true};
  } catch (const ExpressionError&) {
    return {};  // said where the whole is read, or a function of the motion
  }
}

/// A number that is a multiple of 180, beside a time with its unit, as in `360*t/2 s`; 0 where there is none.
double degrees_by_time(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = std::isdigit(static_cast<unsigned char>(text[i])) && (i == 0 || !is_number_part(text[i - 1]));
    if (!begins) continue;
    const std::size_t end = std::min(text.find_first_not_of("0123456789.", i), text.size());
    double number = 0.0;
    std::from_chars(text.data() + i, text.data() + end, number);
    const std::size_t next = std::min(text.find_first_not_of(' ', end), text.size());
    const bool bare = next == text.size() || !begins_word(text[next]);
    if (bare && number > 0.0 && std::fmod(number, 180.0) == 0.0) return number;
    i = end;
  }
  return 0.0;
}

/// Largest amount of a function of one variable over a turn of it; 0 of others, and where it has no value.
double largest_around(const Formula& formula, std::size_t variables) {
  constexpr int places = 32;
  double most = 0.0;
  for (int i = 0; i < places && variables == 1; ++i) {
    const double x = 2.0 * pi * i / places;
    try {
      most = std::max(most, std::abs(formula.at({&x, 1})));
    } catch (const std::exception&) {
      return 0.0;  // said where the whole is read
    }
  }
  return most;
}

bool says_pi(const CheckedValue& written) {
  return any_word(written.node().text,
                  [](std::string_view word, bool parameter) { return !parameter && word == "pi"; });
}

bool is_round(double value) { return std::abs(2.0 * value - std::round(2.0 * value)) <= 1e-9; }

/// Index of the alternative of a unit such as "kind: N/m | N*m/rad", and the alternative itself.
std::string unit_text(const Parameter& parameter, const ParameterBlock& block) {
  const std::string text = parameter.unit;
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return text;
  const auto chooser = block.values.find(text.substr(0, colon));
  int wanted = chooser == block.values.end() ? 0 : std::max(chooser->second.word, 0);
  std::size_t begin = colon + 1;
  while (wanted-- > 0) begin = std::min(text.find('|', begin), text.size() - 1) + 1;
  std::string one = text.substr(begin, text.find('|', begin) - begin);
  std::erase(one, ' ');
  return one;
}

std::string_view last_word(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

/// Calls `names(text)` for every text of a list or a map.
template <class Names>
bool any_text(const CheckedValue& value, const Names& names) {
  if (value.node().is_scalar()) return names(value);
  for (std::size_t k = 0; k < value.node().items.size(); ++k) {
    if (any_text(value.item(k), names)) return true;
  }
  for (const Node::Entry& entry : value.node().entries) {
    if (any_text(CheckedValue(value.reading(), *entry.value, entry.key, value.path()), names)) return true;
  }
  return false;
}

void doubt_range(const CheckedValue& written, std::string_view unit, double value) {
  for (const UsualRange& range : usual_ranges) {
    if (range.unit != unit || value == 0.0) continue;
    if (!range.names.empty() && range.names.find(fmt::format(" {} ", last_word(written.path()))) == range.names.npos) {
      continue;
    }
    const bool bare = !names_a_unit(written), plain = unit == "1";
    if (value <= range.most && value >= (bare ? range.least_bare : range.least)) continue;
    written.warn("doubtful-value",
                 fmt::format("'{}' is {:.4g}{}{}, but {}{}", written.path(), value, plain ? "" : " ", plain ? "" : unit,
                             range.words, bare && !plain ? ": write the unit after the number" : ": check the number"));
  }
}

void doubt_length(const CheckedValue& written, double value, double scale, double most) {
  if (!(scale > 0.0) || std::abs(value) <= most * scale || names_a_unit(written)) return;
  written.warn("doubtful-length",
               fmt::format("'{}' is {:.4g} m where the lengths of the mechanism are about {:.3g} m: write the unit "
                           "after the number, as in '{:.4g} mm'",
                           written.path(), value, scale, value));
}

/// `but`: of no unit of this dimension.
bool names_a_unit(const CheckedValue& written, std::string_view text, Arguments arguments,
                  const Dimension* but = nullptr) {
  const auto counts = [&](const Dimension& dimension) { return but == nullptr || !(dimension == *but); };
  const auto is_unit = [&](std::string_view word, bool parameter) {
    if (!parameter) return is_unit_name(word) && counts(parse_unit(word).dimension);
    const Quantity* quantity = written.reading().scope->find(word);
    return quantity != nullptr && quantity->kind == DimensionKind::dimensioned && counts(quantity->dimension);
  };
  return any_word(text, is_unit, arguments);
}

}  // namespace

bool names_a_unit(const CheckedValue& written, Arguments arguments) {
  return written.node().is_scalar() && names_a_unit(written, written.node().text, arguments);
}

bool says_unit(const CheckedValue& value, Arguments arguments) {
  return any_text(value, [&](const CheckedValue& text) { return names_a_unit(text, arguments); });
}

bool says_time(const CheckedValue& value) {
  return any_text(value, [](const CheckedValue& written) {
    const std::string& text = written.node().text;
    const auto is_time = [&](std::string_view word, bool parameter) {
      if (parameter) {
        const Quantity* quantity = written.reading().scope->find(word);
        return quantity != nullptr && quantity->kind == DimensionKind::dimensioned &&
               quantity->dimension == dimension::time;
      }
      const std::size_t before = text.find_last_not_of(' ', static_cast<std::size_t>(word.data() - text.data()) - 1);
      const bool divides = word.data() != text.data() && before != text.npos && text[before] == '/';
      return !divides && is_unit_name(word) && parse_unit(word).dimension == dimension::time;
    };
    return written.node().is_scalar() && any_word(text, is_time, Arguments::read);
  });
}

bool doubt_angle(const CheckedValue& written, double radians) {
  if (std::abs(radians) <= bare_limit::angle * (1.0 + 1e-12) || names_a_unit(written)) return false;
  // A parameter may hold a multiple of pi; round numbers are none.
  if (says_pi(written) || (!is_round(radians) && written.node().text.find('$') != std::string::npos)) {
    return false;
  }
  written.warn("doubtful-angle",
               fmt::format("'{0}' is {1:.6g} rad, {2:.3g} turns: write '{1:.6g} deg' if degrees are meant, else "
                           "'{1:.6g} rad'",
                           written.path(), radians, std::abs(radians) / (2.0 * pi)));
  return true;
}

bool doubt_direction(const CheckedValue& written, double radians) {
  if (doubt_angle(written, radians)) return true;
  if (std::abs(radians) <= bare_limit::direction * (1.0 + 1e-12) || names_a_unit(written)) return false;
  // Computed directions have many digits; 4 or 5.5 radians are nothing that is thought of as a direction.
  if (says_pi(written) || !is_round(radians)) return false;
  written.warn("doubtful-angle",
               fmt::format("'{0}' is {1:.6g} rad, the direction of {2:.0f} deg: write '{1:.6g} deg' if degrees are "
                           "meant, else '{1:.6g} rad'",
                           written.path(), radians, std::remainder(radians, 2.0 * pi) * 180.0 / pi));
  return true;
}

void doubt_angular_speed(const CheckedValue& written, double speed) {
  if (names_a_unit(written)) return;
  const bool quarters = std::abs(speed) > 179.0 && std::abs(std::remainder(speed, 90.0)) < 1e-9;
  if (std::abs(speed) < bare_limit::angular_speed) {
    if (!quarters) return;
    written.warn("doubtful-speed", fmt::format("'{0}' comes to {1:.6g} rad/s, that is {2:.0f} rpm: write '{1:.6g} "
                                               "deg/s' or '{1:.6g} rpm' if that is meant, else '{1:.6g} rad/s'",
                                               written.path(), speed, std::abs(speed) * 30.0 / pi));
    return;
  }
  written.warn("doubtful-speed", fmt::format("'{0}' is {1:.6g} rad/s, that is {2:.0f} rpm: write '{1:.6g} rpm' if "
                                             "revolutions per minute are meant, else '{1:.6g} rad/s'",
                                             written.path(), speed, std::abs(speed) * 30.0 / pi));
}

void doubt_slide_speed(const CheckedValue& written, double speed) {
  if (std::abs(speed) <= bare_limit::slide_speed || names_a_unit(written)) return;
  written.warn("doubtful-speed", fmt::format("'{0}' is {1:.6g} m/s, that is {2:.0f} km/h: write '{1:.6g} mm/s' if "
                                             "millimetres per second are meant, else '{1:.6g} m/s'",
                                             written.path(), speed, std::abs(speed) * 3.6));
}

void doubt_start_length(const CheckedValue& written, double value, double scale) {
  doubt_length(written, value, scale, bare_limit::start);
}

void doubt_gravity(const CheckedValue& written, const Vector3& gravity) {
  const double size = std::hypot(gravity[0], gravity[1], gravity[2]);
  for (const std::size_t upwards : {1u, 2u}) {
    if (gravity[upwards] < 0.99 * size || std::abs(size - earth_gravity) > 0.03 * earth_gravity) continue;
    written.warn("doubtful-value", fmt::format("'{}' pulls towards +{}, which is up in drawings: write {:.4g} in place "
                                               "of {:.4g} if things are to fall down",
                                               written.path(), upwards == 1 ? 'y' : 'z', -size, size));
    return;
  }
  if (size <= bare_limit::gravity || !written.node().is_list()) return;
  for (std::size_t i = 0; i < written.node().items.size(); ++i) {
    if (std::abs(gravity[i]) > 0.5 * size && names_a_unit(written.item(i))) return;
  }
  written.warn("doubtful-value", fmt::format("'{0}' is {1:.4g} m/s^2, {2:.0f} times that of the earth: write the unit "
                                             "after the number, as in '{1:.4g} mm/s^2'",
                                             written.path(), size, size / earth_gravity));
}

void doubt_step(const CheckedValue& written, double step, double span) {
  const bool coarse = step >= bare_limit::step && step >= 0.02 * span;
  const bool long_one = step >= bare_limit::long_step && step >= shortest_long_step * span;
  if ((!coarse && !long_one) || names_a_unit(written)) return;
  written.warn("doubtful-time", fmt::format("'{0}' is {1:.4g} s in a run of {2:.4g} s: write '{1:.4g} ms' if "
                                            "milliseconds are meant, else '{1:.4g} s'",
                                            written.path(), step, span));
}

void doubt_interval(const CheckedValue& written, double interval, double span) {
  if (interval > span) {
    written.warn("doubtful-time", fmt::format("'{}' is {:.4g} s in a run of {:.4g} s: rows show its start and its end "
                                              "alone",
                                              written.path(), interval, span));
  } else if (span / interval > bare_limit::rows) {
    written.warn("doubtful-time", fmt::format("'{}' is {:.4g} s in a run of {:.4g} s: {:.2g} rows would be written",
                                              written.path(), interval, span, span / interval));
  } else if (interval > 0.5 * span) {
    doubt_step(written, interval, span);
  }
}

void doubt_parameters(const ParameterBlock& block, const std::map<std::string, CheckedValue>& places, double scale,
                      double most_lengths) {
  for (const auto& [path, written] : places) {
    // A law's own parameters stand after the path of the law.
    const ParameterBlock* owner = &block;
    std::string name = path;
    for (std::size_t dot = name.find('.'); dot != std::string::npos; dot = name.find('.', dot + 1)) {
      const auto law = owner->values.find(name.substr(0, dot));
      if (law == owner->values.end() || law->second.law == nullptr) continue;
      owner = law->second.law.get();
      name = name.substr(dot + 1);
      break;
    }
    const auto value = owner->values.find(name);
    if (value == owner->values.end()) continue;
    const auto& table = owner->component->description.parameters;
    const auto row = std::find_if(table.begin(), table.end(), [&](const Parameter& p) { return p.name == name; });
    if (row == table.end()) continue;
    const std::string unit = unit_text(*row, *owner);
    for (std::size_t i = 0; unit == "m" && written.node().is_list() && i < written.node().items.size(); ++i) {
      if (i < value->second.vector.size()) doubt_length(written.item(i), value->second.vector[i], scale, most_lengths);
    }
    if (unit == "m" && row->kind == ParameterKind::formula && value->second.formula && written.node().is_scalar())
      doubt_length(written, largest_around(value->second.formula, variables_of(*row).size()), scale, most_lengths);
    if (!std::isfinite(value->second.number) || !written.node().is_scalar() || row->kind != ParameterKind::number)
      continue;
    const double number = value->second.number;
    if (unit == "rad") {
      doubt_angle(written, number);
    } else if (unit == "rad/s") {
      doubt_angular_speed(written, number);
    } else if (unit == "m") {
      doubt_length(written, number, scale, name == "lead" ? bare_limit::lead : most_lengths);
    } else {
      doubt_range(written, unit, number);
    }
  }
}

void doubt_degrees(const CheckedValue& written, std::string_view text) {
  for (std::size_t open = text.find('('); open != std::string_view::npos; open = text.find('(', open + 1)) {
    const std::string_view before = text.substr(0, open);
    if (std::ranges::none_of(circular_functions, [&](std::string_view name) { return ends_in_word(before, name); }))
      continue;
    const std::string_view angle = text.substr(open, after_bracket(text, open) - open);
    if (names_a_unit(written, angle, Arguments::read, &dimension::time)) continue;
    const bool says_time = names_a_unit(written, angle, Arguments::read);
    RoundAngle found = round_angle(angle, *written.reading().scope);
    if (says_time) found = {degrees_by_time(angle), false};
    const double swing = bare_swing(angle.substr(1, angle.size() - 2));
    if (found.number == 0.0 && swing > bare_limit::angle && std::fmod(swing, 5.0) == 0.0) found = {swing, false};
    const auto [number, in_time] = found;
    if (number == 0.0) continue;
    written.warn(
        "doubtful-angle",
        fmt::format("'{0}' takes a sine, cosine or tangent of {1:.6g} rad{2}: write '{1:.6g} deg{3}' if degrees "
                    "are meant, else the unit rad",
                    written.path(), number, in_time ? "/s times t" : "", in_time ? "/s" : ""));
    return;
  }
}

void doubt_contact_stiffness(const CheckedValue& entry, const ParameterBlock& block, const JointLayout& layout,
                             double scale) {
  const auto stiffness = given_stiffness(block, layout, scale);
  if (!stiffness) return;
  const double modulus = stiffness->modulus, own = layout.contact_modulus;
  const bool of_none = modulus < softest_contact || modulus > hardest_contact;
  if (!of_none && !(own > most_off * modulus || modulus > most_off * own)) return;
  std::string against = "moduli go from 1 MPa (rubber) to 1200 GPa (diamond)", unit;
  if (!of_none) against = fmt::format("its material makes {:.2g} Pa", own);
  if (!of_none && own > modulus)
    unit = fmt::format(", as in '{:.4g} N/mm{}'", stiffness->value, stiffness->unit.substr(3));
  entry.warn_at_key(
      "doubtful-value",
      fmt::format("{} of '{}' is {:.4g} {}, as of bodies with a modulus of {:.2g} Pa: {}; "
                  "check the number and its unit{}",
                  stiffness->name, entry.key(), stiffness->value, stiffness->unit, modulus, against, unit));
}

}  // namespace freeplay
