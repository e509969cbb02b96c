#include "cli/list_command.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "cli/failure.h"
#include "cli/loading.h"
#include "cli/terminal.h"
#include "cli/text_table.h"
#include "contract/type_list.h"
#include "load/load.h"
#include "load/plugins.h"
#include "model/channel.h"

namespace freeplay {
namespace {

struct ListOptions {
  std::string kind, model;
};

int list_components(const ListOptions& options, const CommonOptions& common) {
  const Json list = type_entries(load_registry(loading(common), nullptr), options.kind);
  if (common.json) {
    print_json(list);
    return 0;
  }
  TextTable table;
  const std::vector<std::string> columns{"name", "kind", "space", "source", "summary"};
  table.add_row(columns);
  for (const Json& entry : list) {
    std::vector<std::string> cells;
    for (const std::string& column : columns) cells.push_back(entry[column].get<std::string>());
    table.add_row(std::move(cells));
  }
  print(table.text());
  return 0;
}

int list_channels(const ListOptions& options, const CommonOptions& common) {
  if (options.model.empty()) {
    throw Error(Error::Category::usage, "missing-argument", "list channels needs a model file");
  }
  const LoadedModel loaded = load_model(options.model, {}, loading(common));
  if (!loaded.model) return report_failure(loaded.diagnostics, loaded.exit_code, common);
  print_messages(loaded.diagnostics.format(common.max_errors), common.no_color);
  const Channels channels(*loaded.model);
  Json list = Json::array();
  TextTable table;
  for (const ChannelInfo& channel : channels.all()) {
    list.push_back({{"name", channel.name}, {"unit", channel.unit}});
    table.add_row({channel.name, std::string(channel.unit)});
  }
  if (common.json) {
    print_json(list);
  } else {
    print(table.text());
  }
  return 0;
}

int list(const ListOptions& options, const CommonOptions& common) {
  if (options.kind != "channels") require_listed(options.kind);
  if (options.kind == "channels") return list_channels(options, common);
  if (!options.model.empty()) {
    throw Error(Error::Category::usage, "unexpected-argument", fmt::format("unexpected argument '{}'", options.model));
  }
  return list_components(options, common);
}

}  // namespace

Command add_list_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "list", "List joints, laws, integrators, plugins, or the columns of a model");
  const auto options = std::make_shared<ListOptions>();
  add_option(*app, "KIND", options->kind, "joints, laws, forces, integrators, plugins or channels; all but channels");
  add_option(*app, "MODEL", options->model, "Model file, for channels");
  add_common_options(*app, common);
  return {app, [options, &common] { return list(*options, common); }};
}

}  // namespace freeplay
