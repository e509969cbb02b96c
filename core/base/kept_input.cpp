#include "base/kept_input.h"

#include <filesystem>
#include <system_error>

namespace freeplay {

std::string kept_input(const std::string& model_file, const std::string& path, const std::string& kept_name) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (fs::exists(path, ignored)) return path;
  const fs::path folder = fs::path(model_file).parent_path(), copy = folder / "inputs" / kept_name;
  return fs::exists(folder / "summary.json", ignored) && fs::exists(copy, ignored) ? copy.string() : path;
}

}  // namespace freeplay
