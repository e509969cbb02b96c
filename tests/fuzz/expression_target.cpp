// An expression: compiled with and without time, and evaluated.
#include <cmath>

#include "base/expression.h"
#include "base/text.h"
#include "fuzz/harness.h"

namespace {

using namespace freeplay;

class Parameters : public Scope {
 public:
  const Quantity* find(std::string_view name) const override {
    static const Quantity a{2.0, DimensionKind::plain, {}}, l{0.5, DimensionKind::dimensioned, dimension::length},
        f{-3.0, DimensionKind::free, {}};
    return name == "a" ? &a : name == "l" ? &l : name == "f" ? &f : nullptr;
  }
  std::vector<std::string> names() const override { return {"a", "l", "f"}; }
};

bool is_finite(const Jet& jet) {
  return std::isfinite(jet.value) && std::isfinite(jet.rate) && std::isfinite(jet.acceleration);
}

void check(std::string_view text, bool time_allowed) {
  const int width = character_count(text);
  try {
    const Expression expression = Expression::compile(text, Parameters(), time_allowed);
    fuzz::require(time_allowed || !expression.depends_on_time(), "time is where it is allowed");
    if (!expression.depends_on_time())
      fuzz::require(std::isfinite(expression.constant().value), "a constant is finite");
    for (const double t : {0.0, 1e-3, 1.0, -2.0, 1e300}) {
      Jet value;
      EvaluationFailure failure;
      if (expression.evaluate(t, value, failure)) {
        fuzz::require(is_finite(value), "a value and its derivatives are finite");
      } else {
        fuzz::require(failure.offset >= 0 && failure.length >= 1 && failure.offset + failure.length <= width,
                      "a failure points into the expression");
      }
    }
    expression.require(dimension::length);
  } catch (const ExpressionError& error) {
    fuzz::require(error.offset >= 0 && error.offset <= width && error.length >= 1,
                  "an error points into the expression");
    fuzz::require(!error.message.empty(), "an error has a text");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  referenced_parameters(text);
  check(text, true);
  check(text, false);
  return 0;
}
