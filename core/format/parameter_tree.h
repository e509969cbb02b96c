// ParameterTree: a component's parameter table as the nested maps in which the model file writes it.
#pragma once

#include <string>
#include <vector>

#include "freeplay/parameter.h"

namespace freeplay {

/// A key: a value, a map of further keys, or either ("a word or a map").
struct ParameterTree {
  /// The root of a table; names such as "clearance.material.E" become branches.
  explicit ParameterTree(Span<const Parameter> table);

  std::string name{};
  const Parameter* leaf = nullptr;
  std::vector<ParameterTree> children{};

  /// Must the key be written? A map must when something in it must.
  bool is_required() const;

 private:
  ParameterTree() = default;
  void insert(std::string_view path, const Parameter& parameter);
};

/// A variable of a formula, and its unit as written in the table.
struct VariableRow {
  std::string name, unit;
};
std::vector<VariableRow> variables_of(const Parameter& parameter);

/// The words of a choice, or those accepted in the place of a number.
std::vector<std::string> words_of(const Parameter& parameter);

}  // namespace freeplay
