#include "load/robot_file.h"

#include <string_view>

#include "mjcf/document.h"

namespace freeplay {

std::optional<urdf::Sections> add_robot_sections(const std::string& text, const std::string* file_name,
                                                 const urdf::Options& options, Document& document,
                                                 Diagnostics& diagnostics) {
  // Of a file that is not well-formed the first tag that is there says what it was to be.
  const char* id = text.find("<mujoco") == std::string::npos ? "bad-urdf" : "bad-mjcf";
  const auto xml = parse_xml(text, *file_name, id, diagnostics);
  if (!xml) return std::nullopt;
  const bool is_mjcf = std::string_view(xml->root().Name()) == "mujoco";
  return is_mjcf ? mjcf::add_sections(*xml, file_name, options, document, diagnostics)
                 : urdf::add_sections(*xml, file_name, options, document, diagnostics);
}

}  // namespace freeplay
