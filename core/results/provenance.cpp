#include "results/provenance.h"

#include <sys/utsname.h>

#include "base/input_text.h"
#include "base/sha256.h"
#include "base/version.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

std::string platform() {
  utsname system{};
  return ::uname(&system) == 0 ? std::string(system.sysname) + " " + system.machine : std::string("unknown");
}

Json plugins(const Model& model) {
  Json list = Json::array();
  for (const RegisteredLibrary& library : model.instances.libraries()) {
    if (library.path == "built-in") continue;
    std::string bytes;
    const bool readable = read_input(library.path, bytes).empty();
    list.push_back({{"name", library.table->name()},
                    {"version", library.table->version()},
                    {"file", library.path},
                    {"sha256", readable ? Json(sha256(bytes)) : Json(nullptr)}});
  }
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
          {"made", making.made},
          {"command", making.command},
          {"arguments", making.arguments},
          {"model", {{"name", model.name}, {"sha256", sha256(model.text)}}},
          {"inputs", std::move(inputs)},
          {"plugins", plugins(model)},
          {"seed", nullptr},
          {"hashes", nullptr},
          {"data_sha256", nullptr}};
}

}  // namespace freeplay
