#include "model/written_formula.h"

#include <array>
#include <memory>
#include <utility>

#include "base/format_into.h"
#include "base/state_formula.h"
#include "component/formula_calls.h"

namespace freeplay {
namespace {

struct WrittenFormula final : ServedFormula {
  WrittenFormula(const Expression& expression, Location at, bool inside)
      : formula(expression), begin(std::move(at)), places_inside(inside) {}

  bool may_hide() const noexcept override {
    return formula.switches() <= most_switches && (bounds.may_hide() || formula.switches() > 0);
  }
  bool value(std::span<const double> variables, double& out) const noexcept override {
    EvaluationFailure ignored;
    return formula.value({0.0, variables, nullptr}, out, ignored);
  }
  void bound(const FormulaBounds::Span& span, FormulaBounds::Bounds& out) const noexcept override {
    formula.switches() <= few_switches ? bound_with<few_switches>(span, out) : bound_with<most_switches>(span, out);
  }
  template <int count>
  void bound_with(const FormulaBounds::Span& span, FormulaBounds::Bounds& out) const noexcept {
    std::array<FormulaBounds::Bounds, count> ignored;
    bounds.bound(span, out, ignored);
  }

  static constexpr int few_switches = 4, most_switches = 200;
  StateFormula formula;
  Location begin;
  bool places_inside;
  FormulaBounds bounds{formula};
};

std::span<const double> numbers(Span<const double> span) { return {span.data, span.size}; }
std::span<double> numbers(Span<double> span) { return {span.data, span.size}; }

constexpr abi::FormulaTable written_formula{
    sizeof(abi::FormulaTable),
    [](const void* self, Span<const double> variables, double* value, Span<double> slopes, Message* message) noexcept {
      const auto& me = *static_cast<const WrittenFormula*>(self);
      FormulaCalls::note(self, variables);
      const StateFormula::Input in{0.0, numbers(variables), nullptr};
      EvaluationFailure failure;
      const bool good = me.formula.slopes(in, *value, numbers(slopes), failure);
      return good ? Status::ok : tell_failure(me.begin, me.places_inside, failure, *message);
    },
    [](const void* self) noexcept {
      return static_cast<std::int32_t>(static_cast<const WrittenFormula*>(self)->formula.switches());
    },
    [](const void* self, Span<const double> variables, Span<double> values) noexcept {
      static_cast<const WrittenFormula*>(self)->formula.decide({0.0, numbers(variables), nullptr}, numbers(values));
    }};

}  // namespace

void set_formula(ParameterValue& value, const Expression& expression, Location begin, bool places_inside) {
  const auto served = std::make_shared<const WrittenFormula>(expression, std::move(begin), places_inside);
  value.formula = Formula(written_formula, served.get());
  value.function_owner = served;
  value.served = served;
}

Status tell_failure(const Location& begin, bool places_inside, const EvaluationFailure& failure, Message& message) {
  const int column = begin.column + (places_inside ? failure.offset : 0);
  char* const end = message.text + sizeof message.text - 1;
  *format_into(message.text, end, "{}:{}:{}: {}", begin.file, begin.line, column, failure.reason) = '\0';
  abi::copy_text(message.id, sizeof message.id, failure.id);
  return Status::bad_parameter;
}

}  // namespace freeplay
