#include "model/time_function.h"

#include <memory>
#include <utility>

#include "model/written_formula.h"

namespace freeplay {
namespace {

struct WrittenFunction {
  Expression expression;
  Location begin;
  bool places_inside;  ///< the text stands in the file as it is: characters of it are places there
};

Status evaluate_written(const void* self, double t, TimeValue* out, Message* message) noexcept {
  const auto& function = *static_cast<const WrittenFunction*>(self);
  Jet jet;
  EvaluationFailure failure;
  if (function.expression.evaluate(t, jet, failure)) {
    *out = {jet.value, jet.rate, jet.acceleration};
    return Status::ok;
  }
  return tell_failure(function.begin, function.places_inside, failure, *message);
}

Status evaluate_constant(const void* self, double, TimeValue* out, Message*) noexcept {
  *out = {*static_cast<const double*>(self), 0.0, 0.0};
  return Status::ok;
}

}  // namespace

void set_function(ParameterValue& value, double constant) {
  const auto served = std::make_shared<const double>(constant);
  value.function = {&evaluate_constant, served.get()};
  value.function_owner = served;
}

void set_function(ParameterValue& value, Expression expression, Location begin, bool places_inside) {
  const auto served =
      std::make_shared<const WrittenFunction>(WrittenFunction{std::move(expression), std::move(begin), places_inside});
  value.function = {&evaluate_written, served.get()};
  value.function_owner = served;
}

const Expression* written_expression(const ParameterValue& value) {
  if (value.function.evaluate != &evaluate_written) return nullptr;
  return &static_cast<const WrittenFunction*>(value.function.self)->expression;
}

}  // namespace freeplay
