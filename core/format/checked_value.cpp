#include "format/checked_value.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/suggestion.h"
#include "base/text.h"
#include "format/doubtful_number.h"
#include "format/parameter_scope.h"
#include "format/path_override.h"
#include "format/readout.h"

namespace freeplay {
namespace {

/// End of the group that opens at `open`, or npos; `${name}` may stand inside.
std::size_t closing_brace(const std::string& text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    if (text[i] == '{') ++depth;
    if (text[i] == '}' && --depth == 0) return i;
  }
  return std::string::npos;
}

bool is_integer(double x) { return std::abs(x - std::round(x)) <= 1e-9 && std::abs(x) < 1e15; }

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& allowed) {
  if (allowed.size() > most_candidates) return {};
  return suggestion(word, allowed).value_or("");
}

std::string either(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

std::optional<Expression> CheckedValue::compile(const Node& text_node, std::string_view text, int offset,
                                                bool time_allowed, const FormulaVariables* variables) const {
  bool broken = false;
  for (const std::string& name : referenced_parameters(text)) {
    if (!reading_->scope->broken(name)) continue;
    // It counts as used, so that one mistake does not also become a warning.
    reading_->scope->find(name);
    broken = true;
  }
  if (broken) return std::nullopt;
  try {
    if (text.find('(') != std::string_view::npos) doubt_degrees(*this, text);
    return variables == nullptr ? Expression::compile(text, *reading_->scope, time_allowed)
                                : Expression::compile(text, *reading_->scope, time_allowed, *variables);
  } catch (const ExpressionError& error) {
    const auto* channels = dynamic_cast<const ChannelNames*>(variables);
    const bool excused = channels != nullptr && channels->excused() && error.id == "unknown-name";
    if (!excused) fail_inside(text_node, error, offset);
  }
  return std::nullopt;
}

std::optional<Expression> CheckedValue::formula(const FormulaVariables& variables) const {
  if (!node_->is_scalar()) {
    wrong_type("a formula");
    return std::nullopt;
  }
  return compile(*node_, node_->text, 0, true, &variables);
}

std::optional<Expression> CheckedValue::formula(const FormulaVariables& variables, const Dimension& dimension) const {
  if (!node_->is_scalar()) {
    wrong_type("a formula");
    return std::nullopt;
  }
  std::optional<Expression> expression = compile(*node_, node_->text, 0, false, &variables);
  if (!expression) return std::nullopt;
  try {
    expression->require(dimension);
  } catch (const ExpressionError& error) {
    fail_inside(*node_, error, 0);
    return std::nullopt;
  }
  if (reading_->readout != nullptr) {
    reading_->readout->note_formula(reading_->instance, *node_, *reading_->scope);
  }
  return expression;
}

std::optional<Quantity> CheckedValue::any_quantity() const {
  if (!node_->is_scalar()) {
    wrong_type("a quantity");
    return std::nullopt;
  }
  const std::optional<Expression> expression = compile(*node_, node_->text, 0, false);
  if (!expression) return std::nullopt;
  return expression->constant();
}

std::optional<double> CheckedValue::quantity(const Dimension& dimension, const Range& range) const {
  if (!node_->is_scalar()) {
    wrong_type("a quantity");
    return std::nullopt;
  }
  const std::optional<Expression> expression = compile(*node_, node_->text, 0, false);
  if (!expression) return std::nullopt;
  try {
    expression->require(dimension);
  } catch (const ExpressionError& error) {
    fail_inside(*node_, error, 0);
    return std::nullopt;
  }
  const double value = expression->constant().value;
  if (reading_->readout != nullptr) reading_->readout->note_number(reading_->instance, *node_, value);
  if (range.contains(value)) return value;
  const std::string unit = si_unit(dimension);
  fail("out-of-range", "'" + path_ + "' must be " + range.text(unit) + ", not " + with_unit(value, unit));
  return std::nullopt;
}

bool CheckedValue::tried(const Expression& expression) const {
  Jet jet;
  EvaluationFailure failure;
  if (expression.evaluate(reading_->start_time, jet, failure)) return true;
  const ExpressionError error(failure.id,
                              fmt::format("{} at the start time {} s", failure.reason, reading_->start_time),
                              failure.offset, failure.length);
  fail_inside(*node_, error, 0);
  return false;
}

std::optional<Expression> CheckedValue::time_function(const Dimension& dimension, int derivatives,
                                                      const ChannelNames* channels) const {
  if (!node_->is_scalar()) {
    wrong_type("a quantity");
    return std::nullopt;
  }
  std::optional<Expression> expression = compile(*node_, node_->text, 0, true, channels);
  if (!expression) return std::nullopt;
  try {
    expression->require(dimension);
  } catch (const ExpressionError& error) {
    fail_inside(*node_, error, 0);
    return std::nullopt;
  }
  expression->need(derivatives);
  if (!expression->depends_on_variables() && !tried(*expression)) return std::nullopt;
  if (reading_->readout != nullptr) {
    reading_->readout->note_function(reading_->instance, *node_, *expression, *reading_->scope,
                                     channels == nullptr ? NamesInFull{} : channels->found());
  }
  return expression;
}

std::optional<Expression> CheckedValue::varying(const Dimension& dimension, const Range& range,
                                                const ChannelNames& channels) const {
  std::optional<Expression> constant;
  if (node_->is_scalar()) constant = compile(*node_, node_->text, 0, true, &channels);
  if (node_->is_scalar() && !constant) return std::nullopt;
  if (constant && (constant->depends_on_time() || constant->depends_on_variables())) {
    return time_function(dimension, 0, &channels);
  }
  return quantity(dimension, range) ? constant : std::nullopt;
}

std::optional<long> CheckedValue::integer(long minimum, long maximum) const {
  const std::optional<double> value = quantity(dimension::none);
  if (!value) return std::nullopt;
  if (!is_integer(*value)) {
    fail("wrong-type", fmt::format("'{}' must be an integer, not {}", path_, *value));
    return std::nullopt;
  }
  const long rounded = std::lround(*value);
  if (rounded >= minimum && rounded <= maximum) return rounded;
  const std::string limit = rounded < minimum ? fmt::format(">= {}", minimum) : fmt::format("<= {}", maximum);
  fail("out-of-range", fmt::format("'{}' must be {}, not {}", path_, limit, rounded));
  return std::nullopt;
}

std::optional<bool> CheckedValue::boolean() const {
  if (node_->is_scalar() && node_->text == "true") return true;
  if (node_->is_scalar() && node_->text == "false") return false;
  if (node_->is_scalar()) {
    fail("wrong-type", "'" + path_ + "' must be true or false, not '" + node_->text + "'");
  } else {
    wrong_type("true or false");
  }
  return std::nullopt;
}

std::optional<std::string> CheckedValue::string() const {
  if (node_->is_scalar()) return node_->text;
  wrong_type("a word or text");
  return std::nullopt;
}

std::optional<int> CheckedValue::word(const std::vector<std::string>& words) const {
  if (!node_->is_scalar()) {
    wrong_type(either(words));
    return std::nullopt;
  }
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == node_->text) return static_cast<int>(i);
  }
  fail("wrong-type", "'" + path_ + "' must be " + either(words) + ", not '" + node_->text + "'",
       nearest(node_->text, words));
  return std::nullopt;
}

