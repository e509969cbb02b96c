#include "mjcf/document.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "mjcf/equality.h"
#include "mjcf/inertia.h"
#include "mjcf/world.h"
#include "urdf/robot_sections.h"

namespace freeplay::mjcf {
namespace {

/// Sections that are read, or say nothing about the motion.
const std::vector<std::string> known_sections{"compiler", "option", "default", "worldbody", "equality",
                                              "size",     "visual", "asset",   "statistic", "custom"};
/// Sections of parts that would move or hold the mechanism, or look at it.
const std::vector<std::string> other_sections{"actuator", "tendon",   "contact",   "deformable",
                                              "sensor",   "keyframe", "extension", "skin"};

void note_sections(XmlElement& root, Messages& messages) {
  for (XmlElement& section : XmlChildren(root)) {
    const std::string name = section.Name();
    if (refuse_unexpanded(section, messages)) continue;
    if (std::ranges::find(known_sections, name) != known_sections.end()) continue;
    if (std::ranges::find(other_sections, name) == other_sections.end()) {
      const std::string meant = urdf::misspelt(name, known_sections);
      if (meant.empty()) {
        messages.ignore(name);
      } else {
        messages.error(name_spot(section), "bad-urdf", fmt::format("unknown element '{}' in mujoco", name), meant);
      }
      continue;
    }
    for (const XmlElement& part : XmlChildren(section)) {
      if (refuse_unexpanded(part, messages)) continue;
      const char* own = part.Attribute("name");
      messages.ignore(fmt::format("{} of '{}'", part.Name(), name), own == nullptr ? "" : own);
    }
  }
  if (!text_of(root).empty()) messages.error(urdf::text_spot(root), "bad-urdf", "unexpected text in mujoco");
}

std::optional<urdf::Sections> read_sections(XmlElement& root, const urdf::Options& options, urdf::Nodes& nodes,
                                            Messages& messages) {
  note_sections(root, messages);
  const Settings settings = read_settings(root, messages);
  const Defaults defaults(root, messages);
  World world = read_world(root, settings, defaults, messages);
  read_equalities(root, world, settings, defaults, messages);
  scale_masses(settings, world.robot);
  world.robot.places_known = !messages.failed();
  world.robot.gravity = settings.gravity;
  world.robot.gravity_spot = settings.gravity_spot;
  return finish_robot(world.robot, options, nodes, messages);
}

}  // namespace

std::optional<urdf::Sections> add_sections(XmlDocument& xml, const std::string* file_name, const urdf::Options& options,
                                           Document& document, Diagnostics& diagnostics) {
  Messages messages(*file_name, diagnostics, "mjcf");
  urdf::Nodes nodes(document, file_name);
  auto sections = read_sections(xml.root(), options, nodes, messages);
  messages.report_ignored(name_spot(xml.root()));
  return sections;
}

}  // namespace freeplay::mjcf
