// Preset: maps of keys that entries copy by `use`.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "format/checked_value.h"
#include "format/parameter_scope.h"

namespace freeplay {

/// The maps in which a key of an entry is looked up, the strongest first.
struct MapLayer {
  const Node* map;
  std::string path;  ///< of the map, for messages
  std::string user;  ///< path of the entry that uses it; empty for the entry itself
};

/// The section `presets`.
class PresetTable {
 public:
  explicit PresetTable(UsedKeys& used) : used_(&used) {}

  /// Names are checked here, contents where they are used.
  void read(const CheckedValue& section);

  /// `map` itself and the presets that its key `use` names, theirs included. Reports `unknown-name` and
  /// `cyclic-preset`.
  std::vector<MapLayer> layers(const CheckedValue& map) const;

 private:
  struct Preset {
    std::string name;
    const Node* key;
    const Node* value;
  };
  struct Walk;

  const Preset* find(std::string_view name) const;
  std::vector<std::string> names() const;
  void follow(const CheckedValue& use, Walk& walk) const;
  void include(const CheckedValue& name, Walk& walk) const;

  UsedKeys* used_;
  std::vector<Preset> presets_;
  std::unordered_map<std::string, std::size_t> index_;
};

}  // namespace freeplay
