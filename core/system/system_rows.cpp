// System: the constraint rows of joints, gears and drivers.
#include <algorithm>
#include <cmath>

#include "system/finite.h"
#include "system/system.h"

namespace freeplay {
namespace {
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace

void System::map_row(int joint, const double* marker_row, const Evaluation& e, double* row) const {
  const JointElement& element = model_.joints[at(joint)];
  planar::body_row(marker_row, e.arms[at(element.marker_a)], row);
  planar::body_row(marker_row + 6, e.arms[at(element.marker_b)], row + 3);
}

double System::row_velocity_product(int joint, const double* marker_row, const Evaluation& e) const {
  const JointElement& element = model_.joints[at(joint)];
  double product = 0.0;
  if (body_a(joint) != ground) product += planar::velocity_product(marker_row, e.arms[at(element.marker_a)]);
  if (body_b(joint) != ground) product += planar::velocity_product(marker_row + 6, e.arms[at(element.marker_b)]);
  return product;
}

bool System::evaluate_rows(const Point& point, Evaluation& e) const {
  for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
    const Slice rows = layout_.rows(j);
    if (rows.size == 0 || model_.joints[at(j)].gear >= 0) continue;
    double* next = e.row_space.data();
    const auto part = [&next](int count) {
      const Span<double> span(next, at(count));
      std::fill_n(next, count, 0.0);
      guard::set(next += count);
      next += guard::marks;
      return span;
    };
    const Span<double> jacobian = part(12 * rows.size), phi = part(rows.size), nu = part(rows.size),
                       gamma = part(rows.size);
    ConstraintRows out{phi, jacobian, nu, gamma};
    if (!joint(j).constrain(input(j, point, e), out, e.fault.message)) {
      e.fault.kind = Fault::Kind::plugin;
      e.fault.joint = j;
      return false;
    }
    for (const Span<double>& filled : {jacobian, phi, nu, gamma}) {
      if (!guard::intact(filled.end())) return refuse(j, beside, e);
    }
    out = {phi, jacobian, nu, gamma};
    if (!is_finite(out) && markers_are_finite(j, e))
      return refuse(j, "it returned a row that is not a finite number", e);
    const int block_a = row_block_a_[at(j)], block_b = row_block_b_[at(j)];
    for (int r = 0; r < rows.size; ++r) {
      const double* marker_row = jacobian.data + 12 * r;
      const std::size_t to = at(rows.offset + r), from = at(r);
      double row[6];
      map_row(j, marker_row, e, row);
      if (block_a >= 0) std::copy_n(row, 3, &e.jacobian[at(blocks_[at(block_a)].offset + 3 * r)]);
      if (block_b >= 0) std::copy_n(row + 3, 3, &e.jacobian[at(blocks_[at(block_b)].offset + 3 * r)]);
      e.phi[to] = phi[from];
      e.nu[to] = nu[from];
      e.gamma[to] = gamma[from] - row_velocity_product(j, marker_row, e);
      if (variant_ == Variant::closed) {
        for (int i = 0; i < 3; ++i) e.nu[at(rows.offset + r)] += marker_row[6 + i] * offsets_[at(j)].velocity[i];
      }
    }
  }
  return true;
}

void System::coordinate_row(int index, const Evaluation& e, double* row, double& bias) const {
  const CoordinateRow& marker_row = e.coordinate_rows[at(index)];
  map_row(index, marker_row.jacobian, e, row);
  bias = marker_row.bias + row_velocity_product(index, marker_row.jacobian, e);
}

// Phi = s2 - ratio s1 - offset.
void System::evaluate_gear_rows(Evaluation& e) const {
  for (std::size_t g = 0; g < model_.gears.size(); ++g) {
    const Gear& gear = model_.gears[g];
    const int joints[2] = {gear.first, gear.second};
    const double factors[2] = {-gear.ratio, 1.0};
    const std::size_t r = at(layout_.rows(gear.joint).offset);
    e.phi[r] = e.coordinate[at(gear.second)] - gear.ratio * e.coordinate[at(gear.first)] - gear_offsets_[g];
    e.nu[r] = e.gamma[r] = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      double row[6], bias = 0.0;
      coordinate_row(joints[i], e, row, bias);
      e.gamma[r] -= factors[i] * bias;
      for (std::size_t c = 0; c < 6; ++c) {
        const int block = gear_blocks_[g][2 * i + c / 3];
        if (block >= 0) e.jacobian[at(blocks_[at(block)].offset) + c % 3] = factors[i] * row[c];
      }
    }
  }
}

void System::evaluate_driver_rows(Evaluation& e) const {
  for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
    const int r = layout_.driver_row(d);
    if (r < 0) continue;
    const int j = model_.drivers[at(d)].joint;
    double row[6], bias = 0.0;
    coordinate_row(j, e, row, bias);
    const TimeValue& f = e.motion[at(d)];
    double error = e.coordinate[at(j)] - f.value;
    if (motions_->modulo_turns(d)) error -= 2.0 * M_PI * std::round(error / (2.0 * M_PI));
    e.phi[at(r)] = error;
    e.nu[at(r)] = f.rate;
    e.gamma[at(r)] = f.acceleration - bias;
    const int block_a = driver_block_a_[at(d)], block_b = driver_block_b_[at(d)];
    if (block_a >= 0) std::copy_n(row, 3, e.jacobian.begin() + blocks_[at(block_a)].offset);
    if (block_b >= 0) std::copy_n(row + 3, 3, e.jacobian.begin() + blocks_[at(block_b)].offset);
  }
}

}  // namespace freeplay
