#include "model/map_reader.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "model/name_rule.h"

namespace freeplay {
namespace {

/// An expression with a comma that a flow map cut in two: `{value: atan2(1, 2)}`.
bool leaves_parenthesis_open(const std::string& text) {
  return std::count(text.begin(), text.end(), '(') > std::count(text.begin(), text.end(), ')');
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

std::optional<MapReader::Hit> MapReader::look_up(std::string_view key) const {
  for (const MapLayer& layer : layers_) {
    for (const Node::Entry& entry : layer.map->entries) {
      if (entry.key->text == key) return Hit{&layer, &entry};
    }
  }
  return std::nullopt;
}

CheckedValue MapReader::value_of(const Hit& hit) const {
  const std::string& path = hit.layer->path;
  const std::string& key = hit.entry->key->text;
  CheckedValue value(owner_.reading(), *hit.entry->value, hit.entry->key, path.empty() ? key : path + "." + key);
  value.set_user(hit.layer->user);
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

std::string MapReader::hint_for(const Node& key, const Node* before) const {
  for (const Refused& refused : refused_) {
    if (refused.key == key.text) return refused.hint;
  }
  const bool cut = before != nullptr && before->is_scalar() && leaves_parenthesis_open(before->text);
  return cut ? "an expression with a comma must be quoted here: \"" + before->text + ", " + key.text + "\"" : "";
}

void MapReader::finish() {
  for (const MapLayer& layer : layers_) {
    const Node* before = nullptr;  // value of the entry before
    for (const Node::Entry& entry : layer.map->entries) {
      const Node* const previous = std::exchange(before, entry.value);
      const std::string& key = entry.key->text;
      if (is_note(key) || knows(key) || (key == "use" && !layer.user.empty())) continue;
      const std::string hint = hint_for(*entry.key, previous);
      const std::string where = layer.path.empty() ? "" : " in '" + layer.path + "'";
      value_of({&layer, &entry})
          .fail_at_key("unknown-key", "unknown key '" + key + "'" + where, hint.empty() ? nearest(key, known_) : "",
                       hint);
    }
  }
}

std::vector<CheckedValue> entries_of(const CheckedValue& map) {
  std::vector<CheckedValue> entries;
  if (!map.node().is_map()) {
    map.wrong_type("a map");
    return entries;
  }
  for (const Node::Entry& entry : map.node().entries) {
    if (is_note(entry.key->text)) continue;
    const std::string path = map.path().empty() ? entry.key->text : map.path() + "." + entry.key->text;
    entries.emplace_back(map.reading(), *entry.value, entry.key, path);
    entries.back().set_user(map.user());
  }
  return entries;
}

}  // namespace freeplay
