#include "format/located_value.h"

#include <utility>

#include <fmt/format.h>

#include "format/parameter_scope.h"
#include "format/readout.h"

namespace freeplay {

/// The text of `--set` that makes the value at `at` wrong, or null.
const Node* LocatedValue::blamed_override(const Node& at, const std::string& id) const {
  if (!at.is_scalar() || id == "unknown-name" || id == "bad-unit") return nullptr;
  for (const std::string& name : referenced_parameters(at.text)) {
    const Node* override = reading_->scope->override_of(name);
    if (override != nullptr && override != &at) return override;
  }
  return nullptr;
}

void LocatedValue::report(const Node& at, Location location, int length, Severity severity, const std::string& id,
                          const std::string& message, const std::string& suggested, const std::string& hint) const {
  Diagnostic diagnostic;
  diagnostic.severity = severity;
  diagnostic.id = id;
  diagnostic.message = message;
  diagnostic.location = std::move(location);
  diagnostic.length = length > 0 ? length : at.length;
  if (const Node* override = blamed_override(at, id)) {
    diagnostic.notes.push_back(
        fmt::format("at {}:{}:{}", diagnostic.location.file, diagnostic.location.line, diagnostic.location.column));
    diagnostic.location = override->location();
    diagnostic.length = override->length;
  }
  diagnostic.suggestion = suggested;
  diagnostic.hint = hint;
  if (!user_.empty()) diagnostic.notes.push_back("used in '" + user_ + "'");
  if (!reading_->instance.empty()) diagnostic.notes.push_back("in instance '" + reading_->instance + "'");
  reading_->diagnostics->add(std::move(diagnostic));
}

void LocatedValue::fail(const std::string& id, const std::string& message, const std::string& suggested,
                        const std::string& hint) const {
  report(*node_, node_->location(), 0, Severity::error, id, message, suggested, hint);
}

void LocatedValue::fail_at_key(const std::string& id, const std::string& message, const std::string& suggested,
                               const std::string& hint) const {
  const Node& at = key_ == nullptr ? *node_ : *key_;
  report(at, at.location(), 0, Severity::error, id, message, suggested, hint);
}

void LocatedValue::fail_at_start(const std::string& id, const std::string& message) const {
  report(*node_, {node_->location().file, 1, 1}, 1, Severity::error, id, message, {}, {});
}

void LocatedValue::warn(const std::string& id, const std::string& message) const {
  report(*node_, node_->location(), 0, Severity::warning, id, message, {}, {});
}

void LocatedValue::warn_at_key(const std::string& id, const std::string& message) const {
  const Node& at = key_ == nullptr ? *node_ : *key_;
  report(at, at.location(), 0, Severity::warning, id, message, {}, {});
}

void LocatedValue::wrong_type(const std::string& wanted) const {
  // Nothing has no place of its own: the key is where a person looks.
  if (node_->is_null()) return fail_at_key("wrong-type", "'" + path_ + "' is empty; it must be " + wanted);
  fail("wrong-type", "'" + path_ + "' must be " + wanted + ", not " + node_->kind_name());
}

void LocatedValue::fail_inside(const Node& text_node, const ExpressionError& error, int offset) const {
  const int length = text_node.verbatim ? error.length : text_node.length;
  report(text_node, text_node.location_at(offset + error.offset), length, Severity::error, error.id, error.message,
         error.suggestion, error.hint);
}

void LocatedValue::note_names(std::vector<std::string> names) const {
  if (reading_->readout != nullptr) reading_->readout->note_names(reading_->instance, *node_, std::move(names));
}

void LocatedValue::note_key(std::string name) const {
  if (reading_->readout != nullptr) reading_->readout->note_names(reading_->instance, *key_, {std::move(name)});
}

}  // namespace freeplay
