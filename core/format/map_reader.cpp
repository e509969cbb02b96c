#include "format/map_reader.h"

#include <algorithm>

#include "base/error.h"
#include "format/name_rule.h"

namespace freeplay {
namespace {

/// An expression with a comma that a flow map cut in two: `{value: atan2(1, 2)}`.
bool leaves_parenthesis_open(const std::string& text) {
  return std::count(text.begin(), text.end(), '(') > std::count(text.begin(), text.end(), ')');
}

/// The whole expression that the commas of a flow map cut in pieces, from the value of entry `cut` on; "" if that value
/// is complete.
std::string joined_expression(const Node& map, std::size_t cut) {
  if (!map.entries[cut].value->is_scalar()) return "";
  std::string text = map.entries[cut].value->text;
  if (!leaves_parenthesis_open(text)) return "";
  for (std::size_t i = cut + 1; i < map.entries.size() && leaves_parenthesis_open(text); ++i) {
    if (!map.entries[i].value->is_null()) break;
    text += ", " + map.entries[i].key->text;
  }
  return text;
}

}  // namespace

MapReader::MapReader(const CheckedValue& map, Uses uses) : owner_(map), good_(map.node().is_map()) {
  if (!good_) {
    map.wrong_type("a map");
    return;
  }
  if (uses == Uses::presets) {
    known_.push_back("use");
    layers_ = map.reading().presets->layers(map);
  } else {
    layers_.push_back({&map.node(), map.path(), map.user()});
  }
}

MapReader::MapReader(const CheckedValue& map, std::string_view format)
    : MapReader(map, format_map(format).find("use") == nullptr ? Uses::nothing : Uses::presets) {
  format_ = &format_map(format);
}

MapReader MapReader::empty(const CheckedValue& owner) { return MapReader(owner, NoKeys{}); }

MapReader MapReader::absent(const CheckedValue& owner) {
  MapReader map(owner, NoKeys{});
  map.absent_ = true;
  return map;
}

std::optional<MapReader::Hit> MapReader::look_up(std::string_view key) const {
  for (const MapLayer& layer : layers_) {
    for (const Node::Entry& entry : layer.map->entries) {
      if (entry.key->text == key) return Hit{&layer, &entry};
    }
  }
  PathOverrides* const added = paths();
  if (added == nullptr) return std::nullopt;
  const Node::Entry* entry = added->added(owner_.address_of(std::string(key)));
  return entry == nullptr ? std::nullopt : std::optional(Hit{nullptr, entry});
}

CheckedValue MapReader::value_of(const Hit& hit) const {
  const std::string& path = hit.layer == nullptr ? owner_.path() : hit.layer->path;
  const std::string& key = hit.entry->key->text;
  CheckedValue value = owner_.below(*hit.entry->value, hit.entry->key, path.empty() ? key : path + "." + key, key);
  value.set_user(hit.layer == nullptr ? std::string() : hit.layer->user);
  return value;
}

bool MapReader::has(std::string_view key) const { return look_up(key).has_value(); }

bool MapReader::knows(std::string_view key) const {
  return std::find(known_.begin(), known_.end(), key) != known_.end();
}

std::optional<CheckedValue> MapReader::find(const std::string& key) {
  if (format_ != nullptr && format_->find(key) == nullptr) {
    throw Error(Error::Category::internal, "internal",
                "the key '" + key + "' is not in the table of '" + std::string(format_->name) + "'");
  }
  if (!knows(key)) known_.push_back(key);
  if (paths() != nullptr) paths()->offer(owner_.address_of(key));
  const std::optional<Hit> hit = look_up(key);
  if (!hit) return std::nullopt;
  return value_of(*hit);
}

std::optional<CheckedValue> MapReader::require(const std::string& key) {
  std::optional<CheckedValue> value = find(key);
  if (!value && good_) report_missing(key);
  return value;
}

void MapReader::report_missing(const std::string& key) const {
  if (owner_.path().empty()) return owner_.fail_at_start("missing-key", "missing key '" + key + "'");
  owner_.fail_at_key("missing-key", "missing key '" + key + "' in '" + owner_.path() + "'");
}

void MapReader::refuse(const std::string& key, const std::string& hint) { refused_.push_back({key, hint}); }

bool MapReader::conflict(const std::string& first, const std::string& second) const {
  const std::optional<Hit> hit = look_up(second);
  if (!hit || !has(first)) return false;
  value_of(*hit).fail_at_key("conflicting-keys", "'" + first + "' and '" + second + "' exclude each other");
  return true;
}

std::string MapReader::hint_for(const std::string& key) const {
  for (const Refused& refused : refused_) {
    if (refused.key == key) return refused.hint;
  }
  return "";
}

std::string MapReader::suggestion_for(const std::string& key) const {
  for (const auto& [old, name] : renamed_) {
    if (old == key) return name;
  }
  return nearest(key, known_);
}

void MapReader::finish() {
  for (const MapLayer& layer : layers_) {
    for (std::size_t i = 0; i < layer.map->entries.size(); ++i) {
      const Node::Entry& entry = layer.map->entries[i];
      const std::string& key = entry.key->text;
      if (is_note(key) || knows(key) || (key == "use" && !layer.user.empty())) continue;
      const std::string cut = i > 0 ? joined_expression(*layer.map, i - 1) : "";
      const std::string hint =
          cut.empty() ? hint_for(key) : "an expression with a comma must be quoted here: \"" + cut + "\"";
      const std::string where = layer.path.empty() ? "" : " in '" + layer.path + "'";
      value_of({&layer, &entry})
          .fail_at_key("unknown-key", "unknown key '" + key + "'" + where, hint.empty() ? suggestion_for(key) : "",
                       hint);
    }
  }
}

std::vector<CheckedValue> entries_of(const CheckedValue& map, MapNames names) {
  std::vector<CheckedValue> entries;
  if (!map.node().is_map()) {
    map.wrong_type("a map");
    return entries;
  }
  const auto add = [&](const Node::Entry& entry) {
    const std::string path = map.path().empty() ? entry.key->text : map.path() + "." + entry.key->text;
    entries.push_back(map.below(*entry.value, entry.key, path, entry.key->text));
  };
  std::vector<std::string> written;
  for (const Node::Entry& entry : map.node().entries) {
    if (is_note(entry.key->text)) continue;
    add(entry);
    if (map.reading().paths != nullptr) written.push_back(entry.key->text);
  }
  if (map.reading().paths == nullptr || map.address().empty()) return entries;
  for (const Node::Entry* entry : map.reading().paths->added_names(map.address(), written, names)) add(*entry);
  return entries;
}

}  // namespace freeplay
