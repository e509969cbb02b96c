// MotionParameters: parameters of a force element that may depend on the motion.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "format/checked_value.h"

namespace freeplay {

class MotionParameters {
 public:
  explicit MotionParameters(const ChannelNames& names) : names_(&names) {}

  /// What they may name.
  const ChannelNames& names() const { return *names_; }
  /// `value` depends on time or on the motion, as `formula`, which is written at `written`, says.
  void take(const Parameter& parameter, Expression formula, const CheckedValue& written, ParameterValue& value);
  /// Fills the element's formulas with those of all that may depend on it, in the order of the table, where one does;
  /// constants as they are.
  void give(const ParameterBlock& block, const std::vector<MotionChannel>& channels, JointElement& element) const;

 private:
  const ChannelNames* names_;
  std::map<std::string, std::pair<Expression, FormulaPlace>, std::less<>> formulas_;
};

}  // namespace freeplay
