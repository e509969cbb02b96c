// Plugin libraries: finding them, opening them, and adding their types to a registry.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "component/registry.h"

namespace freeplay {

/// Folders that are searched for plugins by name, in order: those of FREEPLAY_PLUGIN_PATH (colon-separated), then
/// `lib/freeplay` of the installation that the running program belongs to.
std::vector<std::filesystem::path> plugin_folders();

/// The file that `word` means: a path if it holds a '/' or ends in ".so" (relative ones from `base`), else libWORD.so
/// or WORD.so in one of the folders. Throws Error{plugin} "plugin-not-found", which says where it was sought.
std::filesystem::path find_plugin(const std::string& word, const std::filesystem::path& base);

/// Opens a library (all symbols at once, none shared with others, never closed) and finds its entry point.
/// Throws Error{plugin} "plugin-refused".
PluginEntry open_plugin(const std::filesystem::path& file);

/// Opens a library and registers its types. A file that is there already is left alone.
/// Throws Error{plugin}: "plugin-not-found", "plugin-refused", "plugin-clash".
void load_plugin(Registry& registry, const std::filesystem::path& file);

/// Loads every *.so of plugin_folders() in order of name. A library that is refused is skipped; the reasons are
/// returned.
std::vector<std::string> load_plugin_folders(Registry& registry);

/// Folder of the running program.
std::filesystem::path program_folder();

}  // namespace freeplay
