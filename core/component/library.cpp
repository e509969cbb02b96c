#include "component/library.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>

#include <dlfcn.h>
#include <elf.h>

#include "base/error.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

// The linker's own words, without the path that the message has already.
std::string linker_words(const fs::path& file) {
  const char* error = dlerror();
  std::string text = error ? error : "unknown reason";
  const std::string prefix = file.string() + ": ";
  if (text.starts_with(prefix)) text.erase(0, prefix.size());
  return text;
}

// Does a 64-bit ELF file end before what its headers promise? The linker would map it and die at the first touch.
bool is_cut_off(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  Elf64_Ehdr header{};
  if (error || !stream.read(reinterpret_cast<char*>(&header), sizeof header)) return false;
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_ident[EI_CLASS] != ELFCLASS64) return false;
  for (unsigned i = 0; i < header.e_phnum; ++i) {
    Elf64_Phdr segment{};
    stream.seekg(static_cast<std::streamoff>(header.e_phoff + i * sizeof segment));
    if (!stream.read(reinterpret_cast<char*>(&segment), sizeof segment)) return true;
    if (segment.p_type == PT_LOAD && segment.p_offset + segment.p_filesz > size) return true;
  }
  return false;
}

bool ends_in_so(std::string_view word) { return word.ends_with(".so"); }

}  // namespace

fs::path program_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : program.parent_path();
}

std::vector<fs::path> plugin_folders() {
  std::vector<fs::path> folders;
  if (const char* list = std::getenv("FREEPLAY_PLUGIN_PATH")) {
    std::string_view rest = list;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(':'), rest.size());
      if (end > 0) folders.emplace_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  if (const fs::path program = program_folder(); !program.empty()) {
    folders.push_back((program / ".." / "lib" / "freeplay").lexically_normal());
  }
  return folders;
}

fs::path find_plugin(const std::string& word, const fs::path& base) {
  std::error_code error;
  if (word.find('/') != std::string::npos || ends_in_so(word)) {
    fs::path file = fs::path(word).is_absolute() ? fs::path(word) : base / word;
    if (fs::is_regular_file(file, error)) return file;
    throw Error(Error::Category::plugin, "plugin-not-found", "there is no plugin '" + file.string() + "'");
  }
  std::string sought;
  for (const fs::path& folder : plugin_folders()) {
    for (const std::string& name : {"lib" + word + ".so", word + ".so"}) {
      if (fs::is_regular_file(folder / name, error)) return folder / name;
    }
    sought += (sought.empty() ? "" : ", ") + folder.string();
  }
  throw Error(Error::Category::plugin, "plugin-not-found", "there is no plugin '" + word + "' in " + sought, {},
              "give a path, or put its folder into FREEPLAY_PLUGIN_PATH");
}

PluginEntry open_plugin(const fs::path& file) {
  if (is_cut_off(file)) {
    throw Error(Error::Category::plugin, "plugin-refused",
                "plugin '" + file.string() + "' cannot be loaded: the file is cut off");
  }
  dlerror();
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) {
    throw Error(Error::Category::plugin, "plugin-refused",
                "plugin '" + file.string() + "' cannot be loaded: " + linker_words(file));
  }
  void* entry = dlsym(handle, "freeplay_plugin_v1");
  if (entry == nullptr) {
    throw Error(Error::Category::plugin, "plugin-refused",
                "plugin '" + file.string() + "' has no entry point freeplay_plugin_v1");
  }
  return reinterpret_cast<PluginEntry>(entry);
}

void load_plugin(Registry& registry, const fs::path& file) {
  std::error_code error;
  const fs::path real = fs::canonical(file, error);
  if (error) {
    throw Error(Error::Category::plugin, "plugin-not-found",
                "plugin '" + file.string() + "' cannot be opened: " + error.message());
  }
  for (const RegisteredLibrary& library : registry.libraries()) {
    if (library.path == real.string()) return;
  }
  if (!fs::is_regular_file(real, error)) {
    throw Error(Error::Category::plugin, "plugin-refused", "plugin '" + file.string() + "' is not a regular file");
  }
  registry.add(open_plugin(real), real.string());
}

std::vector<std::string> load_plugin_folders(Registry& registry) {
  std::vector<std::string> refused;
  for (const fs::path& folder : plugin_folders()) {
    std::error_code error;
    std::vector<fs::path> files;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      if (ends_in_so(it->path().filename().string())) files.push_back(it->path());
    }
    std::ranges::sort(files);
    for (const fs::path& file : files) {
      try {
        load_plugin(registry, file);
      } catch (const Error& e) {
        refused.push_back(e.message());
      }
    }
  }
  return refused;
}

}  // namespace freeplay
