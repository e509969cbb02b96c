#include "urdf/document.h"

#include <string_view>

#include <fmt/format.h>

#include "urdf/element.h"
#include "urdf/names.h"
#include "urdf/reader.h"
#include "urdf/robot_sections.h"
#include "urdf/tree.h"

namespace freeplay::urdf {
namespace {

/// URDF asks for limits of every slide: those that say none are as large as this [m, rad, N or N m].
constexpr double no_limit = 1000.0;
bool limits_anything(const Limits& limits) {
  return limits.lower > -no_limit || limits.upper < no_limit || limits.effort < no_limit;
}

std::optional<Sections> read_sections(XmlElement& root, const Options& options, Nodes& nodes, Messages& messages) {
  if (std::string_view(root.Name()) != "robot") {
    messages.error(name_spot(root), "bad-urdf", fmt::format("the root element must be 'robot', not '{}'", root.Name()));
    return std::nullopt;
  }
  UrdfdomModel model(root);
  Robot robot = read_robot(root, model, messages);
  build_tree(robot, options, messages);
  for (const Joint& joint : robot.joints) {
    if (joint.limits && limits_anything(*joint.limits) && !options.stops)
      messages.ignore("limits of joint", joint.name);
  }
  Names names(robot, messages);
  if (!messages.failed()) model.report_refusal(messages);
  return robot_sections(robot, names, options, nodes, messages);
}

}  // namespace

std::optional<Sections> add_sections(const std::string& text, const std::string* file_name, const Options& options,
                                     Document& document, Diagnostics& diagnostics) {
  const auto xml = parse_xml(text, *file_name, "bad-urdf", diagnostics);
  return xml ? add_sections(*xml, file_name, options, document, diagnostics) : std::nullopt;
}

std::optional<Sections> add_sections(XmlDocument& xml, const std::string* file_name, const Options& options,
                                     Document& document, Diagnostics& diagnostics) {
  Messages messages(*file_name, diagnostics);
  Nodes nodes(document, file_name);
  std::optional<Sections> sections = read_sections(xml.root(), options, nodes, messages);
  messages.report_ignored(name_spot(xml.root()));
  return sections;
}

}  // namespace freeplay::urdf
