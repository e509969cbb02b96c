#include "format/motion_parameters.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "component/registry.h"
#include "format/parameter_scope.h"
#include "model/time_function.h"

namespace freeplay {

void MotionParameters::take(const Parameter& parameter, Expression formula, const CheckedValue& written,
                            ParameterValue& value) {
  value.by_motion = true;
  set_function(value, std::numeric_limits<double>::quiet_NaN());
  const Node& node = written.node();
  formulas_.insert_or_assign(parameter.name,
                             std::pair(std::move(formula), FormulaPlace{node.location_at(0), node.verbatim}));
}

void MotionParameters::give(const ParameterBlock& block, const std::vector<MotionChannel>& channels,
                            JointElement& element) const {
  if (formulas_.empty()) return;
  element.by_motion.channels = channels;
  for (const Parameter& parameter : block.component->description.parameters) {
    if (!may_follow_motion(parameter)) continue;
    const auto found = formulas_.find(std::string_view(parameter.name));
    if (found != formulas_.end()) {
      for (Expression& part : found->second.first.time_parts()) element.in_time.push_back(std::move(part));
      element.by_motion.formulas.emplace_back(found->second.first);
      element.places.push_back(found->second.second);
    } else {
      const double number = block.values.find(std::string_view(parameter.name))->second.number;
      const std::string text = fmt::format("{}", std::isfinite(number) ? number : 0.0);
      element.by_motion.formulas.emplace_back(Expression::compile(text, EmptyScope(), false));
      element.places.emplace_back();
    }
  }
}

}  // namespace freeplay
