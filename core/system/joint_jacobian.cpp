#include "system/joint_jacobian.h"

#include <vector>

namespace freeplay {

std::optional<JointJacobian> joint_jacobian(const JointRef& joint, int rows, const MarkerKinematics& a,
                                            const MarkerKinematics& b) {
  std::vector<double> phi(static_cast<std::size_t>(rows)), nu(phi), gamma(phi);
  JointJacobian jacobian = JointJacobian::Zero(rows, 12);
  ConstraintRows out{{phi.data(), phi.size()},
                     {jacobian.data(), static_cast<std::size_t>(jacobian.size())},
                     {nu.data(), nu.size()},
                     {gamma.data(), gamma.size()}};
  JointInput in{};
  in.a = &a;
  in.b = &b;
  Message message;
  if (!joint.constrain(in, out, message)) return std::nullopt;
  return jacobian;
}

}  // namespace freeplay
