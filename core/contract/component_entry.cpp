#include "contract/component_entry.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/number_text.h"
#include "format/key_table.h"
#include "format/parameter_tree.h"

namespace freeplay {
namespace {

std::vector<std::string> words(const char* choices) {
  std::vector<std::string> list;
  std::string_view rest = choices == nullptr ? "" : choices;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('|'), rest.size());
    list.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return list;
}

bool must_be_given(const Parameter& parameter) { return std::isnan(parameter.default_value); }
bool is_law_itself(ParameterKind kind) {
  return kind == ParameterKind::contact_law || kind == ParameterKind::friction_law;
}
bool is_open(const Parameter& parameter, Open end) {
  return (static_cast<std::uint32_t>(parameter.open) & static_cast<std::uint32_t>(end)) != 0;
}

const char* kind_word(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::number:
      return "number";
    case ParameterKind::integer:
      return "integer";
    case ParameterKind::choice:
      return "choice";
    case ParameterKind::vector:
      return "vector";
    case ParameterKind::function:
      return "function";
    case ParameterKind::formula:
      return "formula";
    case ParameterKind::list:
      return "list";
    case ParameterKind::table:
      return "table";
    case ParameterKind::contact_law:
      return "contact law";
    case ParameterKind::friction_law:
      break;
  }
  return "friction law";
}

Json default_json(const Parameter& parameter, const std::vector<std::string>& choices, const Registry& registry) {
  if (is_law_itself(parameter.kind)) {
    const bool contact = parameter.kind == ParameterKind::contact_law;
    const Component* law = registry.preferred(contact ? ComponentKind::contact_law : ComponentKind::friction_law);
    return law == nullptr || must_be_given(parameter) ? Json(nullptr) : Json(law->description.name);
  }
  if (parameter.kind != ParameterKind::choice) return json_number(parameter.default_value);
  const auto index = static_cast<std::size_t>(std::max(parameter.default_value, 0.0));
  return parameter.default_value >= 0.0 && index < choices.size() ? Json(choices[index]) : Json(nullptr);
}

/// How many numbers of a list or points of a table there may be; null of anything else.
Json length_json(const Parameter& parameter) {
  if (parameter.kind != ParameterKind::list && parameter.kind != ParameterKind::table) return nullptr;
  return {{"minimum", parameter.least}, {"maximum", parameter.most}};
}

Json parameter_json(const Parameter& parameter, const Registry& registry) {
  const std::vector<std::string> choices = words(parameter.choices);
  Json variables = Json::array();
  for (const VariableRow& row : variables_of(parameter)) variables.push_back({{"name", row.name}, {"unit", row.unit}});
  return {{"name", parameter.name},
          {"kind", kind_word(parameter.kind)},
          {"unit", parameter.unit},
          {"required", must_be_given(parameter)},
          {"default", default_json(parameter, choices, registry)},
          {"minimum", json_number(parameter.minimum)},
          {"maximum", json_number(parameter.maximum)},
          {"exclusive_minimum", is_open(parameter, Open::minimum)},
          {"exclusive_maximum", is_open(parameter, Open::maximum)},
          {"choices", choices},
          {"variables", variables},
          {"length", length_json(parameter)},
          {"summary", parameter.summary}};
}

}  // namespace

const char* kind_word(ComponentKind kind) {
  switch (kind) {
    case ComponentKind::joint:
      return "joint";
    case ComponentKind::contact_law:
      return "contact";
    case ComponentKind::friction_law:
      return "friction";
    case ComponentKind::integrator:
      break;
  }
  return "integrator";
}

const char* space_word(Space space) {
  switch (space) {
    case Space::planar:
      return "planar";
    case Space::spatial:
      return "spatial";
    case Space::both:
      break;
  }
  return "both";
}

Json component_json(const RegisteredComponent& entry, const Registry& registry) {
  const Description& description = entry.component->description;
  Json parameters = Json::array();
  for (const Parameter& parameter : description.parameters) parameters.push_back(parameter_json(parameter, registry));
  return {{"name", description.name},
          {"kind", kind_word(entry.component->kind)},
          {"space", space_word(description.space)},
          {"source", entry.library},
          {"summary", description.summary},
          {"parameters", parameters},
          {"formula", description.formula},
          {"validity", description.validity},
          {"references", description.references}};
}

