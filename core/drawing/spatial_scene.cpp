#include "drawing/spatial_scene.h"

#include <algorithm>

#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

}  // namespace

SpatialScene::SpatialScene(const System& system, std::span<const double> q)
    : system_(system), model_(system.model()), q_(q) {
  for (std::size_t b = 0; b < model_.bodies.size(); ++b)
    poses_.push_back(system.coordinates().frame_pose(static_cast<BodyId>(b), q));
  for (const JointElement& one : model_.joints) {
    freedoms_.push_back(one.gear >= 0 ? JointFreedom{}
                                      : joint_freedom(one.ideal(), one.ideal_layout(), kinematics(one.marker_a),
                                                      kinematics(one.marker_b)));
  }
  markers_.resize(model_.bodies.size());
  for (std::size_t i = 0; i < model_.markers.size(); ++i) {
    const BodyId body = model_.markers[i].body;
    if (body != ground) markers_[static_cast<std::size_t>(body)].push_back(static_cast<int>(i));
  }
  const std::vector<Vector> all = frames();
  if (all.empty()) return;
  Vector low = all.front(), high = low;
  for (const Vector& p : all) low = low.cwiseMin(p), high = high.cwiseMax(p);
  reach_ = (high - low).maxCoeff();
}

Eigen::Matrix3d SpatialScene::turn_of(BodyId body) const {
  if (body == ground) return Eigen::Matrix3d::Identity();
  return Eigen::Map<const RowMajor>(poses_[static_cast<std::size_t>(body)].rotation);
}

SpatialScene::Vector SpatialScene::world(const Marker& one) const {
  const Vector p(one.position[0], one.position[1], one.position[2]);
  if (one.body == ground) return p;
  return Eigen::Map<const Vector>(poses_[static_cast<std::size_t>(one.body)].position) + turn_of(one.body) * p;
}

Eigen::Matrix3d SpatialScene::axes_of(const Marker& one) const {
  return turn_of(one.body) * Eigen::Map<const RowMajor>(one.rotation.data());
}

SpatialScene::Vector SpatialScene::centre_of(BodyId body) const {
  const double* place = &q_[7 * static_cast<std::size_t>(body)];
  return {place[0], place[1], place[2]};
}

MarkerKinematics SpatialScene::kinematics(int index) const {
  MarkerKinematics k{};
  Eigen::Map<Vector>(k.position) = world(marker(index));
  Eigen::Map<RowMajor>(k.rotation) = axes_of(marker(index));
  return k;
}

SpatialScene::Vector SpatialScene::place(int index) const {
  const JointElement& one = joint(index);
  return one.gear >= 0 ? place(model_.gears[static_cast<std::size_t>(one.gear)].second) : world(marker(one.marker_b));
}

std::vector<SpatialScene::Vector> SpatialScene::points_of(BodyId body) const {
  const Vector centre = centre_of(body);
  std::vector<Vector> points{centre};
  bool extended = false;
  for (const int index : markers_[static_cast<std::size_t>(body)]) {
    points.push_back(world(marker(index)));
    extended = extended || (points.back() - centre).norm() > 1e-3 * reach_;
  }
  if (extended) return points;
  const std::size_t b = static_cast<std::size_t>(body);
  const double* mass = &system_.inertia().mass()[6 * b];
  const Eigen::Map<const Vector> moments(mass + 3);
  // I_1 = m (b^2 + c^2)/3 for half edges a, b, c.
  Vector half = (1.5 / mass[0] * (moments.sum() - 2.0 * moments.array())).max(0.0).sqrt();
  if (reach_ > 0.0) half *= std::min(1.0, 0.06 * reach_ / std::max(half.maxCoeff(), 1e-300));
  const Eigen::Matrix3d axes = spatial::rotation_of(&q_[7 * b + 3]);
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) points.push_back(centre + axes * half.cwiseProduct(Vector(x, y, z)));
    }
  }
  return points;
}

std::vector<SpatialScene::Vector> SpatialScene::frames() const {
  std::vector<Vector> all;
  for (const Marker& one : model_.frames) {
    if (!is_origin(one) || one.body != ground) all.push_back(world(one));
  }
  for (const Marker& one : model_.markers) all.push_back(world(one));
  return all;
}

std::vector<SpatialScene::Vector> SpatialScene::points() const {
  std::vector<Vector> all = frames();
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    for (const Vector& p : points_of(static_cast<BodyId>(b))) all.push_back(p);
  }
  return all;
}

}  // namespace freeplay
