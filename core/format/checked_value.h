// CheckedValue: a value of the model file that is read as what it should be, with a located message when it is not.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/expression.h"
#include "format/document.h"
#include "format/range.h"
#include "format/reading.h"
#include "model/model.h"

namespace freeplay {

/// A node together with its key, its path for messages and what it is read in. Readers return nothing after they have
/// reported why; they never throw for what a person wrote.
class CheckedValue {
 public:
  /// `reading` and the nodes outlive the value; `key` is null for the items of a list.
  CheckedValue(const Reading& reading, const Node& node, const Node* key, std::string path)
      : reading_(&reading), node_(&node), key_(key), path_(std::move(path)) {}

  const Node& node() const { return *node_; }
  const Reading& reading() const { return *reading_; }
  const std::string& path() const { return path_; }
  /// Text of the key; empty for items of a list.
  std::string key() const { return key_ == nullptr ? std::string() : key_->text; }
  const Node* key_node() const { return key_; }
  /// Place of the key, or of the value when it has none.
  Location key_location() const { return key_ == nullptr ? node_->location() : key_->location(); }
  Location location() const { return node_->location(); }

  /// The value stands in a preset that is used for `user`.
  void set_user(std::string user) { user_ = std::move(user); }
  const std::string& user() const { return user_; }

  /// A constant of this dimension, in SI.
  std::optional<double> quantity(const Dimension& dimension, const Range& range = {}) const;
  /// A constant of whatever dimension.
  std::optional<Quantity> any_quantity() const;
  /// A function of time, tried at the start time, of which the first `derivatives` are used.
  std::optional<Expression> time_function(const Dimension& dimension, int derivatives = 2) const;
  std::optional<long> integer(long minimum, long maximum) const;
  std::optional<bool> boolean() const;
  /// Any scalar, as it is.
  std::optional<std::string> string() const;
  /// Index of the word in `words`.
  std::optional<int> word(const std::vector<std::string>& words) const;
  bool in_space() const { return reading_->dimensions == 3; }
  /// As many quantities as the space has dimensions; the rest is zero.
  std::optional<Vector3> vector(const Dimension& dimension) const;
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

  /// For the readout: full names that the value or the key refers to.
  void note_names(std::vector<std::string> names) const;
  void note_key(std::string name) const;

  CheckedValue item(std::size_t index) const;

  /// Reports at the value, at the key.
  void fail(const std::string& id, const std::string& message, const std::string& suggestion = {},
            const std::string& hint = {}) const;
  void fail_at_key(const std::string& id, const std::string& message, const std::string& suggestion = {},
                   const std::string& hint = {}) const;
  /// At the first character of the file.
  void fail_at_start(const std::string& id, const std::string& message) const;
  void warn(const std::string& id, const std::string& message) const;
  void warn_at_key(const std::string& id, const std::string& message) const;
  /// `wrong-type`: "'path' must be `wanted`, not ...".
  void wrong_type(const std::string& wanted) const;

 private:
  std::optional<Expression> compile(const Node& text_node, std::string_view text, int offset, bool time_allowed) const;
  void fail_inside(const Node& text_node, const ExpressionError& error, int offset) const;
  const Node* blamed_override(const Node& at, const std::string& id) const;
  bool tried(const Expression& expression) const;
  std::optional<std::string> expand(const Node& text_node) const;
  void report(const Node& at, Location location, int length, Severity severity, const std::string& id,
              const std::string& message, const std::string& suggestion, const std::string& hint) const;

  const Reading* reading_;
  const Node* node_;
  const Node* key_;
  std::string path_;
  std::string user_{};
};

/// A longer list of names is not searched for the one that was meant: a file may hold as many that are wrong.
inline constexpr std::size_t most_candidates = 2000;

/// The nearest of `allowed`, or "" when there is none; at most most_candidates are searched.
std::string nearest(std::string_view word, const std::vector<std::string>& allowed);

/// "a, b or c".
std::string either(const std::vector<std::string>& words);

}  // namespace freeplay
