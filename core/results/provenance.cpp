#include "results/provenance.h"

#include <algorithm>
#include <map>
#include <set>

#include <sys/utsname.h>

#include "base/arithmetic.h"
#include "base/sha256.h"
#include "base/version.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

std::string platform() {
  utsname system{};
  return ::uname(&system) == 0 ? std::string(system.sysname) + " " + system.machine : std::string("unknown");
}

void add_types(const ParameterBlock& block, std::set<const Component*>& types) {
  types.insert(block.component);
  for (const auto& [name, value] : block.values) {
    if (value.law != nullptr) add_types(*value.law, types);
  }
}

/// All that the model is made of: joints, their laws and twins, the integrator.
std::set<const Component*> types_of(const Model& model) {
  std::set<const Component*> types;
  for (const JointElement& joint : model.joints) {
    types.insert({joint.component, joint.ideal_component()});
    if (joint.parameters != nullptr) add_types(*joint.parameters, types);
  }
  add_types(model.settings.integrator_parameters, types);
  return types;
}

/// Libraries that a type of the model comes from; others may lie in the folders for plugins.
Json plugins(const Model& model) {
  const std::set<const Component*> types = types_of(model);
  std::map<std::string, Json> by_name;
  for (const RegisteredLibrary& library : model.instances.libraries()) {
    const auto& rows = library.table->components();
    const auto is_used = [&](const Component& row) { return types.contains(&row); };
    if (library.path == "built-in" || std::ranges::none_of(rows, is_used)) continue;
    const std::string digits = sha256_of_file(library.path);
    by_name[library.table->name() + "\n" + library.path] = {{"name", library.table->name()},
                                                            {"version", library.table->version()},
                                                            {"file", library.path},
                                                            {"sha256", digits.empty() ? Json(nullptr) : Json(digits)}};
  }
  Json list = Json::array();
  for (const auto& [place, record] : by_name) list.push_back(record);
  return list;
}

}  // namespace

Json provenance(const Model& model, const Making& making) {
  Json inputs = Json::array();
  for (const InputFile& input : model.inputs) inputs.push_back({{"name", input.name}, {"sha256", sha256(input.text)}});
  return {{"freeplay", program_version},
          {"schema", schema_version},
          {"build", making.build},
          {"compiler", compiler},
          {"plugin_abi", abi_version},
          {"platform", platform()},
          {"arithmetic", arithmetic_fingerprint()},
          {"made", making.made},
          {"command", making.command},
          {"arguments", making.arguments},
          {"model", {{"name", model.name}, {"sha256", sha256(model.text)}}},
          {"inputs", std::move(inputs)},
          {"plugins", plugins(model)},
          {"seed", making.seed},
          {"hashes", nullptr},
          {"data_sha256", nullptr}};
}

Json provenance_with_texts(const Model& model, const Making& making) {
  Json record = provenance(model, making);
  record["model"]["text"] = model.text;
  for (std::size_t i = 0; i < model.inputs.size(); ++i) record["inputs"][i]["text"] = model.inputs[i].text;
  return record;
}

}  // namespace freeplay
