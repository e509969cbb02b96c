#include "cli/describe_command.h"

#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "base/suggestion.h"
#include "cli/component_entry.h"
#include "cli/plugins.h"
#include "cli/terminal.h"
#include "cli/text_table.h"
#include "component/instances.h"
#include "contract/sample_parameters.h"
#include "model/model.h"
#include "run/channel.h"

namespace freeplay {
namespace {

std::vector<RegisteredComponent> named(const Registry& registry, const std::string& name) {
  std::vector<RegisteredComponent> found;
  for (const RegisteredComponent& entry : registry.components()) {
    if (entry.component->description.name == name) found.push_back(entry);
  }
  return found;
}

[[noreturn]] void unknown(const Registry& registry, const std::string& name) {
  std::vector<std::string> names;
  for (const RegisteredComponent& entry : registry.components()) names.push_back(entry.component->description.name);
  const auto nearest = suggestion(name, names);
  throw Error(Error::Category::usage, "unknown-name", fmt::format("there is no type '{}'", name), {},
              nearest ? fmt::format("did you mean '{}'?", *nearest) : "`freeplay list` shows all");
}

/// A heading and its text; nothing if there is no text.
std::string section(const char* heading, const char* text) {
  return *text == '\0' ? std::string() : fmt::format("\n{}\n  {}\n", heading, text);
}

std::string parameters_text(const Description& description, const Registry& registry) {
  if (description.parameters.empty()) return "";
  TextTable table;
  table.add_row({"name", "unit", "default", "range", "meaning"});
  for (const Parameter& parameter : description.parameters) {
    const ParameterText text = parameter_text(parameter, registry);
    table.add_row({parameter.name, parameter.unit, text.default_value, text.range, parameter.summary});
  }
  return "\nparameters\n" + table.text("  ");
}

/// The result columns of a joint called NAME. What it declares may depend on its parameters: those of the first sample
/// that its constructor accepts count.
std::vector<ChannelInfo> channels_of(const RegisteredComponent& entry, const Registry& registry) {
  if (entry.component->kind != ComponentKind::joint) return {};
  const ParameterSamples samples = sample_parameters(*entry.component, registry);
  if (samples.accepted.empty()) return {};
  Instances instances;
  CreationFault fault;
  Message message;
  Model model;
  JointElement& joint = model.joints.emplace_back();
  joint.name = "NAME";
  joint.joint = instances.create_joint(*samples.accepted.front().block, fault);
  joint.layout.space = entry.component->description.space == Space::spatial ? Space::spatial : Space::planar;
  if (!joint.joint.declare(joint.layout, message)) return {};
  const Channels all(model);
  std::vector<ChannelInfo> channels(all.all().begin(), all.all().end());
  std::erase_if(channels, [](const ChannelInfo& channel) { return !channel.name.starts_with("joint.NAME."); });
  return channels;
}

std::string channels_text(const std::vector<ChannelInfo>& channels) {
  if (channels.empty()) return "";
  TextTable table;
  for (const ChannelInfo& channel : channels) table.add_row({channel.name, channel.unit});
  return "\nchannels\n" + table.text("  ");
}

std::string component_text(const RegisteredComponent& entry, const Registry& registry) {
  const Description& description = entry.component->description;
  std::string text = fmt::format("{}: {}\n", description.name, description.summary);
  TextTable facts;
  facts.add_row({"kind", kind_word(entry.component->kind)});
  facts.add_row({"space", space_word(description.space)});
  facts.add_row({"source", entry.library});
  text += facts.text("  ") + parameters_text(description, registry) + channels_text(channels_of(entry, registry));
  text += section("formula", description.formula) + section("validity", description.validity);
  return text + section("references", description.references);
}

int describe(const std::string& name, const CommonOptions& common) {
  if (name.empty()) throw Error(Error::Category::usage, "missing-argument", "describe needs the name of a type");
  const Registry registry = load_registry(common, nullptr);
  // Names are unique within a kind only.
  const std::vector<RegisteredComponent> found = named(registry, name);
  if (found.empty()) unknown(registry, name);
  if (common.json) {
    Json list = Json::array();
    for (const RegisteredComponent& entry : found) {
      Json& object = list.emplace_back(component_json(entry));
      object["channels"] = Json::array();
      for (const ChannelInfo& channel : channels_of(entry, registry)) {
        object["channels"].push_back({{"name", channel.name}, {"unit", channel.unit}});
      }
    }
    print_json(list.size() == 1 ? list.front() : list);
    return 0;
  }
  std::string text;
  for (const RegisteredComponent& entry : found) text += (text.empty() ? "" : "\n") + component_text(entry, registry);
  print(text);
  return 0;
}

}  // namespace

Command add_describe_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = program.add_subcommand("describe", "Describe a joint, law or integrator");
  const auto name = std::make_shared<std::string>();
  app->add_option("NAME", *name, "Name of a type, as `freeplay list` shows it")->type_name("");
  add_common_options(*app, common);
  return {app, [name, &common] { return describe(*name, common); }};
}

}  // namespace freeplay
