#include "contract/description_contract.h"

#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "base/expression.h"
#include "base/unit.h"
#include "format/key_table.h"
#include "format/parameter_tree.h"
#include "model/channel.h"

namespace freeplay {
namespace {

bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Lower-case words of letters and digits, joined by `joint`; the first begins with a letter or digit.
bool is_joined_words(const char* text, char joint) {
  if (text == nullptr || text[0] == '\0') return false;
  const std::string_view word(text);
  if (word.front() == joint || word.back() == joint) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const bool good = is_lower(word[i]) || is_digit(word[i]) || (word[i] == joint && word[i - 1] != joint);
    if (!good) return false;
  }
  return true;
}

/// Letters, digits and underscores in parts joined by dots. Capitals are symbols, such as that of Young's modulus.
bool is_path(std::string_view path) {
  bool begins = true;
  for (const char c : path) {
    const bool letter = is_lower(c) || (c >= 'A' && c <= 'Z');
    if (begins ? !letter : !(letter || is_digit(c) || c == '_' || c == '.')) return false;
    begins = c == '.';
  }
  return !begins;
}

bool says_something(const char* text) { return text != nullptr && text[0] != '\0'; }

const Parameter* find(Span<const Parameter> table, std::string_view name) {
  for (const Parameter& p : table) {
    if (p.name != nullptr && name == p.name) return &p;
  }
  return nullptr;
}

/// What is wrong with one unit, whose exponents may name dimensionless numbers of the table.
std::optional<std::string> single_unit_fault(std::string_view unit, Span<const Parameter> table) {
  const auto exponent = [&](std::string_view name) -> std::optional<double> {
    const Parameter* p = find(table, name);
    const bool number = p != nullptr && p->kind == ParameterKind::number && std::string_view(p->unit) == "1";
    return number ? std::optional(1.5) : std::nullopt;
  };
  try {
    parse_unit(unit, exponent);
  } catch (const ExpressionError& e) {
    return fmt::format("'{}': {}", unit, e.message);
  }
  return std::nullopt;
}

/// The same for "CHOICE: UNIT | UNIT": every alternative, one for each word of a choice of the table.
std::optional<std::string> unit_fault(const char* text, Span<const Parameter> table) {
  if (text == nullptr) return "missing";
  std::string_view rest = text;
  const std::size_t colon = rest.find(':');
  if (colon == std::string_view::npos) return single_unit_fault(rest, table);
  const std::string_view name = rest.substr(0, colon);
  const Parameter* choice = find(table, name);
  if (choice == nullptr || choice->kind != ParameterKind::choice) {
    return fmt::format("'{}': '{}' is no choice of the table", text, name);
  }
  rest.remove_prefix(colon + 1);
  std::size_t units = 0;
  for (bool more = true; more; ++units) {
    const std::size_t bar = rest.find('|');
    more = bar != std::string_view::npos;
    std::string_view unit = rest.substr(0, bar);
    while (unit.starts_with(' ')) unit.remove_prefix(1);
    while (unit.ends_with(' ')) unit.remove_suffix(1);
    if (const auto fault = single_unit_fault(unit, table)) return fault;
    rest.remove_prefix(more ? bar + 1 : rest.size());
  }
  const std::size_t words = words_of(*choice).size();
  if (units == words) return std::nullopt;
  return fmt::format("'{}': {} units for the {} words of '{}'", text, units, words, name);
}

/// Is the first key of a path one that the reader of the model file takes itself?
bool is_taken(std::string_view path, const Component& component) {
  const std::string_view key = path.substr(0, path.find('.'));
  switch (component.kind) {
    case ComponentKind::joint:
      break;
    case ComponentKind::integrator:
      return format_map("integrator").find(key) != nullptr;
    case ComponentKind::contact_law:
    case ComponentKind::friction_law:
      return key == "law";
  }
  const Description& d = component.description;
  const auto is = [key](const char* end) { return end != nullptr && key == end; };
  return format_map("joint").find(key) != nullptr || is(d.first_end) || is(d.second_end);
}

void check_value(const Parameter& p, Findings& findings) {
  const bool numeric = p.kind == ParameterKind::number || p.kind == ParameterKind::integer;
  const bool closed = p.open == Open::none;
  findings.expect("parameter-bounds", p.minimum < p.maximum || (closed && p.minimum == p.maximum),
                  [&] { return fmt::format("'{}' lies between {} and {}", p.name, p.minimum, p.maximum); });
  const std::vector<std::string> words = words_of(p);
  const double given = p.default_value;
  if (p.kind == ParameterKind::choice) {
    const std::set<std::string> different(words.begin(), words.end());
    findings.expect("parameter-choices", !words.empty() && different.size() == words.size() && !different.contains(""),
                    [&] { return fmt::format("'{}' has the words '{}'", p.name, p.choices ? p.choices : ""); });
  }
  if (std::isnan(given) || given == optional) return;
  bool good = true;
  if (p.kind == ParameterKind::choice) {
    good = given == std::floor(given) && given >= 0.0 && given < static_cast<double>(words.size());
  } else if (numeric) {
    const bool above = p.open == Open::minimum || p.open == Open::both ? given > p.minimum : given >= p.minimum;
    const bool below = p.open == Open::maximum || p.open == Open::both ? given < p.maximum : given <= p.maximum;
    good = above && below && (p.kind == ParameterKind::number || given == std::floor(given));
  }
  findings.expect("parameter-defaults", good, [&] { return fmt::format("'{}' has the default {}", p.name, given); });
}

/// What is wrong with the variables of a formula.
std::optional<std::string> variables_fault(const Parameter& p, Span<const Parameter> table) {
  const std::vector<VariableRow> rows = variables_of(p);
  if (p.kind != ParameterKind::formula && p.kind != ParameterKind::table)
    return rows.empty() ? std::nullopt : std::optional<std::string>("is neither formula nor table");
  const std::size_t most = p.kind == ParameterKind::table ? 1 : Formula::most_variables;
  if (rows.empty() || rows.size() > most) return fmt::format("has {} variables", rows.size());
  std::set<std::string> names;
  for (const VariableRow& row : rows) {
    if (!is_path(row.name) || row.name.find('.') != std::string::npos) return fmt::format("'{}'", row.name);
    if (!names.insert(row.name).second) return fmt::format("'{}' stands twice", row.name);
    if (is_unit_name(row.name) || is_formula_word(row.name)) return fmt::format("'{}' means something else", row.name);
    if (const auto fault = unit_fault(row.unit.c_str(), table))
      return fmt::format("unit of '{}': {}", row.name, *fault);
  }
  return std::nullopt;
}

/// Does a joint, or a force where it may stand as one, have a column `name` without the type's doing?
bool is_column(const JointLayout& layout, const char* name) {
  Model model;
  model.joints.resize(2);
  model.force_elements.push_back({.joint = 1});
  for (JointElement& joint : model.joints) {
    joint.layout.coordinate = layout.coordinate;
    joint.name = "it";
  }
  model.joints[1].is_force = true;
  const Channels columns(model);
  const auto has = [&](const std::string& prefix) { return columns.find(prefix + name) >= 0; };
  const bool may_be_force = layout.constraint_rows == 0 && !(layout.clearance > 0.0);
  return has("joint.it.") || (may_be_force && has("force.it."));
}

}  // namespace

