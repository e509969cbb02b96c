#include "cli/describe_command.h"

#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "cli/loading.h"
#include "cli/terminal.h"
#include "cli/text_table.h"
#include "contract/component_entry.h"
#include "contract/type_list.h"
#include "load/plugins.h"

namespace freeplay {
namespace {

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
  const Json found = described_types(load_registry(loading(common), nullptr), name);
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
