#include "format/preset.h"

#include <algorithm>

#include "format/name_rule.h"

namespace freeplay {
namespace {

constexpr std::size_t deepest_chain = 64;  // of presets that use presets
constexpr std::size_t most_presets = 256;  // of one entry

}  // namespace

/// One search for the layers of an entry.
struct PresetTable::Walk {
  std::string user;
  std::vector<MapLayer> layers;
  std::vector<const Preset*> open;     // being included: a second visit is a cycle
  std::vector<const Preset*> visited;  // included already: a weaker second copy changes nothing
};

void PresetTable::read(const CheckedValue& section) {
  if (!section.node().is_map()) return section.wrong_type("a map");
  for (const Node::Entry& entry : section.node().entries) {
    if (is_note(entry.key->text)) continue;
    const CheckedValue preset(section.reading(), *entry.value, entry.key, "presets." + entry.key->text);
    const std::string& name = entry.key->text;
    if (!is_name(name)) preset.fail_at_key("bad-name", "'" + name + "' is not a valid name", {}, name_hint(name));
    index_.emplace(entry.key->text, presets_.size());
    presets_.push_back({entry.key->text, entry.key, entry.value});
  }
}

const PresetTable::Preset* PresetTable::find(std::string_view name) const {
  const auto found = index_.find(std::string(name));
  return found == index_.end() ? nullptr : &presets_[found->second];
}

std::vector<std::string> PresetTable::names() const {
  std::vector<std::string> names;
  if (presets_.size() > most_candidates) return names;
  for (const Preset& preset : presets_) names.push_back(preset.name);
  return names;
}

std::vector<MapLayer> PresetTable::layers(const CheckedValue& map) const {
  Walk walk;
  walk.user = map.path();
  walk.layers.push_back({&map.node(), map.path(), map.user()});
  const Node* use = map.node().find("use");
  if (use == nullptr) return walk.layers;
  CheckedValue names(map.reading(), *use, nullptr, map.path() + ".use");
  names.set_user(map.user());
  follow(names, walk);
  return walk.layers;
}

void PresetTable::follow(const CheckedValue& use, Walk& walk) const {
  const auto names = use.one_or_list();
  if (!names) return;
  // A later name is stronger.
  for (auto name = names->rbegin(); name != names->rend(); ++name) include(*name, walk);
}

void PresetTable::include(const CheckedValue& name, Walk& walk) const {
  const std::optional<std::string> word = name.string();
  if (!word) return;
  const Preset* preset = find(*word);
  if (preset == nullptr) return name.fail("unknown-name", "unknown preset '" + *word + "'", nearest(*word, names()));
  used_->insert(preset->key);
  if (std::find(walk.open.begin(), walk.open.end(), preset) != walk.open.end()) {
    return name.fail("cyclic-preset", "preset '" + *word + "' uses itself");
  }
  if (walk.open.size() == deepest_chain) {
    return name.fail("too-large", "presets that use presets are nested too deeply");
  }
  if (std::find(walk.visited.begin(), walk.visited.end(), preset) != walk.visited.end()) return;
  if (walk.visited.size() == most_presets) {
    return name.fail("too-large", "an entry uses more than " + std::to_string(most_presets) + " presets");
  }
  walk.visited.push_back(preset);
  CheckedValue content(name.reading(), *preset->value, preset->key, "presets." + preset->name);
  content.set_user(walk.user);
  if (!content.node().is_map()) return content.wrong_type("a map");
  walk.layers.push_back({preset->value, content.path(), walk.user});
  const Node* use = preset->value->find("use");
  if (use == nullptr) return;
  CheckedValue inner(name.reading(), *use, nullptr, content.path() + ".use");
  inner.set_user(walk.user);
  walk.open.push_back(preset);
  follow(inner, walk);
  walk.open.pop_back();
}

}  // namespace freeplay
