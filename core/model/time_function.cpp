#include "model/time_function.h"

#include <memory>
#include <utility>

namespace freeplay {
namespace {

struct ServedFunction {
  Expression expression;
  std::optional<double> constant;
};

Status evaluate(const void* self, double t, TimeValue* out, Message* message) noexcept {
  const auto& function = *static_cast<const ServedFunction*>(self);
  if (function.constant) {
    *out = {*function.constant, 0.0, 0.0};
    return Status::ok;
  }
  Jet jet;
  EvaluationFailure failure;
  if (!function.expression.evaluate(t, jet, failure)) {
    abi::copy_text(message->text, sizeof message->text, failure.reason);
    return Status::failed;
  }
  *out = {jet.value, jet.rate, jet.acceleration};
  return Status::ok;
}

}  // namespace

void set_function(ParameterValue& value, Expression expression, std::optional<double> constant) {
  const auto served = std::make_shared<const ServedFunction>(ServedFunction{std::move(expression), constant});
  value.function = {&evaluate, served.get()};
  value.function_owner = served;
}

}  // namespace freeplay
