#include "system/joint_freedom.h"

#include <algorithm>

#include <Eigen/LU>

#include "system/joint_jacobian.h"

namespace freeplay {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Of the rows r.x = 0: how many directions x are free, and the one that is, or where two are, their normal.
int free_directions(const Rows& rows, Eigen::Vector3d& direction) {
  if (rows.rows() == 0) return 3;
  // Rows are of unit vectors, but for roundings.
  const auto factor = Eigen::FullPivLU<Eigen::MatrixXd>(rows).setThreshold(1e-9);
  const int free = 3 - static_cast<int>(factor.rank());
  if (free == 1) direction = Eigen::Vector3d(factor.kernel().col(0)).normalized();
  if (free == 2)
    direction = Eigen::Vector3d(factor.kernel().col(0)).cross(Eigen::Vector3d(factor.kernel().col(1))).normalized();
  return free;
}

/// Of rows of unit vectors and of levers, in which less than 1e-9 is rounding.
int rank_of(const Eigen::MatrixXd& rows) {
  const double largest = rows.size() > 0 ? rows.cwiseAbs().maxCoeff() : 0.0;
  if (!(largest > 1e-9)) return 0;
  return static_cast<int>(Eigen::FullPivLU<Eigen::MatrixXd>(rows).setThreshold(1e-9 / largest).rank());
}

Rows slide_rows(const JointJacobian& jacobian) { return jacobian.middleCols<3>(6); }

}  // namespace

// Of all free motions of the second body those that leave its origin where it is are turns alone.
std::optional<int> ways_of_origin(const JointRef& joint, const JointLayout& layout, const MarkerKinematics& a,
                                  const MarkerKinematics& b) {
  if (layout.constraint_rows == 0) return 3;
  const auto jacobian = joint_jacobian(joint, layout.constraint_rows, a, b);
  if (!jacobian) return std::nullopt;
  const int motions = 6 - rank_of(jacobian->rightCols<6>()), turns = 3 - rank_of(jacobian->rightCols<3>());
  return motions - turns;
}

JointFreedom joint_freedom(const JointRef& joint, const JointLayout& layout, const MarkerKinematics& a,
                           const MarkerKinematics& b) {
  JointFreedom freedom;
  const int count = layout.constraint_rows;
  if (count == 0) return freedom;
  const auto jacobian = joint_jacobian(joint, count, a, b);
  if (!jacobian) return {0, 0, freedom.slide, freedom.turn};
  const Rows along = slide_rows(*jacobian), about = jacobian->rightCols<3>();
  freedom.slides = free_directions(along, freedom.slide);
  // Turns are free where the second origin can follow: sums of rows that do not see it must not see them.
  Eigen::MatrixXd blind = Eigen::MatrixXd::Identity(count, count);
  const auto factor = Eigen::FullPivLU<Eigen::MatrixXd>(along.transpose()).setThreshold(1e-9);
  if (factor.rank() > 0) blind = factor.kernel();
  if (factor.rank() == count) blind.resize(count, 0);
  freedom.turns = free_directions(blind.transpose() * about, freedom.turn);
  return freedom;
}

bool holds_origins(const JointElement& element, Space space) {
  if (element.gear >= 0 || element.is_force) return false;
  MarkerKinematics marker{};
  std::ranges::copy(no_rotation, marker.rotation);
  return ways_of_origin(element.ideal(), element.ideal_layout(), marker, marker) == (space == Space::planar ? 1 : 0);
}

}  // namespace freeplay
