// LocatedValue: a value of the model file with its place, and what is reported about it.
#pragma once

#include <string>
#include <vector>

#include "base/expression.h"
#include "format/document.h"
#include "format/reading.h"

namespace freeplay {

/// A node together with its key, its path for messages and what it is read in.
class LocatedValue {
 public:
  /// `reading` and the nodes outlive the value; `key` is null for the items of a list.
  LocatedValue(const Reading& reading, const Node& node, const Node* key, std::string path)
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

  /// The path in the expanded model; kept only where values take the place of others (Reading::paths).
  void set_address(std::string address) { address_ = std::move(address); }
  const std::string& address() const { return address_; }
  /// Of what stands below.
  std::string address_of(const std::string& key) const { return address_.empty() ? key : address_ + "." + key; }

  /// The value stands in a preset that is used for `user`.
  void set_user(std::string user) { user_ = std::move(user); }
  const std::string& user() const { return user_; }

  /// For the readout: full names that the value or the key refers to.
  void note_names(std::vector<std::string> names) const;
  void note_key(std::string name) const;

  /// Reports at the value, at the key.
  void fail(const std::string& id, const std::string& message, const std::string& suggested = {},
            const std::string& hint = {}) const;
  void fail_at_key(const std::string& id, const std::string& message, const std::string& suggested = {},
                   const std::string& hint = {}) const;
  /// At the first character of the file.
  void fail_at_start(const std::string& id, const std::string& message) const;
  void warn(const std::string& id, const std::string& message) const;
  void warn_at_key(const std::string& id, const std::string& message) const;
  /// `wrong-type`: "'path' must be `wanted`, not ...".
  void wrong_type(const std::string& wanted) const;

 protected:
  void fail_inside(const Node& text_node, const ExpressionError& error, int offset) const;
  const Node* blamed_override(const Node& at, const std::string& id) const;
  void report(const Node& at, Location location, int length, Severity severity, const std::string& id,
              const std::string& message, const std::string& suggested, const std::string& hint) const;

  const Reading* reading_;
  const Node* node_;
  const Node* key_;
  std::string path_;
  std::string user_{};
  std::string address_{};
};

}  // namespace freeplay
