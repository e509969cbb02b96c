// CheckedValue: a value of the model file that is read as what it should be, with a located message when it is not.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/expression.h"
#include "format/located_value.h"
#include "format/range.h"
#include "model/model.h"

namespace freeplay {

/// Names of channels in a formula, and what was found under them.
class ChannelNames : public FormulaVariables {
 public:
  /// Names as written, each once, and in full.
  virtual const std::vector<std::pair<std::string, std::string>>& found() const = 0;
  /// One that was not found may belong to an entry that is in error: it need not be reported.
  virtual bool excused() const = 0;
};

/// Readers return nothing after they have reported why; they never throw for what a person wrote.
class CheckedValue : public LocatedValue {
 public:
  using LocatedValue::LocatedValue;

  /// A constant of this dimension, in SI.
  std::optional<double> quantity(const Dimension& dimension, const Range& range = {}) const;
  /// A constant of whatever dimension.
  std::optional<Quantity> any_quantity() const;
  /// A function of time, tried at the start time, of which the first `derivatives` are used; with `channels` also one
  /// of these, which cannot be tried.
  std::optional<Expression> time_function(const Dimension& dimension, int derivatives = 2,
                                          const ChannelNames* channels = nullptr) const;
  /// A constant in `range`, or a function of time and of `channels`; it is used without derivatives by time.
  std::optional<Expression> varying(const Dimension& dimension, const Range& range, const ChannelNames& channels) const;
  /// A function of time and of `variables`, of whatever dimension.
  std::optional<Expression> formula(const FormulaVariables& variables) const;
  /// A function of `variables` alone, of this dimension.
  std::optional<Expression> formula(const FormulaVariables& variables, const Dimension& dimension) const;
  std::optional<long> integer(long minimum, long maximum) const;
  std::optional<bool> boolean() const;
  /// Any scalar, as it is.
  std::optional<std::string> string() const;
  /// Index of the word in `words`.
  std::optional<int> word(const std::vector<std::string>& words) const;
  bool in_space() const { return reading_->dimensions == 3; }
  /// As many quantities as the space has dimensions; the rest is zero.
  std::optional<Vector3> vector(const Dimension& dimension, const Range& range = {}) const;
  /// Exactly `length` quantities.
  std::optional<std::vector<double>> quantities(std::size_t length, const Dimension& dimension) const;
  std::optional<std::vector<CheckedValue>> list() const;
  /// A list of exactly `length` items.
  std::optional<std::vector<CheckedValue>> list(std::size_t length) const;
  /// A scalar or the items of a list.
  std::optional<std::vector<CheckedValue>> one_or_list() const;
  /// A scalar that refers to something: inside a template `{EXPR}` is replaced by the value of EXPR.
  std::optional<std::string> reference() const;
  /// The key, read the same way.
  std::optional<std::string> key_reference() const;

  CheckedValue item(std::size_t index) const;
  /// A value of this map or list, or what takes its place; `name` is its key or number.
  CheckedValue below(const Node& node, const Node* key, std::string path, const std::string& name) const;

 private:
  std::optional<Expression> compile(const Node& text_node, std::string_view text, int offset, bool time_allowed,
                                    const FormulaVariables* variables = nullptr) const;
  bool tried(const Expression& expression) const;
  std::optional<std::string> expand(const Node& text_node) const;
};

/// A longer list of names is not searched for the one that was meant: a file may hold as many that are wrong.
inline constexpr std::size_t most_candidates = 2000;

/// The nearest of `allowed`, or "" when there is none; at most most_candidates are searched.
std::string nearest(std::string_view word, const std::vector<std::string>& allowed);

/// "a, b or c".
std::string either(const std::vector<std::string>& words);

}  // namespace freeplay
