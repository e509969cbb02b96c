#include "assembly/given_poses.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "base/angle.h"
#include "base/index.h"

namespace freeplay {
namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

}  // namespace

GivenPoses::GivenPoses(const System& system)
    : system_(system), model_(system.model()), planar_(model_.space == Space::planar) {
  for (const Body& body : model_.bodies) {
    if (body.position) rows_ += planar_ ? 2 : 3;
    if (gives_turn(body)) rows_ += planar_ ? 1 : 3;
  }
}

// In world axes, so that its rate is the angular velocity where it is small.
std::array<double, 3> GivenPoses::turn_vector(BodyId id, std::span<const double> q) const {
  const Body& body = model_.bodies[at(id)];
  if (!gives_turn(body)) return {};
  if (planar_) return {0.0, 0.0, wrapped(q[3 * at(id) + 2] - *body.angle)};
  const Pose pose = system_.coordinates().frame_pose(id, q);
  const Eigen::Matrix3d turned =
      Eigen::Map<const RowMajor>(pose.rotation) * Eigen::Map<const RowMajor>(body.rotation->data()).transpose();
  const Eigen::AngleAxisd angle(turned);
  const double size = wrapped(angle.angle());
  return {size * angle.axis().x(), size * angle.axis().y(), size * angle.axis().z()};
}

Eigen::VectorXd GivenPoses::misses(std::span<const double> q) const {
  Eigen::VectorXd out(rows_);
  Eigen::Index row = 0;
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    const Body& body = model_.bodies[at(b)];
    if (body.position) {
      const Pose pose = system_.coordinates().frame_pose(b, q);
      for (std::size_t c = 0; c < (planar_ ? 2u : 3u); ++c) {
        out[row++] = (pose.position[c] - (*body.position)[c]) / system_.size();
      }
    }
    if (!gives_turn(body)) continue;
    const std::array<double, 3> turn = turn_vector(b, q);
    for (std::size_t c = planar_ ? 2 : 0; c < 3; ++c) out[row++] = turn[c];
  }
  return out;
}

Eigen::MatrixXd GivenPoses::derivative(std::span<const double> q) const {
  const int width = system_.layout().body_velocities();
  std::vector<double> v(at(system_.layout().nv()), 0.0);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows_, static_cast<Eigen::Index>(v.size()));
  Eigen::Index first = 0;
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    const Body& body = model_.bodies[at(b)];
    if (!body.position && !gives_turn(body)) continue;
    const Pose pose = system_.coordinates().frame_pose(b, q);
    const Eigen::Vector3d arm = -(Eigen::Map<const RowMajor>(pose.rotation) * Eigen::Vector3d(body.com.data()));
    Eigen::Index row = first;
    for (int k = 0; k < width; ++k) {
      v[at(width * b + k)] = 1.0;
      double twist[6];
      system_.coordinates().body_twist(b, q, v, twist);
      v[at(width * b + k)] = 0.0;
      const Eigen::Vector3d w(twist + 3), origin = Eigen::Vector3d(twist) + w.cross(arm);
      row = first;
      for (int c = 0; c < (planar_ ? 2 : 3) && body.position; ++c)
        out(row++, width * b + k) = origin[c] / system_.size();
      for (int c = planar_ ? 2 : 0; c < 3 && gives_turn(body); ++c) out(row++, width * b + k) = w[c];
    }
    first = row;
  }
  return out;
}

double GivenPoses::shift(BodyId id, std::span<const double> q) const {
  const Body& body = model_.bodies[at(id)];
  if (!body.position) return 0.0;
  const Pose pose = system_.coordinates().frame_pose(id, q);
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) sum = std::hypot(sum, pose.position[c] - (*body.position)[c]);
  return sum;
}

double GivenPoses::turn(BodyId id, std::span<const double> q) const {
  const std::array<double, 3> turn = turn_vector(id, q);
  return std::hypot(turn[0], turn[1], turn[2]);
}

void GivenPoses::put_as_given(std::span<double> q) const {
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    const Body& body = model_.bodies[at(b)];
    if (!body.position && !gives_turn(body)) continue;
    Pose pose = system_.coordinates().frame_pose(b, q);
    if (body.position) std::copy_n(body.position->data(), planar_ ? 2 : 3, pose.position);
    if (body.rotation) std::ranges::copy(*body.rotation, pose.rotation);
    if (planar_ && body.angle) {
      const double c = std::cos(*body.angle), s = std::sin(*body.angle);
      const double rotation[9] = {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0};
      std::ranges::copy(rotation, pose.rotation);
    }
    system_.coordinates().set_frame_pose(b, pose, q);
  }
}

}  // namespace freeplay
