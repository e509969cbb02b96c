// Registry: the types that a model file may name, from the tables of all loaded libraries.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "component/plugin_table.h"
#include "freeplay/plugin.h"

namespace freeplay {

/// A type and the library it comes from.
struct RegisteredComponent {
  const Component* component;
  std::string library;  ///< "built-in" or the path of the shared object
};

/// A library that has been asked for its types.
struct RegisteredLibrary {
  std::string path;  ///< "built-in" or the path of the shared object
  std::shared_ptr<const PluginTable> table;
};

/// All known types in order of registration. Names are unique within a kind.
class Registry {
 public:
  /// The types built into the program, published through the same table that a shared library fills.
  static Registry with_builtins();

  /// Asks `entry` for its table and registers what it holds. Throws Error{plugin}: "plugin-refused" when host and
  /// library do not agree, "plugin-clash" when a name is taken.
  void add(PluginEntry entry, const std::string& library);

  const std::vector<RegisteredComponent>& components() const { return components_; }
  const std::vector<RegisteredLibrary>& libraries() const { return libraries_; }
  /// Null when there is no such type.
  const Component* find(ComponentKind kind, std::string_view name) const;
  /// What a type needs that a library could bring but does not; null when none speaks of it.
  const char* remedy(ComponentKind kind, std::string_view name) const;
  /// The type used where a model names none; null when the kind has none. `use`: as Description::preferred.
  const Component* preferred(ComponentKind kind, std::uint32_t use = 1) const;
  /// The joint type with play that stands for a joint of type `ideal` with the key `block`; null without one.
  const Component* twin(std::string_view ideal, std::string_view block) const;
  std::vector<std::string> names(ComponentKind kind) const;

 private:
  std::vector<RegisteredComponent> components_;
  std::vector<RegisteredLibrary> libraries_;
};

}  // namespace freeplay
