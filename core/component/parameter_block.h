// ParameterBlock: the checked values of one component, ready for its constructor.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "component/served_formula.h"
#include "freeplay/plugin.h"

namespace freeplay {

struct ParameterBlock;

/// Does the table let it depend on the motion?
inline bool may_follow_motion(const Parameter& parameter) {
  const bool kind = parameter.kind == ParameterKind::number || parameter.kind == ParameterKind::function;
  return kind && parameter.variables != nullptr && std::string_view(parameter.variables) == "motion";
}

/// Numbers of a list, as y, or points of a table.
struct ParameterPoints {
  std::vector<double> x, y;
};

/// Value of one entry of a parameter table, SI. What was not written holds its default.
struct ParameterValue {
  bool given = false;
  bool by_motion = false;  ///< JointInput::functions has it
  double number = std::numeric_limits<double>::quiet_NaN();
  int word = -1;
  std::array<double, 3> vector{};
  TimeFunction function;
  Formula formula;
  std::shared_ptr<const ParameterPoints> points;  ///< list, table; null: absent
  std::shared_ptr<const void> function_owner;     ///< keeps what `function` or `formula` points at
  std::shared_ptr<const ServedFormula> served;    ///< what is known of `formula`; null: nothing
  std::shared_ptr<const ParameterBlock> law;      ///< contact_law, friction_law
};

/// Values by the names of the component's table.
struct ParameterBlock {
  const Component* component = nullptr;
  std::map<std::string, ParameterValue, std::less<>> values;
};

}  // namespace freeplay
