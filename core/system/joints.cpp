#include "system/joints.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/angle.h"
#include "base/index.h"
#include "system/evaluation.h"
#include "system/finite.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

double rate_of(const double* row, const MarkerKinematics& a, const MarkerKinematics& b) {
  double rate = 0.0;
  for (int i = 0; i < 3; ++i) {
    rate += row[i] * a.velocity[i] + row[3 + i] * a.angular_velocity[i] + row[6 + i] * b.velocity[i] +
            row[9 + i] * b.angular_velocity[i];
  }
  return rate;
}

// Terms in which a joint reads its coordinate itself.
unsigned own_terms(const JointLayout& layout, int turn) {
  unsigned terms = turn < 0 ? term_coordinate : term_coordinate | term_turn;
  if (layout.constraint_rows > 0 && layout.rows_without_coordinate == 0) terms |= term_position;
  if (layout.forces_without_coordinate != 0) return terms;
  if (layout.forces != 0) terms |= term_force;
  if (!layout.events.empty() || layout.history > 0) terms |= term_event;
  return terms;
}

/// Turn by the tilt that a joint starts with; false where it has none.
bool tilts(const InitialOffset& offset, Eigen::Matrix3d& turn) {
  const Eigen::Map<const Eigen::Vector3d> tilt(offset.tilt);
  const double angle = tilt.norm();
  if (!(angle > 0.0)) return false;
  turn = Eigen::AngleAxisd(angle, tilt / angle).toRotationMatrix();
  return true;
}

/// The second marker as the ideal twin sees it, without the tilt and its rate.
void tilt_back(const InitialOffset& offset, const MarkerKinematics& a, MarkerKinematics& b) {
  const Eigen::Map<const Eigen::Vector3d> rate(offset.tilt_rate), w_a(a.angular_velocity);
  Eigen::Map<Eigen::Vector3d> w_b(b.angular_velocity);
  w_b -= rate;
  Eigen::Matrix3d turn;
  if (!tilts(offset, turn)) return;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> axes(b.rotation);
  axes = (turn.transpose() * axes).eval();
  w_b = (w_a + turn.transpose() * (w_b - w_a)).eval();
}

}  // namespace

JointValues::JointValues(std::size_t joints)
    : coordinate(joints), coordinate_rate(joints), coordinate_rows(joints), shifted(joints, still_marker()) {}

Joints::Joints(const Model& model, Variant variant, const Layout& layout, const Markers& markers)
    : model_(model),
      variant_(variant),
      layout_(layout),
      markers_(markers),
      records_(model.joints.size()),
      offsets_(model.joints.size(), InitialOffset{}) {
  const bool closed = variant == Variant::closed;
  for (int j = 0; j < static_cast<int>(records_.size()); ++j) {
    const JointElement& element = model.joints[at(j)];
    JointRecord& r = records_[at(j)];
    r.joint = closed ? element.ideal() : element.joint;
    r.layout = closed ? &element.ideal_layout() : &element.layout;
    r.index = j;
    r.marker_a = element.marker_a;
    r.marker_b = element.marker_b;
    r.body_a = markers.place(element.marker_a);
    r.body_b = markers.place(element.marker_b);
    r.stands_off = closed && element.has_play;
    r.internal = layout.internal(j);
    r.history = layout.history(j);
    r.functions = {static_cast<int>(functions_), static_cast<int>(element.by_motion.formulas.size())};
    functions_ += element.by_motion.formulas.size();
    r.turn = layout.turn(j);
    r.declares_coordinate = model.space == Space::planar && !r.stands_off && r.layout->planar_coordinate != 0;
    r.coordinate_terms = own_terms(*r.layout, r.turn);
  }
  for (const Gear& gear : model.gears) {
    for (const int j : {gear.first, gear.second}) records_[at(j)].coordinate_terms |= term_position;
  }
  for (std::size_t d = 0; d < model.drivers.size(); ++d) {
    JointRecord& r = records_[at(model.drivers[d].joint)];
    // Its rate makes the driver's power, but for driven bodies, whose motion is that of time.
    const bool driven_angle = layout.driver_row(static_cast<int>(d)) >= layout.nc() && r.declares_angle();
    if (!driven_angle) r.coordinate_terms |= term_position | term_force;
  }
  for_each_motion_formulas(model, [&](const MotionFormulas& formulas) {
    for (const MotionChannel& channel : formulas.channels) {
      if (channel.is_of_joint()) records_[at(channel.element)].coordinate_terms |= term_force | term_event;
    }
  });
  for (const JointRecord& r : records_) {
    if (r.layout->coordinate == Coordinate::none) continue;
    if (r.declares_coordinate) {
      declared_.add(r.layout->coordinate, r, r.index, r.coordinate_terms, r.turn);
    } else {
      asked_.push_back(r.index);
    }
  }
}

