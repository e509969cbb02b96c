#include "model/table_formula.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "component/formula_calls.h"

namespace freeplay {
namespace {

struct TableFormula final : ServedFormula {
  TableFormula(TimeTable points, bool periodic, double first, double last)
      : table(std::move(points)), repeats(periodic), low(first), high(last) {
    EvaluationFailure ignored;
    table.evaluate(low, at_low, ignored);
    table.evaluate(high, at_high, ignored);
  }

  bool may_hide() const noexcept override { return true; }
  bool value(std::span<const double> variables, double& out) const noexcept override {
    out = at(variables[0]).value;
    return true;
  }
  void bound(const FormulaBounds::Span& span, FormulaBounds::Bounds& out) const noexcept override {
    const Jet &x = span.at_middle[0], f = at(x.value);
    out.at_middle = {f.value, f.rate * x.rate, f.acceleration * x.rate * x.rate + f.rate * x.acceleration};
    const IntervalJet by_x = range(span.ranges[0].value);
    out.range = chain(by_x.value, by_x.rate, by_x.acceleration, span.ranges[0]);
    tighten(out.range, out.at_middle, span.half);
  }

  /// Its value and derivatives over a range of the variable: exact second derivatives, as these are linear between
  /// points, and from them what the others can come to. The slope of straight lines jumps at a point.
  IntervalJet range(Interval x) const {
    if (!x.is_finite()) return unknown_jet();
    if (repeats && x.high - x.low >= high - low) x = {low, high};  // what comes again need not be looked at again
    IntervalJet out{};
    bool first = true;
    for (double from = x.low; first || from < x.high;) {
      const double next = table.next_point(from), to = next > from && next < x.high ? next : x.high;
      const double half = 0.5 * (to - from);
      const Jet middle = at(from + half);
      IntervalJet piece;
      piece.acceleration = hull(Interval::at(at(from).acceleration), Interval::at(at(to).acceleration));
      const Interval by{-half, half};
      piece.rate = Interval::at(middle.rate) + piece.acceleration * by;
      piece.value = Interval::at(middle.value) + piece.rate * by;
      out = first ? piece
                  : IntervalJet{hull(out.value, piece.value), hull(out.rate, piece.rate),
                                table.is_straight() ? Interval::whole() : hull(out.acceleration, piece.acceleration)};
      first = false;
      from = to;
    }
    return out;
  }

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
  /// Of what repeats: any number of periods may lie between the two, more than quadrature can look at.
  bool integral(double from, double to, double& value) const {
    double before = 0.0, after = 0.0;
    EvaluationFailure ignored;
    if (!repeats || !table.integral(from, before, ignored) || !table.integral(to, after, ignored)) return false;
    value = after - before;
    return true;
  }
  std::size_t switches() const { return table.is_straight() && !repeats ? table.times().size() - 2 : 0; }
};

const TableFormula& table_of(const void* self) { return *static_cast<const TableFormula*>(self); }

constexpr abi::FormulaTable table_formula{
    sizeof(abi::FormulaTable),
    [](const void* self, Span<const double> variables, double* value, Span<double> slopes, Message*) noexcept {
      FormulaCalls::note(self, variables);
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
    },
    [](const void* self, double from, double to, double* value) noexcept {
      return table_of(self).integral(from, to, *value);
    }};

}  // namespace

const TimeTable& set_table_formula(ParameterValue& value, std::vector<double> x, std::vector<double> y,
                                   Interpolation interpolation, SplineEnds ends) {
  const double low = x.front(), high = x.back();
  const bool repeats = ends == SplineEnds::periodic;
  TimeTable table(std::move(x), std::move(y), interpolation, ends, repeats ? Outside::repeat : Outside::hold);
  const auto served = std::make_shared<const TableFormula>(std::move(table), repeats, low, high);
  value.formula = Formula(table_formula, served.get());
  value.function_owner = served;
  value.served = served;
  return served->table;
}

}  // namespace freeplay
