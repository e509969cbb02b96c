// StarterFiles: what `freeplay init` writes, made from files that the program carries.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace freeplay {

struct StarterFile {
  std::filesystem::path path;
  std::string text;
};

/// Names of the mechanisms that a model may start from.
std::vector<std::string> starter_models();
/// Kinds of component that a plugin may start with: joint, contact, friction, integrator.
std::vector<std::string> starter_types();

/// A copy of the mechanism `from` that is called `name`.
std::string starter_model(const std::string& from, const std::string& name);

/// A project for a component of kind `type` called `name` (kebab-case): build file, source and example, below `folder`.
/// `prefix`: where the package of Freeplay lies; empty where CMake looks anyway.
std::vector<StarterFile> starter_plugin(const std::string& type, const std::string& name,
                                        const std::filesystem::path& folder, const std::filesystem::path& prefix);

/// The same name in the style of another thing: my-joint -> my_joint, MyJoint.
std::string snake_case(const std::string& kebab);
std::string camel_case(const std::string& kebab);

}  // namespace freeplay
