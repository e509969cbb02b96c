#include "study/axis_value.h"

#include "base/number_text.h"
#include "format/study_axis.h"
#include "yaml/text.h"

namespace freeplay {

AxisValue AxisValue::of(double number, const std::optional<Dimension>& dimension) {
  std::string shown = number_text(number);
  if (!dimension || dimension->dimensionless()) return {shown, shown};
  return {shown + " " + si_unit(*dimension), std::move(shown)};
}

AxisValue AxisValue::of(const std::string& text) {
  const std::optional<Quantity> quantity = constant_quantity(text);
  if (!quantity) return {text, text};
  const bool has_unit = quantity->kind == DimensionKind::dimensioned;
  return of(quantity->value, has_unit ? std::optional(quantity->dimension) : std::nullopt);
}

AxisValue AxisValue::of(const Node& node) {
  if (node.is_scalar()) return of(node.text);
  const std::string text = yaml_flow(node);
  return {text, text};
}

std::string AxisValue::cell() const {
  std::string cell = shown;
  for (char& c : cell) {
    if (c == ',') c = ';';
    if (c == '\n' || c == '"') c = ' ';
  }
  return cell;
}

}  // namespace freeplay