Findings check_description(const Component& component) {
  const Description& d = component.description;
  Findings findings;
  findings.expect("name", is_joined_words(d.name, '-'), [&] { return fmt::format("'{}'", d.name); });
  findings.expect("summary", says_something(d.summary), [] { return std::string("is empty"); });
  if (component.kind == ComponentKind::joint) {
    const bool known = d.space == Space::planar || d.space == Space::spatial || d.space == Space::both;
    findings.expect("space", known, [&] { return fmt::format("{} is none", static_cast<unsigned>(d.space)); });
  }
  std::set<std::string> names;
  for (const Parameter& p : d.parameters) {
    findings.expect("parameter-names", is_path(p.name), [&] { return fmt::format("'{}'", p.name); });
    findings.expect("parameter-names", names.insert(p.name).second,
                    [&] { return fmt::format("'{}' stands twice", p.name); });
    findings.expect("parameter-names", !is_taken(p.name, component),
                    [&] { return fmt::format("'{}' begins with a key that the model file reads itself", p.name); });
    findings.expect("summary", says_something(p.summary),
                    [&] { return fmt::format("that of parameter '{}' is empty", p.name); });
    const std::optional<std::string> fault = unit_fault(p.unit, d.parameters);
    findings.expect("parameter-units", !fault, [&] { return fmt::format("of '{}': {}", p.name, *fault); });
    const std::optional<std::string> variables = variables_fault(p, d.parameters);
    findings.expect("parameter-variables", !variables, [&] { return fmt::format("'{}': {}", p.name, *variables); });
    check_value(p, findings);
  }
  return findings;
}

Findings check_joint_names(const JointLayout& joint) {
  Findings findings;
  std::set<std::string> events, channels;
  const auto check = [&](const char* rule, const char* name, std::set<std::string>& known) {
    findings.expect(rule, is_joined_words(name, '_'), [&] { return fmt::format("'{}'", name ? name : ""); });
    findings.expect(rule, name == nullptr || known.insert(name).second,
                    [&] { return fmt::format("'{}' stands twice", name); });
  };
  const auto check_unit = [&](const char* rule, const Channel& channel) {
    const std::optional<std::string> fault = unit_fault(channel.unit, {});
    findings.expect(rule, !fault, [&] { return fmt::format("unit of '{}': {}", channel.name, *fault); });
  };
  for (const Channel& channel : joint.channels) {
    findings.expect("channel-names", channel.name == nullptr || !is_column(joint, channel.name),
                    [&] { return fmt::format("'{}' is a column that every such joint has", channel.name); });
    check("channel-names", channel.name, channels);
    check_unit("channel-units", channel);
  }
  for (const Event& event : joint.events) {
    check("event-names", event.name, events);
    std::set<std::string> fields;
    for (const Channel& field : event.fields) {
      check("event-names", field.name, fields);
      check_unit("channel-units", field);
    }
  }
  return findings;
}

}  // namespace freeplay
