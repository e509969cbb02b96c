#include "base/option_value.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/expression.h"
#include "base/suggestion.h"

namespace freeplay {
void bad_value(const std::string& option, const std::string& text, const std::string& why, const std::string& hint) {
  throw Error(Error::Category::usage, "bad-value", fmt::format("bad value '{}' of {}: {}", text, option, why), {},
              hint);
}

double signed_quantity(const std::string& option, const std::string& text, const Dimension& dimension) {
  try {
    const Expression expression = Expression::compile(text, EmptyScope{}, false);
    expression.require(dimension);
    return expression.constant().value;
  } catch (const ExpressionError& e) {
    bad_value(option, text, e.message, e.suggestion.empty() ? e.hint : fmt::format("did you mean '{}'?", e.suggestion));
  }
}

double positive_quantity(const std::string& option, const std::string& text, const Dimension& dimension) {
  const double value = signed_quantity(option, text, dimension);
  if (!(value > 0.0)) bad_value(option, text, "it must be greater than 0");
  return value;
}

void require_word(const std::string& what, const std::string& word, const std::vector<std::string>& allowed) {
  if (std::ranges::find(allowed, word) != allowed.end()) return;
  if (allowed.empty()) throw Error(Error::Category::usage, "unknown-name", fmt::format("there is no {}", what));
  const auto nearest = suggestion(word, allowed);
  throw Error(
      Error::Category::usage, "unknown-name", fmt::format("there is no {} '{}'", what, word), {},
      nearest ? fmt::format("did you mean '{}'?", *nearest) : fmt::format("one of {}", fmt::join(allowed, ", ")));
}

long whole_number(const std::string& option, const std::string& text, long least) {
  const double value = signed_quantity(option, text, dimension::none);
  if (value != std::floor(value) || value < static_cast<double>(least) || value > 1e9) {
    bad_value(option, text, fmt::format("a whole number from {} to 10^9 is needed", least));
  }
  return static_cast<long>(value);
}

}  // namespace freeplay
