#include "analysis/platform_frame.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/angle.h"
#include "base/index.h"
#include "model/rotation.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double one_axis = 1e-9;  // cosine of the pitch below which roll and yaw turn about one axis

Matrix3d rotation_of(const double* roll_pitch_yaw) {
  const Rotation r = from_roll_pitch_yaw(roll_pitch_yaw[0], roll_pitch_yaw[1], roll_pitch_yaw[2]);
  return Eigen::Map<const RowMajor>(r.data());
}

Vector3d roll_pitch_yaw_of(const Matrix3d& r) {
  const double cosine = std::hypot(r(0, 0), r(1, 0));
  if (cosine < one_axis) {
    const double side = r(2, 0) < 0.0 ? 1.0 : -1.0;
    return {std::atan2(side * r(0, 1), r(1, 1)), side * M_PI / 2.0, 0.0};
  }
  return {std::atan2(r(2, 1), r(2, 2)), std::atan2(-r(2, 0), cosine), std::atan2(r(1, 0), r(0, 0))};
}

/// E in w = E (roll', pitch', yaw')^T, world axes, and its time derivative.
void turn_axes(const Vector3d& angles, const Vector3d& rates, Matrix3d& e, Matrix3d& e_rate) {
  const double cp = std::cos(angles[1]), sp = std::sin(angles[1]), cy = std::cos(angles[2]), sy = std::sin(angles[2]);
  e << cy * cp, -sy, 0.0,  //
      sy * cp, cy, 0.0,    //
      -sp, 0.0, 1.0;
  e_rate << -sy * cp * rates[2] - cy * sp * rates[1], -cy * rates[2], 0.0,  //
      cy * cp * rates[2] - sy * sp * rates[1], -sy * rates[2], 0.0,         //
      -cp * rates[1], 0.0, 0.0;
}

}  // namespace

PlatformFrame::PlatformFrame(const System& system, int marker)
    : system_(system), marker_(marker), form_(pose_form(system.model().space)) {}

FramePose PlatformFrame::pose(std::span<const double> q) const {
  const Model& model = system_.model();
  const Marker& marker = model.markers[at(marker_)];
  if (model.space == Space::planar) {
    const Body& body = model.bodies[at(marker.body)];
    const double* c = &q[3 * at(marker.body)];
    const double dx = marker.position[0] - body.com[0], dy = marker.position[1] - body.com[1];
    const double cosine = std::cos(c[2]), sine = std::sin(c[2]);
    return {c[0] + cosine * dx - sine * dy, c[1] + sine * dx + cosine * dy, c[2] + marker.angle};
  }
  const Pose body = system_.coordinates().frame_pose(marker.body, q);
  const Eigen::Map<const RowMajor> rotation(body.rotation), own(marker.rotation.data());
  const Vector3d position = spatial::vector(body.position) + rotation * spatial::vector(marker.position.data());
  const Vector3d turns = roll_pitch_yaw_of(rotation * own);
  return {position[0], position[1], position[2], turns[0], turns[1], turns[2]};
}

void PlatformFrame::place(const FramePose& pose, std::span<double> q) const {
  const Model& model = system_.model();
  const Marker& marker = model.markers[at(marker_)];
  if (model.space == Space::planar) {
    const Body& body = model.bodies[at(marker.body)];
    const double angle = pose[2] - marker.angle, cosine = std::cos(angle), sine = std::sin(angle);
    const double dx = body.com[0] - marker.position[0], dy = body.com[1] - marker.position[1];
    double* c = &q[3 * at(marker.body)];
    c[0] = pose[0] + cosine * dx - sine * dy;
    c[1] = pose[1] + sine * dx + cosine * dy;
    c[2] = angle;
    return;
  }
  const Eigen::Map<const RowMajor> own(marker.rotation.data());
  Pose body{};
  Eigen::Map<RowMajor> rotation(body.rotation);
  rotation = rotation_of(&pose[3]) * own.transpose();
  spatial::target(body.position) = spatial::vector(pose.data()) - rotation * spatial::vector(marker.position.data());
  system_.coordinates().set_frame_pose(marker.body, body, q);
}

void PlatformFrame::rows(const Components& given, const std::array<Jet, most_components>& pose, const Evaluation& e,
                         std::vector<PoseRow>& out) const {
  const MarkerKinematics& here = e.markers[at(marker_)];
  out.clear();
  for (std::size_t i = 0; i < form_.lengths; ++i) {
    if (!given[i]) continue;
    PoseRow& row = out.emplace_back();
    row.g[form_.twist[i]] = 1.0;
    row.gap = pose[i].value - here.position[i];
    row.rate = pose[i].rate;
    row.acceleration = pose[i].acceleration;
  }
  turn_rows(given, pose, here, out);
}

void PlatformFrame::turn_rows(const Components& given, const std::array<Jet, most_components>& pose,
                              const MarkerKinematics& here, std::vector<PoseRow>& out) const {
  const Matrix3d rotation = Eigen::Map<const RowMajor>(here.rotation);
  const std::size_t first = form_.lengths;
  if (form_.size() - first == 1) {
    if (!given[first]) return;
    PoseRow& row = out.emplace_back();
    row.g[form_.twist[first]] = 1.0;
    row.gap = without_turns(pose[first].value - std::atan2(rotation(1, 0), rotation(0, 0)));
    row.rate = pose[first].rate;
    row.acceleration = pose[first].acceleration;
    return;
  }
  const bool all = given[3] && given[4] && given[5];
  if (!given[3] && !given[4] && !given[5]) return;
  const Vector3d wanted(pose[3].value, pose[4].value, pose[5].value);
  const Vector3d rates(pose[3].rate, pose[4].rate, pose[5].rate);
  const Vector3d accelerations(pose[3].acceleration, pose[4].acceleration, pose[5].acceleration);
  Matrix3d e, e_rate;
  if (all) {
    turn_axes(wanted, rates, e, e_rate);
    const Eigen::AngleAxisd gap(rotation_of(wanted.data()) * rotation.transpose());
    const Vector3d turn = without_turns(gap.angle()) * gap.axis();
    const Vector3d w = e * rates, alpha = e * accelerations + e_rate * rates;
    for (int i = 0; i < 3; ++i) {
      PoseRow& row = out.emplace_back();
      row.g[3 + i] = 1.0;
      row.gap = turn[i];
      row.rate = w[i];
      row.acceleration = alpha[i];
    }
    return;
  }
  const Vector3d angles = roll_pitch_yaw_of(rotation);
  turn_axes(angles, Vector3d::Zero(), e, e_rate);
  const Matrix3d inverse = e.inverse();
  const Vector3d rates_here = inverse * spatial::vector(here.angular_velocity);
  turn_axes(angles, rates_here, e, e_rate);
  const Vector3d bias = inverse * e_rate * rates_here;
  for (int i = 0; i < 3; ++i) {
    if (!given[at(3 + i)]) continue;
    PoseRow& row = out.emplace_back();
    for (int c = 0; c < 3; ++c) row.g[3 + c] = inverse(i, c);
    row.gap = without_turns(wanted[i] - angles[i]);
    row.rate = rates[i];
    row.acceleration = accelerations[i] + bias[i];
  }
}

void PlatformFrame::frame_row(const double* row, const Evaluation& e, double* out) const {
  double twist[6];
  system_.markers().twist_row(marker_, row, e, twist);
  for (std::size_t i = 0; i < form_.size(); ++i) out[i] = twist[form_.twist[i]];
}

}  // namespace freeplay
