#include "cli/component_entry.h"

#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/number_text.h"

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

bool is_required(const Parameter& parameter) { return std::isnan(parameter.default_value); }
bool is_law(ParameterKind kind) { return kind == ParameterKind::contact_law || kind == ParameterKind::friction_law; }
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
    case ParameterKind::contact_law:
      return "contact law";
    case ParameterKind::friction_law:
      break;
  }
  return "friction law";
}

std::string default_text(const Parameter& parameter, const Registry& registry) {
  if (is_required(parameter)) return "required";
  if (is_law(parameter.kind)) {
    const bool contact = parameter.kind == ParameterKind::contact_law;
    const Component* law = registry.preferred(contact ? ComponentKind::contact_law : ComponentKind::friction_law);
    return law == nullptr ? "-" : law->description.name;
  }
  if (parameter.default_value == optional) return "-";
  const std::vector<std::string> choices = words(parameter.choices);
  if (parameter.kind != ParameterKind::choice) return number_text(parameter.default_value);
  const auto index = static_cast<std::size_t>(parameter.default_value);
  return index < choices.size() ? choices[index] : "-";
}

std::string bounds_text(const Parameter& parameter) {
  const bool from = std::isfinite(parameter.minimum), to = std::isfinite(parameter.maximum);
  const std::string low = (is_open(parameter, Open::minimum) ? "> " : ">= ") + number_text(parameter.minimum);
  const std::string high = (is_open(parameter, Open::maximum) ? "< " : "<= ") + number_text(parameter.maximum);
  if (from && to && parameter.open == Open::none) {
    return number_text(parameter.minimum) + " to " + number_text(parameter.maximum);
  }
  if (from && to) return low + ", " + high;
  return from ? low : to ? high : "";
}

std::string range_text(const Parameter& parameter) {
  const std::vector<std::string> choices = words(parameter.choices);
  std::string text = bounds_text(parameter);
  if (!choices.empty()) {
    text += fmt::format("{}{}{}", text.empty() ? "" : " or ", choices.size() > 1 ? "one of " : "",
                        fmt::join(choices, ", "));
  }
  return text.empty() ? "-" : text;
}

Json parameter_json(const Parameter& parameter) {
  const std::vector<std::string> choices = words(parameter.choices);
  Json default_value = nullptr;
  if (parameter.kind == ParameterKind::choice && parameter.default_value >= 0.0) {
    const auto index = static_cast<std::size_t>(parameter.default_value);
    if (index < choices.size()) default_value = choices[index];
  } else if (!is_law(parameter.kind)) {
    default_value = json_number(parameter.default_value);
  }
  return {{"name", parameter.name},
          {"kind", kind_word(parameter.kind)},
          {"unit", parameter.unit},
          {"required", is_required(parameter)},
          {"default", default_value},
          {"minimum", json_number(parameter.minimum)},
          {"maximum", json_number(parameter.maximum)},
          {"exclusive_minimum", is_open(parameter, Open::minimum)},
          {"exclusive_maximum", is_open(parameter, Open::maximum)},
          {"choices", choices},
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

ParameterText parameter_text(const Parameter& parameter, const Registry& registry) {
  return {default_text(parameter, registry), range_text(parameter)};
}

Json component_json(const RegisteredComponent& entry) {
  const Description& description = entry.component->description;
  Json parameters = Json::array();
  for (const Parameter& parameter : description.parameters) parameters.push_back(parameter_json(parameter));
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

}  // namespace freeplay
