#include "cli/describe_command.h"

#include <memory>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "base/suggestion.h"
#include "cli/component_entry.h"
#include "cli/loading.h"
#include "cli/terminal.h"
#include "cli/text_table.h"
#include "contract/sample_layout.h"
#include "load/plugins.h"
#include "model/channel.h"
#include "model/model.h"

namespace freeplay {
namespace {

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

/// A heading and its text; nothing if there is no text.
std::string section(const char* heading, const std::string& text) {
  return text.empty() ? "" : fmt::format("\n{}\n  {}\n", heading, text);
}

std::string parameters_text(const Json& parameters) {
  if (parameters.empty()) return "";
  TextTable table;
  table.add_row({"name", "unit", "default", "range", "meaning"});
  for (const Json& parameter : parameters) {
    table.add_row(
        {parameter["name"], parameter["unit"], default_text(parameter), range_text(parameter), parameter["summary"]});
  }
  return "\nparameters\n" + table.text("  ");
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

std::string channels_text(const char* heading, const Json& channels) {
  if (channels.empty()) return "";
  TextTable table;
  for (const Json& channel : channels) table.add_row({channel["name"], channel["unit"]});
  return fmt::format("\n{}\n", heading) + table.text("  ");
}

std::string entry_text(const Json& entry) {
  std::string text = fmt::format("{}: {}\n", entry["name"].get<std::string>(), entry["summary"].get<std::string>());
  TextTable facts;
  for (const char* fact : {"kind", "space", "source"}) facts.add_row({fact, entry[fact]});
  text += facts.text("  ") + parameters_text(entry["parameters"]) + channels_text("channels", entry["channels"]);
  if (entry.contains("channels_in_space")) text += channels_text("channels in space", entry["channels_in_space"]);
  for (const char* part : {"formula", "validity", "references"}) text += section(part, entry[part]);
  return text;
}

int describe(const std::string& name, const CommonOptions& common) {
  if (name.empty()) throw Error(Error::Category::usage, "missing-argument", "describe needs the name of a type");
  const Registry registry = load_registry(loading(common), nullptr);
  const std::vector<Json> entries = all_entries(registry);
  Json found = Json::array();  // names are unique within a kind only
  for (const Json& entry : entries) {
    if (entry["name"] != name) continue;
    found.push_back(entry);
    add_channels(found.back(), registry);
  }
  if (found.empty()) unknown(entries, name, registry);
  if (common.json) {
    print_json(found.size() == 1 ? found.front() : found);
    return 0;
  }
  std::string text;
  for (const Json& entry : found) text += (text.empty() ? "" : "\n") + entry_text(entry);
  print(text);
  return 0;
}

}  // namespace

Command add_describe_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "describe", "Describe a joint, law or integrator");
  const auto name = std::make_shared<std::string>();
  add_option(*app, "NAME", *name, "Name of a type, as `freeplay list` shows it");
  add_common_options(*app, common);
  return {app, [name, &common] { return describe(*name, common); }};
}

}  // namespace freeplay
