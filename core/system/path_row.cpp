#include "system/path_row.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/angle.h"
#include "base/index.h"

namespace freeplay {
namespace {

using RowMajorRotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// roll, pitch, yaw of a frame and their rates and, at rest of its angular acceleration, second derivatives.
std::array<Jet, 3> angles_of(const MarkerKinematics& frame) {
  Turning turning;
  std::copy_n(frame.rotation, 9, turning.rotation.begin());
  std::copy_n(frame.angular_velocity, 3, turning.velocity.begin());
  return roll_pitch_yaw_of(turning);
}

}  // namespace

Vector3 turn_between(const double* from, const double* to) {
  const Eigen::Map<const RowMajorRotation> a(from), b(to);
  Eigen::Quaterniond turn(spatial::Matrix(b * a.transpose()));
  if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
  const double half_sine = turn.vec().norm();
  const double factor = half_sine > 0.0 ? 2.0 * std::atan2(half_sine, turn.w()) / half_sine : 2.0;
  return {factor * turn.x(), factor * turn.y(), factor * turn.z()};
}

bool PathRow::is_angle_in_space(const System& system) const {
  return system.model().space == Space::spatial && component >= 3 && !whole_turn;
}

void PathRow::twist_row(const System& system, const Evaluation& e, double* g) const {
  if (system.model().space == Space::planar) {
    g[planar::components[component]] = 1.0;
  } else if (!is_angle_in_space(system)) {
    g[component] = 1.0;
  } else {
    // The rate of the angle at unit angular velocities.
    Turning turning;
    std::copy_n(e.markers[at(marker)].rotation, 9, turning.rotation.begin());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      turning.velocity = {};
      turning.velocity[axis] = 1.0;
      g[3 + axis] = roll_pitch_yaw_of(turning)[at(component - 3)].rate;
    }
  }
}

void PathRow::entries(const System& system, const Evaluation& e, double* row) const {
  double g[6] = {};
  twist_row(system, e, g);
  system.markers().row(marker, g, e, row);
}

double PathRow::residual(const System& system, const Point& point, const Evaluation& e, const PathPose& path) const {
  const MarkerKinematics& frame = e.markers[at(marker)];
  const double wanted = path[at(component)].value;
  const bool planar = system.model().space == Space::planar;
  if (component < (planar ? 2 : 3)) return frame.position[component] - wanted;
  if (planar) return without_turns(system.markers().angle(marker, point.q) - wanted);
  if (whole_turn) return turn_between(path.turning.rotation.data(), frame.rotation)[at(component - 3)];
  return without_turns(angles_of(frame)[at(component - 3)].value - wanted);
}

double PathRow::speed(const PathPose& path) const {
  return whole_turn ? path.turning.velocity[at(component - 3)] : path[at(component)].rate;
}

double PathRow::gamma(const System& system, const Evaluation& e, const PathPose& path) const {
  double g[6] = {};
  twist_row(system, e, g);
  const double wanted = whole_turn ? path.turning.acceleration[at(component - 3)] : path[at(component)].acceleration;
  const double own = is_angle_in_space(system) ? angles_of(e.markers[at(marker)])[at(component - 3)].acceleration : 0.0;
  return wanted - own - system.markers().row_product(marker, g, e);
}

std::vector<PathRow> path_rows(const Model& model, int kinematics) {
  const InverseKinematics& entry = model.kinematics[at(kinematics)];
  const bool whole_turn = entry.path.gives_turning();
  std::vector<PathRow> rows;
  for (int i = 0; i < static_cast<int>(most_path_numbers); ++i) {
    if (!entry.path.gives(at(i))) continue;
    rows.push_back({kinematics, i, entry.marker, model.markers[at(entry.marker)].body, whole_turn && i >= 3});
  }
  return rows;
}

}  // namespace freeplay
