#include "model/table_formula.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace freeplay {
namespace {

struct TableFormula {
  TimeTable table;
  bool repeats;
  double low, high;
  Jet at_low{}, at_high{};

  /// What beyond an end goes on as a straight line.
  Jet at(double x) const {
    if (!repeats && x < low) return {at_low.value + at_low.rate * (x - low), at_low.rate, 0.0};
    if (!repeats && x >= high) return {at_high.value + at_high.rate * (x - high), at_high.rate, 0.0};
    Jet out;
    EvaluationFailure ignored;  // a point between the ends has a value
    table.evaluate(x, out, ignored);
    return out;
  }
  std::size_t switches() const { return table.is_straight() && !repeats ? table.times().size() - 2 : 0; }
};

const TableFormula& table_of(const void* self) { return *static_cast<const TableFormula*>(self); }

constexpr abi::FormulaTable table_formula{
    sizeof(abi::FormulaTable),
    [](const void* self, Span<const double> variables, double* value, Span<double> slopes, Message*) noexcept {
      const Jet at = table_of(self).at(variables[0]);
      *value = at.value;
      std::ranges::fill(slopes, 0.0);
      if (!slopes.empty()) slopes[0] = at.rate;
      return Status::ok;
    },
    [](const void* self) noexcept { return static_cast<std::int32_t>(table_of(self).switches()); },
    [](const void* self, Span<const double> variables, Span<double> values) noexcept {
      const TableFormula& me = table_of(self);
      for (std::size_t i = 0; i < values.size; ++i) values[i] = variables[0] - me.table.times()[i + 1];
    }};

}  // namespace

void set_table_formula(ParameterValue& value, std::vector<double> x, std::vector<double> y, Interpolation interpolation,
                       SplineEnds ends) {
  const double low = x.front(), high = x.back();
  const bool repeats = ends == SplineEnds::periodic;
  TimeTable table(std::move(x), std::move(y), interpolation, ends, repeats ? Outside::repeat : Outside::hold);
  const auto served = std::make_shared<TableFormula>(TableFormula{std::move(table), repeats, low, high});
  EvaluationFailure ignored;
  served->table.evaluate(low, served->at_low, ignored);
  served->table.evaluate(high, served->at_high, ignored);
  value.formula = Formula(table_formula, served.get());
  value.function_owner = served;
}

}  // namespace freeplay
