#include "contract/parameter_words.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "format/parameter_tree.h"

namespace freeplay {
namespace {

std::string number_words(double number, const Parameter& p) {
  // A unit with a name in its exponent says little without it.
  const std::string_view unit = p.unit;
  const bool plain = unit != "1" && unit.find('|') == std::string_view::npos;
  return fmt::format("{:.6g}{}{}", number, plain ? " " : "", plain ? unit : "");
}

/// "[1, 2, 3]", "[[0, 1], [2, 3], ... 9 points]", SI.
std::string points_words(const ParameterPoints& points) {
  constexpr std::size_t most_shown = 4;
  const bool table = !points.x.empty();
  std::string all;
  for (std::size_t i = 0; i < std::min(points.y.size(), most_shown); ++i) {
    all += i == 0 ? "" : ", ";
    all += table ? fmt::format("[{:.6g}, {:.6g}]", points.x[i], points.y[i]) : fmt::format("{:.6g}", points.y[i]);
  }
  if (points.y.size() > most_shown) all += fmt::format(", ... {} in all", points.y.size());
  return "[" + all + "]";
}

/// Empty where the value was left open.
std::string value_words(const ParameterValue& value, const Parameter& p) {
  switch (p.kind) {
    case ParameterKind::contact_law:
    case ParameterKind::friction_law: {
      if (value.law == nullptr) return {};
      const std::string inner = words_of(*value.law);
      return value.law->component->description.name + (inner.empty() ? inner : " (" + inner + ")");
    }
    case ParameterKind::choice: {
      const std::vector<std::string> words = words_of(p);
      return value.word >= 0 && static_cast<std::size_t>(value.word) < words.size()
                 ? words[static_cast<std::size_t>(value.word)]
                 : std::string();
    }
    case ParameterKind::vector:
      if (!value.given) return {};
      return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", value.vector[0], value.vector[1], value.vector[2]);
    case ParameterKind::function:
      return value.function_owner != nullptr ? "a function of time" : "";
    case ParameterKind::list:
    case ParameterKind::table:
      return value.points == nullptr ? std::string() : points_words(*value.points);
    default:
      return std::isnan(value.number) ? std::string() : number_words(value.number, p);
  }
}

}  // namespace

std::string words_of(const ParameterBlock& block) {
  std::string all;
  for (const Parameter& p : block.component->description.parameters) {
    const auto found = block.values.find(p.name);
    if (found == block.values.end()) continue;
    const std::string words = value_words(found->second, p);
    if (!words.empty()) all += fmt::format("{}{} = {}", all.empty() ? "" : ", ", p.name, words);
  }
  return all;
}

}  // namespace freeplay
