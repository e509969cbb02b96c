// MapReader: the one way in which maps of the model file are read; it knows which keys were asked for.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "format/checked_value.h"
#include "format/key_table.h"
#include "format/path_override.h"
#include "format/preset.h"

namespace freeplay {

/// May the map copy keys from presets by `use`?
enum class Uses { nothing, presets };

/// A map with known keys. Every key that is asked for is known from then on, written or not; finish() reports the
/// others.
class MapReader {
 public:
  /// A map of the format table. Reports `wrong-type` when `map` is none; then nothing is found, nothing is missed, and
  /// good() is false.
  MapReader(const CheckedValue& map, std::string_view format);
  /// A map whose keys the table of a component names.
  explicit MapReader(const CheckedValue& map, Uses uses = Uses::nothing);
  /// A map without keys in the place of `owner`, such as a law that is given by its name alone; the command line may
  /// add some.
  static MapReader empty(const CheckedValue& owner);
  /// A map that is not there at all, not even for the command line.
  static MapReader absent(const CheckedValue& owner);
  /// From here on the keys are those of another map of the format table: the type of the entry is known.
  void follow(std::string_view format) { format_ = &format_map(format); }

  bool good() const { return good_; }
  const CheckedValue& owner() const { return owner_; }

  /// Is the key written? It does not become known.
  bool has(std::string_view key) const;
  /// Throws Error{internal} for a key that the format table does not name.
  std::optional<CheckedValue> find(const std::string& key);
  /// Reports `missing-key`.
  std::optional<CheckedValue> require(const std::string& key);
  void report_missing(const std::string& key) const;
  /// A key of the format that this release does not read: unknown, with `hint`.
  void refuse(const std::string& key, const std::string& hint = "not in this release");
  /// A key that has another name now: unknown, with that as the suggestion.
  void refuse_old(const std::string& key, const std::string& name) { renamed_.emplace_back(key, name); }
  /// `conflicting-keys` at the second key, if both are written.
  bool conflict(const std::string& first, const std::string& second) const;

  /// Reports the unknown keys.
  void finish();

 private:
  struct NoKeys {};
  MapReader(const CheckedValue& owner, NoKeys) : owner_(owner), good_(true) {}
  PathOverrides* paths() const { return good_ && !absent_ ? owner_.reading().paths : nullptr; }

  struct Hit {
    const MapLayer* layer;  ///< null: of the command line
    const Node::Entry* entry;
  };
  std::optional<Hit> look_up(std::string_view key) const;
  CheckedValue value_of(const Hit& hit) const;
  bool knows(std::string_view key) const;
  std::string hint_for(const std::string& key) const;
  std::string suggestion_for(const std::string& key) const;

  struct Refused {
    std::string key, hint;
  };

  CheckedValue owner_;
  const FormatMap* format_ = nullptr;
  bool good_, absent_ = false;
  std::vector<MapLayer> layers_;
  std::vector<std::string> known_;
  std::vector<Refused> refused_;
  std::vector<std::pair<std::string, std::string>> renamed_;
};

/// The entries of a map from names to something, notes left out and those of the command line last; reports
/// `wrong-type` when it is no map.
std::vector<CheckedValue> entries_of(const CheckedValue& map, MapNames names = MapNames::own);

}  // namespace freeplay