void Joints::untilt(int joint, Span<double> jacobian) const {
  Eigen::Matrix3d turn;
  if (!tilts(offsets_[at(joint)], turn)) return;
  for (std::size_t r = 0; r < jacobian.size; r += 12) {
    Eigen::Map<Eigen::Vector3d> of_a(jacobian.data + r + 3), of_b(jacobian.data + r + 9);
    const Eigen::Vector3d seen = of_b;
    of_b = turn * seen;
    of_a += seen - of_b;
  }
}

void Joints::shift_all(Evaluation& e) const {
  for (std::size_t j = 0; j < records_.size(); ++j) {
    if (!records_[j].stands_off) continue;
    MarkerKinematics& k = e.shifted[j] = e.markers[at(records_[j].marker_b)];
    for (int i = 0; i < 3; ++i) {
      k.position[i] -= offsets_[j].position[i];
      k.velocity[i] -= offsets_[j].velocity[i];
    }
    if (model_.space == Space::spatial) tilt_back(offsets_[j], e.markers[at(records_[j].marker_a)], k);
    if (offsets_[j].turn == 0.0 && offsets_[j].turn_rate == 0.0) continue;
    const double c = std::cos(offsets_[j].turn), s = std::sin(offsets_[j].turn);
    for (int column = 0; column < 2; ++column) {
      const double x = k.rotation[column], y = k.rotation[3 + column];
      k.rotation[column] = c * x + s * y;
      k.rotation[3 + column] = c * y - s * x;
    }
    k.angular_velocity[2] -= offsets_[j].turn_rate;
  }
}

bool Joints::ask_for_coordinates(const Point& point, unsigned terms, Evaluation& e) const {
  for (const int j : asked_) {
    const JointRecord& record = records_[at(j)];
    if ((record.coordinate_terms & terms) == 0) continue;
    const JointInput in = input(record, point, e);
    CoordinateRow& row = e.coordinate_rows[at(j)] = CoordinateRow{};
    if (!record.joint.coordinate(in, row, e.fault.message)) return e.fault.blame(j);
    if (!std::isfinite(row.value) && are_finite(record, e)) {
      return e.fault.refuse(j, "it returned a coordinate that is not a finite number");
    }
    if (record.turn >= 0) {
      // The turn nearest to the last accepted angle: a step never turns a joint by more than half a revolution.
      row.value = nearest_turn(row.value, point.h[at(record.turn)]);
    }
    e.coordinate[at(j)] = row.value;
    e.coordinate_rate[at(j)] = rate_of(row.jacobian, *in.a, *in.b);
    if (record.stands_off) untilt(j, row.jacobian);
  }
  return true;
}

void Joints::coordinate_row(int index, const Evaluation& e, double* row, double& bias) const {
  const JointRecord& record = records_[at(index)];
  const CoordinateRow& marker_row = e.coordinate_rows[at(index)];
  bias = marker_row.bias;
  by_space(model_.space, [&]<class Bodies>(Bodies) {
    const auto& arms = e.arms_of<Bodies>();
    const auto &arm_a = arms[at(record.marker_a)], &arm_b = arms[at(record.marker_b)];
    body_row(marker_row.jacobian, arm_a, row);
    body_row(marker_row.jacobian + 6, arm_b, row + Bodies::velocities);
    if (record.body_a != ground) bias += velocity_product(marker_row.jacobian, arm_a);
    if (record.body_b != ground) bias += velocity_product(marker_row.jacobian + 6, arm_b);
  });
}

void Joints::accelerations(int index, const Evaluation& e, std::span<const double> a, MarkerAccelerations& out) const {
  const JointRecord& record = records_[at(index)];
  by_space(model_.space, [&]<class Bodies>(Bodies) {
    const double rest[Bodies::velocities] = {};
    const auto of = [&](BodyId body) {
      if (body == ground) return rest;
      const int driven = body - layout_.free_bodies();
      return driven < 0 ? &a[Bodies::velocities * at(body)] : &e.driven_a[Bodies::velocities * at(driven)];
    };
    marker_acceleration(of(record.body_a), e.arms_of<Bodies>()[at(record.marker_a)], out.a);
    marker_acceleration(of(record.body_b), e.arms_of<Bodies>()[at(record.marker_b)], out.b);
  });
}

bool Joints::angles_follow_bodies() const {
  const auto has_angle = [&](int j) { return records_[at(j)].turn >= 0; };
  return model_.space == Space::planar && std::ranges::none_of(asked_, has_angle);
}

}  // namespace freeplay
