#include "urdf/mass.h"

#include "base/index.h"

namespace freeplay::urdf {

MassProperties together(const std::vector<MassProperties>& parts) {
  if (parts.size() == 1) return parts.front();
  MassProperties body;
  if (parts.empty()) return body;
  for (const MassProperties& part : parts) {
    body.mass += part.mass;
    body.com += part.mass * part.com;
  }
  body.com /= body.mass;
  for (const MassProperties& part : parts) {
    const Eigen::Vector3d arm = part.com - body.com;
    body.inertia +=
        part.inertia + part.mass * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
  return body;
}

std::vector<MassProperties> body_masses(const Robot& robot, const std::vector<Mount>& mounts) {
  std::vector<std::vector<MassProperties>> parts(robot.links.size());
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const Link& link = robot.links[i];
    if (mounts[i].body == world_link || !link.has_mass()) continue;
    const Eigen::Isometry3d frame = mounts[i].pose * link.inertial;
    parts[at(mounts[i].body)].push_back(
        {link.mass, frame.translation(), frame.linear() * link.inertia * frame.linear().transpose()});
  }
  std::vector<MassProperties> bodies;
  for (const std::vector<MassProperties>& of_body : parts) bodies.push_back(together(of_body));
  return bodies;
}

}  // namespace freeplay::urdf
