#include "load/robot_file.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "mjcf/document.h"
#include "sdf/document.h"
#include "urdf/element.h"

namespace freeplay {
namespace {

std::optional<urdf::Sections> urdf_sections(XmlDocument& xml, const std::string* file_name,
                                            const urdf::Options& options, Document& document,
                                            Diagnostics& diagnostics) {
  return urdf::add_sections(xml, file_name, options, document, diagnostics);  // one of several of that name
}

}  // namespace

std::optional<urdf::Sections> add_robot_sections(const std::string& text, const std::string* file_name,
                                                 const urdf::Options& options, Document& document,
                                                 Diagnostics& diagnostics) {
  // Of a file that is not well-formed the first tag that is there says what it was to be.
  const std::size_t mjcf = text.find("<mujoco"), sdf = text.find("<sdf"), urdf = text.find("<robot");
  const std::size_t first = std::min({mjcf, sdf, urdf});
  const char* id = first == urdf ? "bad-urdf" : first == mjcf ? "bad-mjcf" : "bad-sdf";
  const auto xml = parse_xml(text, *file_name, id, diagnostics);
  if (!xml) return std::nullopt;
  const std::string root = xml->root().Name();
  const std::vector<std::string> roots{"robot", "mujoco", "sdf"};
  if (std::ranges::find(roots, root) == roots.end()) {
    urdf::Messages messages(*file_name, diagnostics);
    messages.error(urdf::name_spot(xml->root()), "bad-urdf",
                   fmt::format("the root element must be 'robot', 'mujoco' or 'sdf', not '{}'", root),
                   messages.suggest(root, roots));
    return std::nullopt;
  }
  const auto read = root == "mujoco" ? mjcf::add_sections : root == "sdf" ? sdf::add_sections : urdf_sections;
  return read(*xml, file_name, options, document, diagnostics);
}

}  // namespace freeplay