namespace {

/// The words among the alternatives of the format table: "quantity | 'auto'" has one.
Json words_in(std::string_view value) {
  Json words = Json::array();
  for (std::size_t at = value.find('\''); at != std::string_view::npos; at = value.find('\'', at)) {
    const std::size_t end = value.find('\'', at + 1);
    words.push_back(value.substr(at + 1, end - at - 1));
    at = end + 1;
  }
  return words;
}

Json core_entry(const char* name, const char* kind, const FormatMap& map) {
  Json parameters = Json::array();
  for (const FormatKey& key : map.keys) {
    if (key.name == "type" || key.name == "use") continue;
    const bool required = key.fallback == "required";
    const bool absent = required || key.fallback.empty();
    parameters.push_back({{"name", key.name},
                          {"kind", key.value},
                          {"unit", key.unit.empty() ? "1" : key.unit},
                          {"required", required},
                          {"default", absent ? Json(nullptr) : Json(key.fallback)},
                          {"minimum", nullptr},
                          {"maximum", nullptr},
                          {"exclusive_minimum", false},
                          {"exclusive_maximum", false},
                          {"choices", words_in(key.value)},
                          {"variables", Json::array()},
                          {"length", nullptr},
                          {"summary", key.meaning}});
  }
  return {{"name", name},         {"kind", kind},           {"space", "both"},
          {"source", "built-in"}, {"summary", map.meaning}, {"parameters", parameters},
          {"formula", ""},        {"validity", ""},         {"references", ""}};
}

/// "2 to 9 numbers", "2 to 9 points over speed [m/s]".
std::string length_text(const Json& parameter) {
  const int least = parameter["length"]["minimum"], most = parameter["length"]["maximum"];
  const std::string count = least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
  if (parameter["variables"].empty()) return count + " numbers";
  const Json& x = parameter["variables"][0];
  const auto name = x["name"].get<std::string>(), unit = x["unit"].get<std::string>();
  return fmt::format("{} points over {}{}", count, name, unit == "1" ? "" : fmt::format(" [{}]", unit));
}

std::string number_or_word(const Json& value) {
  return value.is_string() ? value.get<std::string>() : number_text(value.get<double>());
}

}  // namespace

std::vector<Json> core_entries() {
  return {core_entry("gear", "joint", format_map("gear")), core_entry("force", "force", format_map("force force")),
          core_entry("torque", "force", format_map("force torque")),
          core_entry("gravity", "force", format_map("force gravity"))};
}

std::vector<Json> all_entries(const Registry& registry) {
  std::vector<Json> entries, own = core_entries();
  // The gear stands with the joints, the forces after them.
  const auto is_joint = [](const RegisteredComponent& entry) { return entry.component->kind == ComponentKind::joint; };
  const auto& all = registry.components();
  for (const RegisteredComponent& entry : all) {
    if (is_joint(entry)) entries.push_back(component_json(entry, registry));
  }
  entries.insert(entries.end(), own.begin(), own.end());
  for (const RegisteredComponent& entry : all) {
    if (!is_joint(entry)) entries.push_back(component_json(entry, registry));
  }
  return entries;
}

std::string default_text(const Json& parameter) {
  if (parameter["required"].get<bool>()) return "required";
  return parameter["default"].is_null() ? "-" : number_or_word(parameter["default"]);
}

std::string range_text(const Json& parameter) {
  const bool above = parameter["exclusive_minimum"].get<bool>(), below = parameter["exclusive_maximum"].get<bool>();
  const bool from = !parameter["minimum"].is_null(), to = !parameter["maximum"].is_null();
  std::string text;
  if (from && to && !above && !below) {
    text = number_or_word(parameter["minimum"]) + " to " + number_or_word(parameter["maximum"]);
  } else {
    if (from) text = (above ? "> " : ">= ") + number_or_word(parameter["minimum"]);
    if (to) text += (from ? ", " : "") + std::string(below ? "< " : "<= ") + number_or_word(parameter["maximum"]);
  }
  if (!parameter["length"].is_null()) return length_text(parameter) + (text.empty() ? "" : ", each " + text);
  if (!parameter["variables"].empty()) {
    std::vector<std::string> names;
    for (const Json& one : parameter["variables"]) {
      const auto name = one["name"].get<std::string>(), unit = one["unit"].get<std::string>();
      names.push_back(unit == "1" ? name : fmt::format("{} [{}]", name, unit));
    }
    return fmt::format("formula in {}", fmt::join(names, ", "));
  }
  const auto choices = parameter["choices"].get<std::vector<std::string>>();
  if (!choices.empty()) {
    text += fmt::format("{}{}{}", text.empty() ? "" : " or ", choices.size() > 1 ? "one of " : "",
                        fmt::join(choices, ", "));
  }
  return text.empty() ? "-" : text;
}

}  // namespace freeplay
