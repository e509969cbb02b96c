#include "cli/schema_command.h"

#include <memory>

#include "cli/loading.h"
#include "cli/terminal.h"
#include "component/json_schema.h"
#include "contract/sample_layout.h"
#include "load/plugins.h"

namespace freeplay {
namespace {

int schema(const std::string& of, const CommonOptions& common) {
  require_word("schema", of, {"model", "summary", "study"});
  if (of == "summary") {
    print_json(summary_schema());
    return 0;
  }
  const Registry registry = load_registry(loading(common), nullptr);
  const Json model = model_schema(registry, force_types(registry));
  print_json(of == "study" ? study_schema(model) : model);
  return 0;
}

}  // namespace

Command add_schema_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app =
      add_command(program, "schema", "Print the JSON Schema of the model file, of a study file or of summary.json");
  const auto of = std::make_shared<std::string>("model");
  add_option(*app, "KIND", *of, "model (the default), study or summary");
  add_common_options(*app, common);
  return {app, [of, &common] { return schema(*of, common); }};
}

}  // namespace freeplay
