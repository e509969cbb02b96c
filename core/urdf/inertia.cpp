#include "urdf/inertia.h"

#include <fmt/format.h>

namespace freeplay::urdf {
namespace {

std::string text(const Eigen::Vector3d& values) {
  return fmt::format("{:.6g}, {:.6g}, {:.6g}", values[0], values[1], values[2]);
}

/// Where a person looks: a negative moment, or the whole.
const Spot& blamed(const Link& link) {
  for (int i = 0; i < 3; ++i) {
    if (link.inertia(i, i) < 0.0) return link.moments[static_cast<std::size_t>(i)];
  }
  return link.inertia_spot;
}

/// Moment about the direction `normal` of the link frame.
double moment(const Link& link, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d n = link.inertial.linear().transpose() * normal;
  return n.dot(link.inertia * n);
}

const Spot& moment_spot(const Link& link, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d n = (link.inertial.linear().transpose() * normal).cwiseAbs();
  for (int i = 0; i < 3; ++i) {
    if (n[i] > 0.999) return link.moments[static_cast<std::size_t>(i)];
  }
  return link.inertia_spot;
}

}  // namespace

std::string fault_of_inertia(const Eigen::Matrix3d& inertia) {
  constexpr double rounding = 1e-12, allowed = 1e-6;
  const Eigen::Vector3d p = principal(inertia).values;
  const double largest = p.cwiseAbs().maxCoeff();
  if (p[0] < -rounding * largest) return "a principal value is negative";
  if (p[2] - p[1] - p[0] > allowed * largest) return "the principal values break the triangle inequality";
  return {};
}

Eigen::Matrix3d repaired(const Eigen::Matrix3d& inertia) {
  const auto [values, axes] = principal(inertia);
  Eigen::Vector3d p = values.cwiseMax(0.0);
  const double missing = p[2] - p[1] - p[0];
  if (missing > 0.0) p.head<2>().array() += 0.5 * missing;
  return axes * p.asDiagonal() * axes.transpose();
}

void check_inertia(Robot& robot, const Options& options, bool planar, const Eigen::Vector3d& normal,
                   Messages& messages) {
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    Link& link = robot.links[i];
    const Mount& mount = robot.mounts[i];
    if (!link.has_mass() || !link.inertia_known || mount.body == world_link) continue;
    const std::string fault = fault_of_inertia(link.inertia);
    const Eigen::Vector3d own_normal = mount.pose.linear().transpose() * normal;
    const double about_normal = planar ? moment(link, own_normal) : 0.0;
    const bool refused = planar ? about_normal < -1e-12 * link.inertia.cwiseAbs().maxCoeff() : !fault.empty();
    if (!refused && fault.empty()) continue;
    const std::string values = text(principal(link.inertia).values);
    const Spot& spot = planar && refused ? moment_spot(link, own_normal) : blamed(link);
    const std::string what =
        planar && refused
            ? fmt::format("the moment about the normal of the plane is negative, {:.6g} kg*m^2", about_normal)
            : fault;
    if (refused && options.repair_inertia) {
      link.inertia = repaired(link.inertia);
      messages.warning(spot, "urdf-ignored",
                       fmt::format("the inertia of link '{}' is mended: {} (principal values {}, now {} kg*m^2)",
                                   link.name, what, values, text(principal(link.inertia).values)));
    } else if (refused) {
      messages.error(
          spot, "out-of-range",
          fmt::format("impossible inertia of link '{}': {} (principal values {} kg*m^2)", link.name, what, values), {},
          "'repair: inertia' in a side-car mends it");
    } else {
      messages.warning(
          spot, "urdf-ignored",
          fmt::format("inertia of link '{}': {} ({} kg*m^2); only the moment about the normal of the plane is used",
                      link.name, fault, values),
          options.repair_inertia ? "'repair: inertia' leaves it as it is: that moment is possible" : "");
    }
  }
}

}  // namespace freeplay::urdf
