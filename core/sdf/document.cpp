#include "sdf/document.h"

#include "sdf/scene.h"
#include "urdf/robot_sections.h"

namespace freeplay::sdf {

std::optional<urdf::Sections> add_sections(XmlDocument& xml, const std::string* file_name, const urdf::Options& options,
                                           Document& document, Diagnostics& diagnostics) {
  Messages messages(*file_name, diagnostics, "sdf");
  urdf::Nodes nodes(document, file_name);
  Scene scene(messages);
  read_scene(xml.root(), scene, messages);
  std::optional<urdf::Sections> sections;
  if (!scene.links.empty()) {
    scene.frames.resolve();
    urdf::Robot robot = robot_of(scene, messages);
    if (scene.touching > 1) messages.ignore("contact between collisions");
    if (!messages.failed()) sections = finish_robot(robot, options, nodes, messages);
  }
  messages.report_ignored(urdf::name_spot(xml.root()));
  return sections;
}

}  // namespace freeplay::sdf
