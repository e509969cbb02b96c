#include "system/markers.h"

#include <algorithm>

#include "base/index.h"
#include "system/body_coordinates.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

spatial::Mount spatial_mount(const Model& model, const Marker& marker, const BodyCoordinates& coordinates) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  spatial::Mount mount{marker.body, spatial::vector(marker.position.data()),
                       Eigen::Map<const RowMajor>(marker.rotation.data())};
  if (marker.body == ground) return mount;
  const spatial::Matrix to_principal = coordinates.principal_axes(marker.body).transpose();
  mount.position = to_principal * (mount.position - spatial::vector(model.bodies[at(marker.body)].com.data()));
  mount.rotation = to_principal * mount.rotation;
  return mount;
}

}  // namespace

Markers::Markers(const Model& model, const Layout& layout, const BodyCoordinates& coordinates)
    : model_(model), layout_(layout) {
  for (const Marker& marker : model.markers) {
    places_.push_back(layout.place(marker.body));
    if (model.space == Space::planar) {
      mounts_.push_back(planar::mount(model, marker));
    } else {
      spatial_mounts_.push_back(spatial_mount(model, marker, coordinates));
    }
  }
  for (int m = 0; m < static_cast<int>(places_.size()); ++m) {
    if (place(m) != ground) moving_.push_back(m);
  }
  const auto place_of = [&](int m) { return place(m); };
  std::ranges::stable_sort(moving_, {}, place_of);
  const auto first_of = [&](int body) {
    return static_cast<int>(std::ranges::lower_bound(moving_, body, {}, place_of) - moving_.begin());
  };
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) of_body_.push_back({first_of(b), first_of(b + 1)});
}

MarkerValues::MarkerValues(const Markers& all) {
  const Model& model = all.model_;
  const std::size_t bodies = model.bodies.size();
  markers.assign(model.markers.size(), still_marker());
  q.resize(at(all.layout_.body_coordinates()) * bodies);
  v.resize(at(all.layout_.body_velocities()) * bodies);
  const bool planar = model.space == Space::planar;
  if (planar) {
    arms.resize(markers.size());
    turns.resize(bodies);
  } else {
    spatial_arms.resize(markers.size());
    spatial_turns.resize(bodies);
  }
  for (std::size_t m = 0; m < markers.size(); ++m) {
    const double rest[7] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0}, still_body[6] = {};
    if (model.markers[m].body != ground) continue;
    if (planar) {
      planar::marker_arm(all.mounts_[m], still_body, still_body, planar::Turn{}, arms[m]);
      planar::marker_kinematics(all.mounts_[m], still_body, planar::Turn{}, arms[m], markers[m]);
    } else {
      spatial::marker_kinematics(all.spatial_mounts_[m], rest, still_body, spatial::Turn{}, markers[m],
                                 spatial_arms[m]);
    }
  }
}

double Markers::angle(int marker, std::span<const double> q) const {
  const BodyId body = place(marker);
  return model_.markers[at(marker)].angle + (body == ground ? 0.0 : q[3 * at(body) + 2]);
}

void Markers::move(const Point& point, bool still, MarkerValues& values) const {
  if (model_.space == Space::planar) return move_in_plane(point, still, values);
  move_in_space(point, values);
}

