#include "component/registry.h"

#include <algorithm>
#include <span>
#include <string_view>

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

// Words that the model file has of its own where a joint type may stand.
constexpr std::string_view words_of_the_format[] = {"gear", "force", "torque", "gravity"};

// Keys that every joint's entry has.
constexpr std::string_view keys_of_a_joint[] = {"type", "between", "use"};

bool among(const char* word, std::span<const std::string_view> words) {
  return word != nullptr && std::ranges::find(words, std::string_view(word)) != words.end();
}

bool names_key(const Description& type, std::string_view key) {
  const auto begins_with = [&](const Parameter& p) {
    const std::string_view name = p.name;
    return name.substr(0, name.find('.')) == key;
  };
  return std::ranges::any_of(type.parameters, begins_with) || same(type.first_end, key) || same(type.second_end, key);
}

/// What a joint type says of itself that would take a word from the format or from another type; "" if nothing.
std::string claim_fault(const Description& type, std::span<const RegisteredComponent> others) {
  if (among(type.name, words_of_the_format)) return "has a name that the model file has a meaning for";
  if ((type.first_end == nullptr) != (type.second_end == nullptr)) return "names one of its ends only";
  for (const std::string_view key : keys_of_a_joint) {
    if (names_key(type, key)) return "takes the key '" + std::string(key) + "', which every joint has";
  }
  if ((type.ideal == nullptr) != (type.block == nullptr)) return "must name its ideal type and its block together";
  if (type.ideal == nullptr) return "";
  const std::string claim = "says that a '" + std::string(type.ideal) + "' with the key '" + type.block + "' is of it";
  if (same(type.ideal, type.name)) return claim + ", which is the type itself";
  if (among(type.block, keys_of_a_joint)) return claim + ", a key that every joint has";
  for (const RegisteredComponent& other : others) {
    const Description& theirs = other.component->description;
    if (other.component->kind != ComponentKind::joint) continue;
    if (same(theirs.name, type.ideal) && names_key(theirs, type.block)) {
      return claim + ", a key that '" + other.library + "' has there already";
    }
    if (same(theirs.ideal, type.ideal) && same(theirs.block, type.block)) {
      return claim + ", as '" + other.library + "' says of '" + theirs.name + "' already";
    }
  }
  return "";
}

}  // namespace

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
    const std::string fault = row.kind == ComponentKind::joint ? claim_fault(row.description, all) : "";
    if (!fault.empty()) {
      throw Error(Error::Category::plugin, "plugin-clash",
                  "plugin '" + library + "': the joint '" + row.description.name + "' " + fault);
    }
    all.push_back({&row, library});
  }
  components_ = std::move(all);
  libraries_.push_back({library, std::move(table)});
}

Registry Registry::with_builtins() {
  Registry registry;
  for (const PluginEntry entry : builtin_plugins()) registry.add(entry, "built-in");
  return registry;
}

const Component* Registry::find(ComponentKind kind, std::string_view name) const {
  for (const RegisteredComponent& entry : components_) {
    if (entry.component->kind == kind && entry.component->description.name == name) return entry.component;
  }
  return nullptr;
}

const char* Registry::remedy(ComponentKind kind, std::string_view name) const {
  if (find(kind, name) != nullptr) return nullptr;  // another library brings it
  for (const RegisteredLibrary& library : libraries_) {
    for (const Component& row : library.table->missing()) {
      if (row.kind == kind && row.description.name == name) return row.description.missing;
    }
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