CheckedValue CheckedValue::item(std::size_t index) const {
  return below(*node_->items[index], nullptr, fmt::format("{}[{}]", path_, index), fmt::format("{}", index));
}

CheckedValue CheckedValue::below(const Node& node, const Node* key, std::string path, const std::string& name) const {
  PathOverrides* const paths = reading_->paths;
  const std::string address = paths == nullptr ? std::string() : address_of(name);
  CheckedValue value(*reading_, paths == nullptr ? node : paths->replace(address, node), key, std::move(path));
  value.set_user(user());
  value.set_address(address);
  return value;
}

std::optional<std::vector<CheckedValue>> CheckedValue::list() const {
  if (!node_->is_list()) {
    wrong_type("a list");
    return std::nullopt;
  }
  std::vector<CheckedValue> items;
  for (std::size_t i = 0; i < node_->items.size(); ++i) items.push_back(item(i));
  return items;
}

std::optional<std::vector<CheckedValue>> CheckedValue::list(std::size_t length) const {
  if (!node_->is_list()) {
    wrong_type(fmt::format("a list of {}", length));
    return std::nullopt;
  }
  if (node_->items.size() == length) return list();
  fail("wrong-length",
       fmt::format("'{}' must have {} item{}, not {}", path_, length, length == 1 ? "" : "s", node_->items.size()));
  return std::nullopt;
}

std::optional<std::vector<CheckedValue>> CheckedValue::one_or_list() const {
  if (node_->is_scalar()) return std::vector<CheckedValue>{*this};
  if (node_->is_list()) return list();
  wrong_type("a name or a list of names");
  return std::nullopt;
}

std::optional<Vector3> CheckedValue::vector(const Dimension& dimension, const Range& range) const {
  const auto items = list(reading_->dimensions);
  if (!items) return std::nullopt;
  Vector3 vector{};
  bool good = true;
  for (std::size_t i = 0; i < items->size(); ++i) {
    const std::optional<double> component = (*items)[i].quantity(dimension, range);
    good = good && component.has_value();
    if (component) vector[i] = *component;
  }
  if (!good) return std::nullopt;
  return vector;
}

std::optional<std::vector<double>> CheckedValue::quantities(std::size_t length, const Dimension& dimension) const {
  const auto items = list(length);
  if (!items) return std::nullopt;
  std::vector<double> numbers;
  for (const CheckedValue& item : *items) {
    if (const std::optional<double> number = item.quantity(dimension)) numbers.push_back(*number);
  }
  if (numbers.size() < length) return std::nullopt;
  return numbers;
}

std::optional<std::string> CheckedValue::expand(const Node& text_node) const {
  const std::string& text = text_node.text;
  if (reading_->instance.empty()) return text;
  std::string expanded;
  std::size_t done = 0;
  for (std::size_t open = text.find('{'); open != std::string::npos; open = text.find('{', done)) {
    const std::size_t close = closing_brace(text, open);
    if (close == std::string::npos) break;
    expanded += text.substr(done, open - done);
    const int offset = character_count(std::string_view(text).substr(0, open + 1));
    const std::string formula = text.substr(open + 1, close - open - 1);
    const std::optional<Expression> expression = compile(text_node, formula, offset, false);
    if (!expression) return std::nullopt;
    const double number = expression->constant().value;
    if (!is_integer(number)) {
      report(text_node, text_node.location(), 0, Severity::error, "wrong-type",
             fmt::format("'{{{}}}' must be an integer, not {}", formula, number), {}, {});
      return std::nullopt;
    }
    expanded += fmt::format("{}", std::lround(number));
    done = close + 1;
  }
  return expanded + text.substr(done);
}

std::optional<std::string> CheckedValue::reference() const {
  if (node_->is_scalar()) return expand(*node_);
  wrong_type("a name");
  return std::nullopt;
}

std::optional<std::string> CheckedValue::key_reference() const { return expand(*key_); }

}  // namespace freeplay
