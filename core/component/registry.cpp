#include "component/registry.h"

#include "base/error.h"
#include "component/builtin_plugins.h"

namespace freeplay {
namespace {

const char* kind_word(ComponentKind kind) {
  switch (kind) {
    case ComponentKind::joint:
      return "joint";
    case ComponentKind::contact_law:
      return "contact law";
    case ComponentKind::friction_law:
      return "friction law";
    case ComponentKind::integrator:
      break;
  }
  return "integrator";
}

bool same(const char* a, std::string_view b) { return a != nullptr && b == a; }

[[noreturn]] void refuse(const std::string& library, const std::string& why) {
  throw Error(Error::Category::plugin, "plugin-refused", "plugin '" + library + "' " + why);
}

Manifest ask(PluginEntry entry, const std::string& library) {
  const Host host{sizeof(Host), abi_version, abi_fingerprint};
  Manifest manifest{};
  const Status status = entry(&host, &manifest);
  if (manifest.abi_version != abi_version) {
    refuse(library, "speaks plugin ABI " + std::to_string(manifest.abi_version) + ", this program " +
                        std::to_string(abi_version));
  }
  if (status != Status::ok) refuse(library, "refuses this program");
  if (!same(manifest.fingerprint, abi_fingerprint)) refuse(library, "was built for another kind of machine");
  // Strides that differ would need a copy of every row; there is one layout so far.
  if (manifest.size < sizeof(Manifest) || manifest.component_size != sizeof(Component) ||
      manifest.parameter_size != sizeof(Parameter)) {
    refuse(library, "lays out its tables differently");
  }
  return manifest;
}

void check_row(const Component& row, const std::string& library) {
  if (row.table == nullptr || row.create == nullptr || row.description.name == nullptr) {
    refuse(library, "publishes an incomplete component");
  }
  for (const Parameter& parameter : row.description.parameters) {
    if (parameter.name == nullptr || parameter.unit == nullptr) {
      refuse(library, std::string("publishes a parameter of '") + row.description.name + "' without name or unit");
    }
  }
}

}  // namespace

Registry Registry::with_builtins() {
  Registry registry;
  for (const PluginEntry entry : builtin_plugins()) registry.add(entry, "built-in");
  return registry;
}

void Registry::add(PluginEntry entry, const std::string& library) {
  const Manifest manifest = ask(entry, library);
  // All or nothing: a library that is refused leaves no trace.
  std::vector<RegisteredComponent> all = components_;
  for (const Component& row : manifest.components) {
    check_row(row, library);
    for (const RegisteredComponent& other : all) {
      if (other.component->kind != row.kind || !same(other.component->description.name, row.description.name)) continue;
      throw Error(Error::Category::plugin, "plugin-clash",
                  "plugin '" + library + "' brings the " + kind_word(row.kind) + " '" + row.description.name +
                      "', which '" + other.library + "' has already");
    }
    all.push_back({&row, library});
  }
  components_ = std::move(all);
}

const Component* Registry::find(ComponentKind kind, std::string_view name) const {
  for (const RegisteredComponent& entry : components_) {
    if (entry.component->kind == kind && entry.component->description.name == name) return entry.component;
  }
  return nullptr;
}

const Component* Registry::preferred(ComponentKind kind) const {
  for (const RegisteredComponent& entry : components_) {
    if (entry.component->kind == kind && entry.component->description.preferred != 0) return entry.component;
  }
  return nullptr;
}

const Component* Registry::twin(std::string_view ideal, std::string_view block) const {
  for (const RegisteredComponent& entry : components_) {
    const Description& description = entry.component->description;
    if (entry.component->kind == ComponentKind::joint && same(description.ideal, ideal) &&
        same(description.block, block)) {
      return entry.component;
    }
  }
  return nullptr;
}

std::vector<std::string> Registry::names(ComponentKind kind) const {
  std::vector<std::string> names;
  for (const RegisteredComponent& entry : components_) {
    if (entry.component->kind == kind) names.emplace_back(entry.component->description.name);
  }
  return names;
}

}  // namespace freeplay
