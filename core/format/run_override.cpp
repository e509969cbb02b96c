#include "format/run_override.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "format/checked_value.h"

namespace freeplay {
namespace {

constexpr std::array run_names = {
    "simulation.end", "simulation.step", "simulation.accuracy", "simulation.integrator", "ideal", "repeat", "seed"};

[[noreturn]] void bad_option(const std::string& name, const std::string& text, const std::string& why,
                             const std::string& hint = {}) {
  throw Error(Error::Category::usage, "usage", fmt::format("--set {}='{}': {}", name, text, why), {}, hint);
}

double positive_number(const std::string& name, const std::string& text, const Dimension& dimension,
                       const ParameterScope& parameters) {
  try {
    const Expression expression = Expression::compile(text, parameters, false);
    expression.require(dimension);
    const double value = expression.constant().value;
    if (value > 0.0) return value;
  } catch (const ExpressionError& error) {
    bad_option(name, text, error.message,
               error.suggestion.empty() ? error.hint : fmt::format("did you mean '{}'?", error.suggestion));
  }
  bad_option(name, text, "it must be > 0");
}

constexpr double most_whole = 9007199254740992.0;  // up to here all whole numbers have a double

/// Nothing for what is no whole number from `least` on.
std::optional<std::uint64_t> whole_number_of(const std::string& text, double least) {
  double value = -1.0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end || value != std::floor(value)) return std::nullopt;
  if (value < least || value > most_whole) return std::nullopt;
  return static_cast<std::uint64_t>(value);
}

double least_of(const std::string& name) { return name == "repeat" ? 1.0 : 0.0; }

bool chooses_start(const std::string& name) { return name == "repeat" || name == "seed"; }

std::vector<std::string> joints_of(const std::string& text, const BuildOptions& options) {
  if (text == "none") return {};
  if (!text.starts_with('[') || !options.parse_value) return {text};
  Diagnostics messages;
  const std::optional<Document> document = options.parse_value(text, "--set ideal", messages);
  if (!document || messages.has_errors()) bad_option("ideal", text, "it is no list of names");
  std::vector<std::string> joints;
  for (const Node* item : document->root().items) joints.push_back(item->text);
  return joints;
}

}  // namespace

std::span<const char* const> run_override_names() { return run_names; }

bool is_run_override(std::string_view name) { return std::ranges::find(run_names, name) != run_names.end(); }

void apply_run_overrides(BuildOptions& options, const ParameterScope& parameters) {
  const bool fixed = options.step || options.accuracy;
  const bool has_end = options.end.has_value(), has_integrator = options.integrator.has_value();
  const bool has_ideal = !options.ideal.empty();
  for (const auto& [name, text] : options.set) {
    const bool map = text.starts_with('{');
    if (name.starts_with("simulation.step.") || (name == "simulation.step" && map)) {
      options.step_by_map = true;
      if (!fixed) options.step.reset(), options.accuracy.reset();
      continue;
    }
    if (name.starts_with("simulation.integrator.") || (name == "simulation.integrator" && map)) {
      options.integrator_by_map = true;
      if (!has_integrator) options.integrator.reset();
      continue;
    }
    if (!is_run_override(name) || parameters.declares(name)) continue;
    if (name == "simulation.end" && !has_end) {
      options.end = positive_number(name, text, dimension::time, parameters);
    } else if (name == "simulation.step" && !fixed) {
      options.step = positive_number(name, text, dimension::time, parameters);
      options.accuracy.reset();
    } else if (name == "simulation.accuracy" && !fixed) {
      options.accuracy = positive_number(name, text, dimension::length, parameters);
      options.step.reset();
    } else if (name == "simulation.integrator" && !has_integrator) {
      options.integrator = text;
      options.integrator_by_map = false;
    } else if (name == "ideal" && !has_ideal) {
      options.ideal = joints_of(text, options);
    } else if (chooses_start(name) && !whole_number_of(text, least_of(name))) {
      bad_option(name, text, fmt::format("it must be a whole number from {} to 2^53", least_of(name)));
    }
  }
}

StartChoice start_choice(const Model& model) {
  StartChoice choice;
  for (const auto& [name, text] : model.overrides) {
    const std::string& target = name;
    const bool parameter = std::ranges::any_of(model.parameters, [&](const auto& one) { return one.first == target; });
    if (!chooses_start(target) || parameter) continue;
    (target == "repeat" ? choice.repeat : choice.seed) = whole_number_of(text, least_of(target)).value_or(1);
  }
  return choice;
}

}  // namespace freeplay
