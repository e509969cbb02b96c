#include "format/readout.h"

#include <fmt/format.h>

namespace freeplay {
namespace {

/// "(0.24 m^1)", a factor of a formula; exponents in full.
std::string factor(const Quantity& quantity) {
  std::string unit;
  const auto append = [&](const char* name, double exponent) {
    if (exponent != 0.0) unit += fmt::format("{}{}^{}", unit.empty() ? " " : "*", name, exponent);
  };
  if (quantity.kind == DimensionKind::dimensioned) {
    append("kg", quantity.dimension.kg);
    append("m", quantity.dimension.m);
    append("s", quantity.dimension.s);
  }
  return fmt::format("({}{})", quantity.value, unit);
}

/// The length of "$name" or "${name}" at the beginning of `text`.
std::size_t reference_length(std::string_view text, const std::string& name) {
  return name.size() + (text.substr(1).starts_with('{') ? 3 : 1);
}

}  // namespace

void Readout::note_number(const std::string& instance, const Node& node, double value) {
  if (!instance.empty()) texts_[{instance, &node}] = {fmt::format("{}", value)};
}

void Readout::note_function(const std::string& instance, const Node& node, const Expression& expression,
                            const Scope& scope) {
  if (instance.empty()) return;
  std::string text;
  for (std::string_view rest = node.text; !rest.empty();) {
    const std::size_t dollar = rest.find('$');
    text += rest.substr(0, dollar);
    if (dollar == std::string_view::npos) break;
    rest.remove_prefix(dollar);
    const std::string name = referenced_parameters(rest).front();
    text += factor(*scope.find(name));
    rest.remove_prefix(reference_length(rest, name));
  }
  // A parameter without a unit fits anywhere, a number in its place may not: what depends on t fits anywhere, too.
  if (expression.kind() == DimensionKind::free &&
      Expression::compile(text, EmptyScope(), true).kind() != DimensionKind::free) {
    text = "(1 + 0*t)*(" + text + ")";
  }
  texts_[{instance, &node}] = {std::move(text)};
}

void Readout::note_names(const std::string& instance, const Node& node, std::vector<std::string> names) {
  texts_[{instance, &node}] = std::move(names);
}

const std::vector<std::string>* Readout::find(const std::string& instance, const Node& node) const {
  const auto found = texts_.find({instance, &node});
  return found == texts_.end() ? nullptr : &found->second;
}

}  // namespace freeplay
