// FormatTable: every map of the model file with its keys. Readers may ask for no other key, and the reference page and
// the JSON Schema are made from it.
#pragma once

#include <span>
#include <string_view>

namespace freeplay {

/// What may stand under one key.
struct FormatKey {
  std::string_view name;
  /// Alternatives joined by " | ": a sort of scalar (quantity, time function, integer, boolean, text, name, frame),
  /// a literal word in quotes, vector, frame value (a vector or "map frame"), grid (a quantity, a list of
  /// them or "map grid"), value (a quantity, a word, a list or a map), axis (a value, a list of them or "map study
  /// axis"), "list of X", "entries of X" (a map from names to X), "map NAME" (a map of this table), "contents" (a map
  /// that is checked where it is used).
  std::string_view value;
  std::string_view unit;      ///< SI unit of quantities and vectors; "" for others, and where it follows from elsewhere
  std::string_view fallback;  ///< what holds without the key; "required", or "" where nothing does
  std::string_view meaning;
  std::string_view example;
};

/// A map of the model file.
struct FormatMap {
  std::string_view name;     ///< as in "map NAME"
  std::string_view where;    ///< where it stands in the file: "bodies.NAME.pose"
  std::string_view meaning;  ///< one sentence
  std::span<const FormatKey> keys;

  const FormatKey* find(std::string_view key) const;
};

/// In the order of the reference page; the first is the whole file.
std::span<const FormatMap> format_maps();
/// Throws Error{internal} when there is none.
const FormatMap& format_map(std::string_view name);

}  // namespace freeplay
