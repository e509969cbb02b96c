#include "contract/type_list.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/option_value.h"
#include "base/suggestion.h"
#include "contract/component_entry.h"
#include "contract/sample_layout.h"
#include "model/channel.h"
#include "model/model.h"

namespace freeplay {
namespace {

/// Does an entry stand in the list of this kind?
bool belongs(const Json& entry, const std::string& kind, const std::vector<std::string>& force_types) {
  const std::string word = entry["kind"];
  if (kind.empty()) return true;
  if (kind == "laws") return word == "contact" || word == "friction";
  if (kind == "integrators") return word == "integrator";
  if (kind == "joints") return word == "joint";
  const std::string name = entry["name"];
  return kind == "forces" && (word == "force" || std::ranges::find(force_types, name) != force_types.end());
}

/// One object per library, with the number of its types.
Json plugins_json(const Registry& registry) {
  Json list = Json::array();
  for (const RegisteredComponent& entry : registry.components()) {
    const auto same = [&](const RegisteredComponent& other) { return other.library == entry.library; };
    const bool seen = std::ranges::any_of(list, [&](const Json& row) { return row["name"] == entry.library; });
    if (seen) continue;
    const auto count = std::ranges::count_if(registry.components(), same);
    list.push_back({{"name", entry.library},
                    {"kind", "plugin"},
                    {"space", "both"},
                    {"source", entry.library},
                    {"summary", fmt::format("{} types", count)},
                    {"parameters", Json::array()},
                    {"formula", ""},
                    {"validity", ""},
                    {"references", ""}});
  }
  return list;
}

[[noreturn]] void unknown(const std::vector<Json>& entries, const std::string& name, const Registry& registry) {
  for (const ComponentKind kind :
       {ComponentKind::joint, ComponentKind::contact_law, ComponentKind::friction_law, ComponentKind::integrator}) {
    const char* remedy = registry.remedy(kind, name);
    if (remedy == nullptr) continue;
    throw Error(Error::Category::usage, "unknown-name", fmt::format("the type '{}' is not in this build", name), {},
                remedy);
  }
  std::vector<std::string> names;
  for (const Json& entry : entries) names.push_back(entry["name"]);
  const auto nearest = suggestion(name, names);
  throw Error(Error::Category::usage, "unknown-name", fmt::format("there is no type '{}'", name), {},
              nearest ? fmt::format("did you mean '{}'?", *nearest) : "`freeplay list` shows all");
}

/// The result columns of a joint called NAME in models of `space`; none of other types.
Json channels_json(const Json& entry, const Registry& registry, Space space) {
  Json channels = Json::array();
  const Component* type = registry.find(ComponentKind::joint, entry["name"].get<std::string>());
  if (entry["kind"] != "joint" || type == nullptr) return channels;
  const std::optional<SampleJoint> sample = sample_joint(*type, registry, space);
  if (!sample) return channels;
  Model model;
  model.space = space;
  JointElement& joint = model.joints.emplace_back();
  joint.name = "NAME";
  joint.layout = sample->layout;
  const Channels all(model);
  for (const ChannelInfo& channel : all.all()) {
    if (!channel.name.starts_with("joint.NAME.")) continue;
    channels.push_back({{"name", channel.name}, {"unit", channel.unit}});
  }
  return channels;
}

/// Adds the columns of a joint: those in the plane, or in space where it works there only, and for a type of both the
/// others apart.
void add_channels(Json& entry, const Registry& registry) {
  const bool spatial = entry["space"] == "spatial", both = entry["space"] == "both" && entry["kind"] == "joint";
  entry["channels"] = channels_json(entry, registry, spatial ? Space::spatial : Space::planar);
  if (both) entry["channels_in_space"] = channels_json(entry, registry, Space::spatial);
}

}  // namespace

void require_listed(const std::string& kind) {
  if (!kind.empty())
    require_word("kind to list", kind, {"joints", "laws", "forces", "integrators", "plugins", "channels"});
}

Json type_entries(const Registry& registry, const std::string& kind) {
  const std::vector<std::string> forces = kind == "forces" ? force_types(registry) : std::vector<std::string>();
  Json list = Json::array();
  for (const Json& entry : all_entries(registry)) {
    if (belongs(entry, kind, forces)) list.push_back(entry);
  }
  if (kind.empty() || kind == "plugins") {
    for (const Json& plugin : plugins_json(registry)) list.push_back(plugin);
  }
  return list;
}

Json described_types(const Registry& registry, const std::string& name) {
  const std::vector<Json> entries = all_entries(registry);
  Json found = Json::array();
  for (const Json& entry : entries) {
    if (entry["name"] != name) continue;
    found.push_back(entry);
    add_channels(found.back(), registry);
  }
  if (found.empty()) unknown(entries, name, registry);
  return found;
}

}  // namespace freeplay
