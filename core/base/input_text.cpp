#include "base/input_text.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace freeplay {

std::string read_input(const std::string& file_name, std::string& text) {
  std::error_code ignored;
  const auto status = std::filesystem::status(file_name, ignored);
  if (!std::filesystem::exists(status)) return "there is no such file";
  if (std::filesystem::is_directory(status)) return "it is a directory";
  if (!std::filesystem::is_regular_file(status)) return "it is not a regular file";
  std::ifstream stream(file_name, std::ios::binary);
  if (!stream) return "it cannot be opened";
  // Zeros for all that could come would cost a small file more than its reading.
  const auto size = std::filesystem::file_size(file_name, ignored);
  text.assign(ignored ? largest_input + 1 : std::min<std::uintmax_t>(size, largest_input) + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) return "reading it failed";
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return {};
}

}  // namespace freeplay
