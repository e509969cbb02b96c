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

}  // namespace

Registry Registry::with_builtins() {
  Registry registry;
  for (const PluginEntry entry : builtin_plugins()) registry.add(entry, "built-in");
  return registry;
}

void Registry::add(PluginEntry entry, const std::string& library) {
  auto table = std::make_shared<const PluginTable>(entry, library);
  // All or nothing: a library that is refused leaves no trace.
  std::vector<RegisteredComponent> all = components_;
  for (const Component& row : table->components()) {
    for (const RegisteredComponent& other : all) {
      if (other.component->kind != row.kind || !same(other.component->description.name, row.description.name)) continue;
      throw Error(Error::Category::plugin, "plugin-clash",
                  "plugin '" + library + "' brings the " + kind_word(row.kind) + " '" + row.description.name +
                      "', which '" + other.library + "' has already");
    }
    all.push_back({&row, library});
  }
  components_ = std::move(all);
  libraries_.push_back({library, std::move(table)});
}

const Component* Registry::find(ComponentKind kind, std::string_view name) const {
  for (const RegisteredComponent& entry : components_) {
    if (entry.component->kind == kind && entry.component->description.name == name) return entry.component;
  }
  return nullptr;
}

const Component* Registry::preferred(ComponentKind kind, std::uint32_t use) const {
  for (const RegisteredComponent& entry : components_) {
    if (entry.component->kind == kind && entry.component->description.preferred == use) return entry.component;
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
