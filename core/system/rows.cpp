// System: the constraint rows of joints, gears and drivers.
#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/index.h"
#include "system/finite.h"
#include "system/system.h"

namespace freeplay {
namespace {
constexpr std::size_t widest_joint = 6;  // rows of a joint that leaves no freedom
}  // namespace

template <class Bodies>
bool System::evaluate_rows(const Point& point, Evaluation& e) const {
  std::ranges::copy(row_blank_, e.row_space.begin());
  for (const int j : with_rows_) {
    const JointRecord& record = records_[at(j)];
    const std::size_t count = at(record.rows.size);
    double* const jacobian = &e.row_space[at(record.row_space)];
    double* const phi = jacobian + 12 * count + guard::marks;
    double* const nu = phi + count + guard::marks;
    double* const gamma = nu + count + guard::marks;
    ConstraintRows out{{phi, count}, {jacobian, 12 * count}, {nu, count}, {gamma, count}};
    if (!record.joint.constrain(input(record, point, e), out, e.fault.message)) return blame(j, e);
    for (const double* end : {phi - guard::marks, phi + count, nu + count, gamma + count}) {
      if (!guard::intact(end)) return refuse(j, beside, e);
    }
    // The marks between the parts are finite numbers.
    if (!is_finite({jacobian, at(static_cast<int>(gamma - jacobian)) + count}) && markers_are_finite(record, e)) {
      return refuse(j, "it returned a row that is not a finite number", e);
    }
    const std::size_t first = at(record.rows.offset);
    for (std::size_t r = 0; r < count; ++r) {
      e.phi[first + r] = phi[r];
      e.nu[first + r] = nu[r];
    }
    double products[widest_joint] = {};
    const auto map = [&](int block, int marker, const double* rows) {
      if (block < 0) return;
      const auto& arm = e.arms_of<Bodies>()[at(marker)];
      double* to = &e.jacobian[at(blocks_[at(block)].offset)];
      for (std::size_t r = 0; r < count; ++r) {
        body_row(rows + 12 * r, arm, to + Bodies::velocities * r);
        products[r] += velocity_product(rows + 12 * r, arm);
      }
    };
    map(record.block_a, record.marker_a, jacobian);
    map(record.block_b, record.marker_b, jacobian + 6);
    for (std::size_t r = 0; r < count; ++r) e.gamma[first + r] = gamma[r] - products[r];
    if (variant_ == Variant::closed) {
      const double* velocity = offsets_[at(j)].velocity;
      for (std::size_t r = 0; r < count; ++r) {
        for (std::size_t i = 0; i < 3; ++i) e.nu[first + r] += jacobian[12 * r + 6 + i] * velocity[i];
      }
    }
  }
  return true;
}

template <class Bodies>
void System::write_coordinate_row(int index, const Evaluation& e, double* row, double& bias) const {
  const JointRecord& record = records_[at(index)];
  const CoordinateRow& marker_row = e.coordinate_rows[at(index)];
  const auto &arm_a = e.arms_of<Bodies>()[at(record.marker_a)], &arm_b = e.arms_of<Bodies>()[at(record.marker_b)];
  body_row(marker_row.jacobian, arm_a, row);
  body_row(marker_row.jacobian + 6, arm_b, row + Bodies::velocities);
  bias = marker_row.bias;
  if (record.body_a != ground) bias += velocity_product(marker_row.jacobian, arm_a);
  if (record.body_b != ground) bias += velocity_product(marker_row.jacobian + 6, arm_b);
}

void System::coordinate_row(int index, const Evaluation& e, double* row, double& bias) const {
  by_space([&]<class Bodies>(Bodies) { write_coordinate_row<Bodies>(index, e, row, bias); });
}

void System::marker_row(int marker, const double* g, const Evaluation& e, double* row) const {
  by_space([&]<class Bodies>(Bodies) { body_row(g, e.arms_of<Bodies>()[at(marker)], row); });
}

double System::marker_row_product(int marker, const double* g, const Evaluation& e) const {
  return by_space([&]<class Bodies>(Bodies) { return velocity_product(g, e.arms_of<Bodies>()[at(marker)]); });
}

// Phi = s2 - ratio s1 - offset.
template <class Bodies>
void System::evaluate_gear_rows(Evaluation& e) const {
  constexpr std::size_t width = Bodies::velocities;
  for (std::size_t g = 0; g < model_.gears.size(); ++g) {
    const Gear& gear = model_.gears[g];
    const int joints[2] = {gear.first, gear.second};
    const double factors[2] = {-gear.ratio, 1.0};
    const std::size_t r = at(layout_.rows(gear.joint).offset);
    e.phi[r] = e.coordinate[at(gear.second)] - gear.ratio * e.coordinate[at(gear.first)] - gear_offsets_[g];
    e.nu[r] = e.gamma[r] = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      double row[2 * width], bias = 0.0;
      write_coordinate_row<Bodies>(joints[i], e, row, bias);
      e.gamma[r] -= factors[i] * bias;
      for (std::size_t c = 0; c < 2 * width; ++c) {
        const int block = gear_blocks_[g][2 * i + c / width];
        if (block >= 0) e.jacobian[at(blocks_[at(block)].offset) + c % width] = factors[i] * row[c];
      }
    }
  }
}

// Its part of Phi_q. Returns its bias.
template <class Bodies>
double System::fill_driver_row(const DriverRow& driver, Evaluation& e) const {
  constexpr int width = Bodies::velocities;
  double row[2 * width], bias = 0.0;
  write_coordinate_row<Bodies>(driver.joint, e, row, bias);
  if (driver.block_a >= 0) std::copy_n(row, width, &e.jacobian[at(driver.block_a)]);
  if (driver.block_b >= 0) std::copy_n(row + width, width, &e.jacobian[at(driver.block_b)]);
  return bias;
}

template <class Bodies>
void System::evaluate_driver_rows(Evaluation& e) const {
  for (const DriverRow& driver : driver_rows_) {
    const double bias = driver.constant ? 0.0 : fill_driver_row<Bodies>(driver, e);
    const TimeValue& f = e.motion[at(driver.driver)];
    double error = e.coordinate[at(driver.joint)] - f.value;
    if (std::abs(error) > M_PI && motions_->modulo_turns(driver.driver)) {
      error = without_turns(error);
    }
    e.phi[at(driver.row)] = error;
    e.nu[at(driver.row)] = f.rate;
    e.gamma[at(driver.row)] = f.acceleration - bias;
  }
}

template bool System::evaluate_rows<planar::Bodies>(const Point&, Evaluation&) const;
template bool System::evaluate_rows<spatial::Bodies>(const Point&, Evaluation&) const;
template void System::evaluate_gear_rows<planar::Bodies>(Evaluation&) const;
template void System::evaluate_gear_rows<spatial::Bodies>(Evaluation&) const;
template double System::fill_driver_row<planar::Bodies>(const DriverRow&, Evaluation&) const;
template void System::evaluate_driver_rows<planar::Bodies>(Evaluation&) const;
template void System::evaluate_driver_rows<spatial::Bodies>(Evaluation&) const;

}  // namespace freeplay
