#include "system/constraints.h"

#include <algorithm>

#include "base/index.h"
#include "system/evaluation.h"
#include "system/guard_marks.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

// Turns a wrench on the first body at its marker into the opposite one on the second body at its own.
void carry_to_second(const MarkerKinematics& a, const MarkerKinematics& b, double* wrench) {
  const double d[3] = {a.position[0] - b.position[0], a.position[1] - b.position[1], a.position[2] - b.position[2]};
  for (int i = 0; i < 6; ++i) wrench[i] = -wrench[i];
  const double* f = wrench;
  wrench[3] += d[1] * f[2] - d[2] * f[1];
  wrench[4] += d[2] * f[0] - d[0] * f[2];
  wrench[5] += d[0] * f[1] - d[1] * f[0];
}

}  // namespace

Constraints::Constraints(const Model& model, const Layout& layout, const Markers& markers, const Joints& joints,
                         const Motions& motions)
    : model_(model),
      layout_(layout),
      markers_(markers),
      joints_(joints),
      jacobian_(layout),
      rows_(model.joints.size()) {
  for (int j = 0; j < static_cast<int>(rows_.size()); ++j) {
    rows_[at(j)].rows = layout.rows(j);
    if (model.joints[at(j)].gear < 0 && layout.rows(j).size > 0) add_joint(joints[j]);
  }
  for (const Gear& gear : model.gears) add_gear(gear);
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    if (layout.driver_row(d) >= 0) add_driver(d, motions.modulo_turns(d));
  }
  jacobian_.sort_rows();
}

void Constraints::add_joint(const JointRecord& joint) {
  JointRows& own = rows_[at(joint.index)];
  own.offset_a = jacobian_.add(joint.body_a, own.rows.offset, own.rows.size);
  own.offset_b = jacobian_.add(joint.body_b, own.rows.offset, own.rows.size);
  const bool declares = model_.space == Space::planar && !joint.stands_off && joint.layout->planar_rows.size > 0;
  if (declares) {
    auto& rows = own.rows.offset < layout_.nc() ? declared_ : driven_;
    rows.add(joint.layout->planar_rows, joint, own.rows.offset, own.offset_a, own.offset_b);
    return;
  }
  own.space = static_cast<int>(blank_.size());
  for (const int count : {12 * own.rows.size, own.rows.size, own.rows.size, own.rows.size}) {
    blank_.insert(blank_.end(), at(count), 0.0);
    blank_.insert(blank_.end(), guard::marks, guard::mark());
  }
  made_.push_back(joint.index);
}

void Constraints::add_gear(const Gear& gear) {
  const Slice rows = layout_.rows(gear.joint);  // none where its teeth have play
  GearRow own{rows.size > 0 ? rows.offset : -1, {gear.first, gear.second}, gear.ratio, {-1, -1, -1, -1}};
  for (std::size_t i = 0; i < 2 && own.row >= 0; ++i) {
    own.offsets[2 * i] = jacobian_.add(joints_[own.joints[i]].body_a, own.row, 1);
    own.offsets[2 * i + 1] = jacobian_.add(joints_[own.joints[i]].body_b, own.row, 1);
  }
  gears_.push_back(own);
  gear_offsets_.push_back(gear.offset.value_or(0.0));
}

void Constraints::add_driver(int driver, bool modulo_turns) {
  const JointRecord& joint = joints_[model_.drivers[at(driver)].joint];
  const int row = layout_.driver_row(driver);
  const int offset_a = jacobian_.add(joint.body_a, row, 1), offset_b = jacobian_.add(joint.body_b, row, 1);
  auto& rows = row < layout_.nc() ? driver_rows_ : driven_driver_rows_;
  rows.push_back({driver, row, joint.index, offset_a, offset_b, joint.declares_angle(), modulo_turns});
}

ConstraintValues::ConstraintValues(const Constraints& constraints)
    : phi(at(constraints.layout_.nc())),
      nu(phi.size()),
      gamma(phi.size()),
      jacobian(constraints.jacobian_.size()),
      row_space(constraints.blank_) {
  constraints.declared_.write_constants(*this);
  constraints.driven_.write_constants(*this);
  for (const auto* rows : {&constraints.driver_rows_, &constraints.driven_driver_rows_}) {
    for (const DriverRow& row : *rows) {
      if (!row.constant) continue;
      if (row.offset_a >= 0) jacobian[at(row.offset_a) + 2] = -1.0;
      if (row.offset_b >= 0) jacobian[at(row.offset_b) + 2] = 1.0;
    }
  }
}

void Constraints::fill_driven(Evaluation& e) const {
  driven_.fill_jacobian(markers_.mounts(), e, e);
  for (const DriverRow& row : driven_driver_rows_) {
    if (!row.constant) fill_driver_row(row, e);
  }
}

void Constraints::reaction(int index, const Evaluation& e, std::span<const double> lambda, double* wrench) const {
  const JointRows& own = rows_[at(index)];
  const int gear = own.rows.size > 0 ? model_.joints[at(index)].gear : -1;
  const int offset_a = gear >= 0 ? gears_[at(gear)].offsets[2] : own.offset_a;
  const int offset_b = gear >= 0 ? gears_[at(gear)].offsets[3] : own.offset_b;
  const bool second = offset_b >= 0;
  const int offset = second ? offset_b : offset_a;
  const JointRecord& joint = joints_[gear >= 0 ? gears_[at(gear)].joints[1] : index];
  double constraint[6] = {};
  if (offset >= 0) {
    by_space(model_.space, [&]<class Bodies>(Bodies) {
      constexpr int width = Bodies::velocities;
      const double* entries = &e.jacobian[at(offset)];
      double force[width] = {};
      for (int r = 0; r < own.rows.size; ++r, entries += width) {
        for (int c = 0; c < width; ++c) force[c] -= entries[c] * lambda[at(own.rows.offset + r)];
      }
      // Rows hold the marker's columns in body form: the moment about the marker is that about the centre less s x F.
      wrench_of(force, e.arms_of<Bodies>()[at(second ? joint.marker_b : joint.marker_a)], constraint);
    });
    if (!second) carry_to_second(e.markers[at(joint.marker_a)], e.markers[at(joint.marker_b)], constraint);
  }
  const double* applied = &e.wrench[12 * at(index) + 6];
  for (std::size_t i = 0; i < 6; ++i) wrench[i] = constraint[i] + applied[i];
}

}  // namespace freeplay
