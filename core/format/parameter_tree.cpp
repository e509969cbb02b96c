#include "format/parameter_tree.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "component/parameter_block.h"

namespace freeplay {

ParameterTree::ParameterTree(Span<const Parameter> table) {
  for (const Parameter& parameter : table) insert(parameter.name, parameter);
}

void ParameterTree::insert(std::string_view path, const Parameter& parameter) {
  const std::size_t dot = path.find('.');
  const std::string_view first = path.substr(0, dot);
  ParameterTree* child = nullptr;
  for (ParameterTree& existing : children) {
    if (existing.name == first) child = &existing;
  }
  if (child == nullptr) {
    children.push_back(ParameterTree());
    child = &children.back();
    child->name = first;
  }
  if (dot == std::string_view::npos) {
    child->leaf = &parameter;
  } else {
    child->insert(path.substr(dot + 1), parameter);
  }
}

bool ParameterTree::is_required() const {
  // A word or a map: the word decides, for the map stands in its place.
  if (leaf != nullptr) return std::isnan(leaf->default_value);
  for (const ParameterTree& child : children) {
    if (child.is_required()) return true;
  }
  return false;
}

std::vector<VariableRow> variables_of(const Parameter& parameter) {
  const auto trimmed = [](std::string_view text) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);
    return std::string(text);
  };
  std::vector<VariableRow> rows;
  if (may_follow_motion(parameter)) return rows;
  std::string_view rest = parameter.variables == nullptr ? "" : parameter.variables;
  while (!rest.empty()) {
    const std::string_view row = rest.substr(0, rest.find(';'));
    rest.remove_prefix(std::min(row.size() + 1, rest.size()));
    const std::size_t colon = std::min(row.find(':'), row.size());
    rows.push_back({trimmed(row.substr(0, colon)), colon < row.size() ? trimmed(row.substr(colon + 1)) : "1"});
  }
  return rows;
}

std::vector<std::string> words_of(const Parameter& parameter) {
  std::vector<std::string> words;
  if (parameter.choices == nullptr) return words;
  std::string_view rest = parameter.choices;
  while (true) {
    const std::size_t bar = rest.find('|');
    words.emplace_back(rest.substr(0, bar));
    if (bar == std::string_view::npos) return words;
    rest.remove_prefix(bar + 1);
  }
}

}  // namespace freeplay
