#include "system/body_coordinates.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "base/index.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

std::array<double, 4> quaternion_of(const spatial::Matrix& rotation) {
  Eigen::Quaterniond q(rotation);
  q.normalize();
  return {q.w(), q.x(), q.y(), q.z()};
}

// Body axes from principal axes, right-handed; the body's own where they are principal already.
spatial::Matrix principal_axes_of(const Body& body, spatial::Vector& moments) {
  const spatial::Matrix inertia = Eigen::Map<const RowMajor>(body.inertia.data());
  moments = inertia.diagonal();
  if (inertia(0, 1) == 0.0 && inertia(0, 2) == 0.0 && inertia(1, 2) == 0.0) return spatial::Matrix::Identity();
  const Eigen::SelfAdjointEigenSolver<spatial::Matrix> solver(inertia);
  moments = solver.eigenvalues();
  spatial::Matrix axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);
  return axes;
}

}  // namespace

BodyCoordinates::BodyCoordinates(const Model& model) : model_(model) {
  if (model.space == Space::planar) return;
  for (const Body& body : model.bodies) {
    spatial::Vector moments;
    principal_.push_back(principal_axes_of(body, moments));
    moments_.push_back(moments);
  }
}

void BodyCoordinates::retract(std::span<const double> base, std::span<const double> increment,
                              std::span<double> q) const {
  if (model_.space == Space::planar) {
    for (std::size_t b = 0; b < q.size(); b += 3) {
      for (std::size_t i = b; i < b + 3; ++i) q[i] = base[i] + increment[i];
    }
    return;
  }
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    spatial::retract_body(&base[7 * b], &increment[6 * b], &q[7 * b]);
  }
}

void BodyCoordinates::difference(std::span<const double> base, std::span<const double> q,
                                 std::span<double> increment) const {
  if (model_.space == Space::planar) {
    for (std::size_t i = 0; i < q.size(); ++i) increment[i] = q[i] - base[i];
    return;
  }
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    spatial::difference_body(&base[7 * b], &q[7 * b], &increment[6 * b]);
  }
}

void BodyCoordinates::increment_rate(std::span<const double> increment, std::span<const double> v,
                                     std::span<double> rate) const {
  std::ranges::copy(v, rate.begin());
  if (model_.space == Space::planar) return;
  for (std::size_t i = 3; i < v.size(); i += 6) {
    const spatial::Vector turned = spatial::rotation_rate(spatial::vector(&increment[i]), spatial::vector(&v[i]));
    std::copy_n(turned.data(), 3, &rate[i]);
  }
}

void BodyCoordinates::velocities_of(std::span<const double> increment, std::span<const double> rate,
                                    std::span<double> v) const {
  std::ranges::copy(rate, v.begin());
  if (model_.space == Space::planar) return;
  for (std::size_t i = 3; i < v.size(); i += 6) {
    const spatial::Vector w = spatial::angular_velocity(spatial::vector(&increment[i]), spatial::vector(&rate[i]));
    std::copy_n(w.data(), 3, &v[i]);
  }
}

Pose BodyCoordinates::frame_pose(BodyId body, std::span<const double> q) const {
  const Vector3& com = model_.bodies[at(body)].com;
  Pose pose{};
  Eigen::Map<RowMajor> rotation(pose.rotation);
  Eigen::Map<spatial::Vector> position(pose.position);
  if (model_.space == Space::planar) {
    const double* c = &q[3 * at(body)];
    const double cosine = std::cos(c[2]), sine = std::sin(c[2]);
    rotation << cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0;
    position << c[0], c[1], 0.0;
  } else {
    rotation = spatial::rotation_of(&q[7 * at(body) + 3]) * principal_[at(body)].transpose();
    position = spatial::vector(&q[7 * at(body)]);
  }
  position -= rotation * spatial::vector(com.data());
  return pose;
}

void BodyCoordinates::set_frame_pose(BodyId body, const Pose& pose, std::span<double> q) const {
  const Eigen::Map<const RowMajor> rotation(pose.rotation);
  const spatial::Vector centre =
      spatial::vector(pose.position) + rotation * spatial::vector(model_.bodies[at(body)].com.data());
  if (model_.space == Space::planar) {
    double* c = &q[3 * at(body)];
    c[0] = centre[0], c[1] = centre[1], c[2] = std::atan2(rotation(1, 0), rotation(0, 0));
    return;
  }
  double* c = &q[7 * at(body)];
  std::copy_n(centre.data(), 3, c);
  std::ranges::copy(quaternion_of(rotation * principal_[at(body)]), c + 3);
}

std::array<double, 4> BodyCoordinates::frame_quaternion(BodyId body, std::span<const double> q) const {
  std::array<double, 4> out;
  std::copy_n(&q[7 * at(body) + 3], 4, out.begin());
  if (principal_[at(body)].isIdentity(0.0)) return out;
  const std::array<double, 4> back = quaternion_of(principal_[at(body)].transpose());
  spatial::multiply(out.data(), back.data(), out.data());
  return out;
}

void BodyCoordinates::body_twist(BodyId body, std::span<const double> q, std::span<const double> v,
                                 double* twist) const {
  std::fill_n(twist, 6, 0.0);
  if (model_.space == Space::planar) {
    const double* from = &v[3 * at(body)];
    twist[0] = from[0], twist[1] = from[1], twist[5] = from[2];
    return;
  }
  std::copy_n(&v[6 * at(body)], 3, twist);
  const spatial::Vector w = spatial::rotation_of(&q[7 * at(body) + 3]) * spatial::vector(&v[6 * at(body) + 3]);
  std::copy_n(w.data(), 3, twist + 3);
}

void BodyCoordinates::set_body_twist(BodyId body, std::span<const double> q, const double* twist,
                                     std::span<double> v) const {
  if (model_.space == Space::planar) {
    double* to = &v[3 * at(body)];
    to[0] = twist[0], to[1] = twist[1], to[2] = twist[5];
    return;
  }
  std::copy_n(twist, 3, &v[6 * at(body)]);
  const spatial::Vector w = spatial::rotation_of(&q[7 * at(body) + 3]).transpose() * spatial::vector(twist + 3);
  std::copy_n(w.data(), 3, &v[6 * at(body) + 3]);
}

}  // namespace freeplay
