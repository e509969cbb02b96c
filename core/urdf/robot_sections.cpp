#include "urdf/robot_sections.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/index.h"
#include "urdf/inertia.h"
#include "urdf/mimic.h"
#include "urdf/sections.h"
#include "urdf/tree.h"

namespace freeplay::urdf {
namespace {

const char* type_word(JointType type) {
  constexpr const char* words[] = {"revolute",  "prismatic", "fixed",       "floating", "planar",
                                   "spherical", "universal", "cylindrical", "screw"};
  return words[static_cast<int>(type)];
}

/// The plane that was asked for, or the first in which the robot is planar, or the one that comes nearest.
PlanarRobot choose_plane(const Robot& robot, const Options& options) {
  if (options.plane) return project(robot, *options.plane);
  const auto faults = [](const PlanarRobot& seen) {
    return std::ranges::count_if(seen.joints, [](const PlanarJoint& joint) { return !joint.fault.empty(); });
  };
  PlanarRobot best = project(robot, Options::Plane::xy);
  for (const Options::Plane plane : {Options::Plane::xz, Options::Plane::yz}) {
    if (best.planar()) break;
    PlanarRobot next = project(robot, plane);
    if (faults(next) < faults(best)) best = std::move(next);
  }
  return best;
}

void report_snapping(const Robot& robot, const PlanarRobot& planar, Messages& messages) {
  constexpr double rounding = 1e-12;
  const auto worst = std::ranges::max_element(planar.joints, {}, &PlanarJoint::residual);
  if (worst != planar.joints.end() && worst->residual > rounding) {
    const Joint& joint = robot.joints[static_cast<std::size_t>(worst - planar.joints.begin())];
    messages.warning(
        worst->spot, "urdf-ignored",
        fmt::format("joints are snapped to the plane {}; the largest residual is {:.3g} rad, of joint '{}'",
                    plane_word(planar.plane), worst->residual, joint.name));
  }
  for (const std::string& name : planar.tilted_frames) messages.ignore("tilt of the frame", name);
}

void report_default_axes(const Robot& robot, Messages& messages) {
  for (const Joint& joint : robot.joints) {
    if (!joint.has_axis() || joint.axis_given) continue;
    messages.warning(joint.element, "missing-key", fmt::format("joint '{}' has no axis; URDF takes 1 0 0", joint.name));
  }
}

/// Has it parts that nothing keeps in a plane, whatever their axes?
bool moves_freely(const Robot& robot, const Options& options) {
  if (options.floating_base && robot.mounts[at(robot.root)].body == robot.root) return true;
  return std::ranges::any_of(robot.joints, [](const Joint& joint) {
    // A point that is held closes a loop in the plane, too; in a tree it lets its body leave the plane.
    const bool loose = joint.type == JointType::floating || joint.type == JointType::planar || joint.is_spatial();
    return loose && !joint.closes_loop;
  });
}

void report_spatial_joints(const Robot& robot, Messages& messages) {
  for (const Joint& joint : robot.joints) {
    const bool point = joint.closes_loop && joint.type == JointType::spherical;
    if (joint.type != JointType::planar && (!joint.is_spatial() || point)) continue;
    messages.error(joint.type_spot, "type-space",
                   fmt::format("the type '{}' of joint '{}' is for spatial models", type_word(joint.type), joint.name),
                   {}, "'space: spatial' in a side-car reads the robot in space");
  }
}

/// In a plane only what lies in it is left; null where the file says no gravity.
const Node* gravity_node(const Robot& robot, const std::optional<Options::Plane>& plane, Nodes& nodes) {
  if (!robot.gravity) return nullptr;
  const Eigen::Vector3d& g = *robot.gravity;
  if (!plane) return &nodes.numbers({g[0], g[1], g[2]}, robot.gravity_spot);
  const Eigen::Vector3d seen = plane_axes(*plane) * g;
  return &nodes.numbers({seen[0] + 0.0, seen[1] + 0.0}, robot.gravity_spot);
}

std::optional<Sections> write_spatial(Robot& robot, Names& names, const Options& options, Nodes& nodes,
                                      Messages& messages) {
  check_inertia(robot, options, false, {}, messages);
  if (messages.failed()) return std::nullopt;
  report_default_axes(robot, messages);
  const auto view = spatial_view(robot, nodes);
  Sections sections = write_sections(robot, *view, {}, names, options, nodes, messages);
  if (messages.failed()) return std::nullopt;
  sections.gravity = gravity_node(robot, {}, nodes);
  return sections;
}

}  // namespace

std::optional<Sections> robot_sections(Robot& robot, Names& names, const Options& options, Nodes& nodes,
                                       Messages& messages) {
  if (robot.mounts.empty()) return std::nullopt;
  if (options.space == Options::Space::spatial) return write_spatial(robot, names, options, nodes, messages);
  // What could not be read has been replaced by a guess, which says nothing about the plane.
  if (!robot.places_known && !options.plane) return std::nullopt;
  const PlanarRobot planar = choose_plane(robot, options);
  const bool fits = planar.planar() || !robot.places_known;
  if (options.space == Options::Space::by_robot && robot.places_known && (!fits || moves_freely(robot, options))) {
    return write_spatial(robot, names, options, nodes, messages);
  }
  report_spatial_joints(robot, messages);
  robot.mounts = planar.mounts;
  const Eigen::Vector3d normal = plane_axes(planar.plane).row(2);
  check_inertia(robot, options, fits, normal, messages);
  if (!fits) report_not_planar(robot, planar, messages);
  if (messages.failed()) return std::nullopt;
  report_default_axes(robot, messages);
  report_snapping(robot, planar, messages);
  const auto view = planar_view(robot, planar, nodes);
  Sections sections = write_sections(robot, *view, planar.plane, names, options, nodes, messages);
  if (messages.failed()) return std::nullopt;
  sections.gravity = gravity_node(robot, planar.plane, nodes);
  return sections;
}

std::optional<Sections> finish_robot(Robot& robot, const Options& options, Nodes& nodes, Messages& messages) {
  resolve_mimics(robot, messages);
  build_tree(robot, options, messages);
  for (const Joint& joint : robot.joints) {
    if (joint.limits && !options.stops) messages.ignore("limits of joint", joint.name);
  }
  Names names(robot, messages);
  return robot_sections(robot, names, options, nodes, messages);
}

}  // namespace freeplay::urdf