void Markers::move_in_plane(const Point& point, bool still, MarkerValues& values) const {
  const planar::Mount* const mounts = mounts_.data();
  planar::Arm* const arms = values.arms.data();
  MarkerKinematics* const markers = values.markers.data();
  std::copy_n(point.v.data(), point.v.size(), values.v.data());
  if (still) {
    for (std::size_t b = 0; b < at(layout_.free_bodies()); ++b) {
      const double v[3] = {point.v[3 * b], point.v[3 * b + 1], point.v[3 * b + 2]};
      const Range own = of_body_[b];
      for (int i = own.first; i < own.end; ++i) {
        const int m = moving_[at(i)];
        arms[m].w = v[2];
        planar::marker_velocity(v, arms[m], markers[m]);
      }
    }
    return;
  }
  std::copy_n(point.q.data(), point.q.size(), values.q.data());
  for (std::size_t b = 0; b < at(layout_.free_bodies()); ++b) {
    // Numbers of their own, which no marker can change.
    const double q[3] = {point.q[3 * b], point.q[3 * b + 1], point.q[3 * b + 2]};
    const double v[3] = {point.v[3 * b], point.v[3 * b + 1], point.v[3 * b + 2]};
    if (values.turns[b].angle != q[2]) values.turns[b] = turn(planar::Bodies{}, q, v);
    const planar::Turn turned = values.turns[b];
    const Range own = of_body_[b];
    for (int i = own.first; i < own.end; ++i) {
      const int m = moving_[at(i)];
      planar::Arm arm;
      planar::marker_arm(mounts[m], q, v, turned, arm);
      arms[m] = arm;
      planar::marker_kinematics(mounts[m], v, turned, arm, markers[m]);
    }
  }
}

void Markers::move_in_space(const Point& point, MarkerValues& values) const {
  const auto q = [&](std::size_t body) { return &point.q[7 * body]; };
  const auto v = [&](std::size_t body) { return &point.v[6 * body]; };
  std::ranges::copy(point.q, values.q.begin());
  std::ranges::copy(point.v, values.v.begin());
  for (std::size_t b = 0; b < values.spatial_turns.size(); ++b) {
    values.spatial_turns[b] = turn(spatial::Bodies{}, q(b), v(b));
  }
  for (const int m : moving_) {
    const std::size_t body = at(spatial_mounts_[at(m)].body);
    marker_kinematics(spatial_mounts_[at(m)], q(body), v(body), values.spatial_turns[body], values.markers[at(m)],
                      values.spatial_arms[at(m)]);
  }
}

void Markers::move_with(BodyId place, const planar::Turn& turn, MarkerValues& values) const {
  const planar::Mount* const mounts = mounts_.data();
  planar::Arm* const arms = values.arms.data();
  MarkerKinematics* const markers = values.markers.data();
  const double *from_q = &values.q[3 * at(place)], *from_v = &values.v[3 * at(place)];
  // Numbers of their own, which no marker can change.
  const double q[3] = {from_q[0], from_q[1], from_q[2]}, v[3] = {from_v[0], from_v[1], from_v[2]};
  const planar::Turn turned = turn;
  const Range own = of_body_[at(place)];
  for (int i = own.first; i < own.end; ++i) {
    const int m = moving_[at(i)];
    planar::Arm arm;
    planar::marker_arm(mounts[m], q, v, turned, arm);
    arms[m] = arm;
    planar::marker_kinematics(mounts[m], v, turned, arm, markers[m]);
  }
}

void Markers::row(int marker, const double* g, const MarkerValues& values, double* row) const {
  by_space(model_.space, [&]<class Bodies>(Bodies) { body_row(g, values.arms_of<Bodies>()[at(marker)], row); });
}

void Markers::twist_row(int marker, const double* row, const MarkerValues& values, double* twist) const {
  by_space(model_.space, [&]<class Bodies>(Bodies) { wrench_of(row, values.arms_of<Bodies>()[at(marker)], twist); });
}

double Markers::row_product(int marker, const double* g, const MarkerValues& values) const {
  return by_space(model_.space,
                  [&]<class Bodies>(Bodies) { return velocity_product(g, values.arms_of<Bodies>()[at(marker)]); });
}

void Markers::apply(int marker, const double* wrench, const MarkerValues& values, std::span<double> force) const {
  const std::size_t body = at(place(marker));
  by_space(model_.space, [&]<class Bodies>(Bodies) {
    add_wrench(wrench, values.arms_of<Bodies>()[at(marker)], &force[Bodies::velocities * body]);
  });
}

}  // namespace freeplay
