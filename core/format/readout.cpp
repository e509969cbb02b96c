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

bool is_of_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
}

/// The text with the names of channels as they are called outside of a template; of two that begin alike the longer.
std::string with_names(std::string_view text, const NamesInFull& names) {
  std::string full;
  for (std::size_t i = 0; i < text.size();) {
    const std::pair<std::string, std::string>* longest = nullptr;
    for (const auto& name : names) {
      const std::size_t end = i + name.first.size();
      if ((i > 0 && is_of_name(text[i - 1])) || text.substr(i, name.first.size()) != name.first) continue;
      if (end < text.size() && is_of_name(text[end])) continue;
      if (longest == nullptr || name.first.size() > longest->first.size()) longest = &name;
    }
    full += longest == nullptr ? std::string(1, text[i]) : longest->second;
    i += longest == nullptr ? 1 : longest->first.size();
  }
  return full;
}

/// The text with `written` of each parameter in its place.
template <class Written>
std::string with_values(std::string_view rest, const Scope& scope, const Written& written) {
  std::string text;
  while (!rest.empty()) {
    const std::size_t dollar = rest.find('$');
    text += rest.substr(0, dollar);
    if (dollar == std::string_view::npos) break;
    rest.remove_prefix(dollar);
    const std::string name = referenced_parameters(rest).front();
    text += written(*scope.find(name));
    rest.remove_prefix(reference_length(rest, name));
  }
  return text;
}

}  // namespace

void Readout::note_number(const std::string& instance, const Node& node, double value) {
  if (!instance.empty()) texts_[{instance, &node}] = {fmt::format("{}", value)};
}

void Readout::note_function(const std::string& instance, const Node& node, const Expression& expression,
                            const Scope& scope, const NamesInFull& channels) {
  if (instance.empty()) return;
  std::string text = with_values(with_names(node.text, channels), scope, factor);
  // A parameter without a unit fits anywhere, a number in its place may not: what depends on t fits anywhere, too.
  if (expression.kind() == DimensionKind::free &&
      (expression.depends_on_variables() ||
       Expression::compile(text, EmptyScope(), true).kind() != DimensionKind::free)) {
    text = "(1 + 0*t)*(" + text + ")";
  }
  texts_[{instance, &node}] = {std::move(text)};
}

void Readout::note_formula(const std::string& instance, const Node& node, const Scope& scope) {
  if (instance.empty()) return;
  // A negative number has no brackets of its own.
  const auto written = [](const Quantity& q) {
    if (q.kind == DimensionKind::dimensioned) return factor(q);
    return q.value < 0.0 ? fmt::format("(-[{}])", -q.value) : fmt::format("[{}]", q.value);
  };
  texts_[{instance, &node}] = {with_values(node.text, scope, written)};
}

void Readout::note_names(const std::string& instance, const Node& node, std::vector<std::string> names) {
  texts_[{instance, &node}] = std::move(names);
}

const std::vector<std::string>* Readout::find(const std::string& instance, const Node& node) const {
  const auto found = texts_.find({instance, &node});
  return found == texts_.end() ? nullptr : &found->second;
}

}  // namespace freeplay
