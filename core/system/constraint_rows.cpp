// Constraints: rows at a point.
#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/index.h"
#include "system/evaluation.h"
#include "system/finite.h"
#include "system/guard_marks.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {
constexpr std::size_t widest_joint = 6;  // rows of a joint that leaves no freedom
}  // namespace

bool Constraints::evaluate(const Point& point, unsigned terms, bool still, Evaluation& e) const {
  if (!still) declared_.fill(markers_.mounts(), e, e);
  if (!all_declared() && !evaluate_others(point, e)) return false;
  fill_rates(terms, e);
  return true;
}

bool Constraints::evaluate_others(const Point& point, Evaluation& e) const {
  if (!made_.empty()) {
    const auto make = [&]<class Bodies>(Bodies) { return make_rows<Bodies>(point, e); };
    if (!by_space(model_.space, make)) return false;
  }
  for (std::size_t g = 0; g < gears_.size(); ++g) {
    if (gears_[g].row >= 0) evaluate_gear(gears_[g], gear_offsets_[g], e);
  }
  for (const DriverRow& row : driver_rows_) evaluate_driver(row, e);
  return true;
}

// What rows that are made one by one have written of nu and gamma already stays.
void Constraints::fill_rates(unsigned terms, Evaluation& e) const {
  if ((terms & term_velocity) != 0) {
    declared_.fill_nu(e);
    const std::size_t unknowns = at(layout_.nv());
    jacobian_.move_with_driven(e.jacobian, std::span(e.v).subspan(unknowns), e.nu);
  }
  if ((terms & term_acceleration) != 0) {
    declared_.fill_gamma(markers_.mounts(), e, e);
    jacobian_.move_with_driven(e.jacobian, e.driven_a, e.gamma);
  }
}

template <class Bodies>
bool Constraints::make_rows(const Point& point, Evaluation& e) const {
  std::ranges::copy(blank_, e.row_space.begin());
  for (const int j : made_) {
    const JointRecord& joint = joints_[j];
    const JointRows& own = rows_[at(j)];
    const std::size_t count = at(own.rows.size);
    double* const jacobian = &e.row_space[at(own.space)];
    double* const phi = jacobian + 12 * count + guard::marks;
    double* const nu = phi + count + guard::marks;
    double* const gamma = nu + count + guard::marks;
    ConstraintRows out{{phi, count}, {jacobian, 12 * count}, {nu, count}, {gamma, count}};
    if (!joint.joint.constrain(Joints::input(joint, point, e), out, e.fault.message)) return e.fault.blame(j);
    for (const double* end : {phi - guard::marks, phi + count, nu + count, gamma + count}) {
      if (!guard::intact(end)) return e.fault.refuse(j, wrote_beside);
    }
    // The marks between the parts are finite numbers.
    if (!is_finite({jacobian, at(static_cast<int>(gamma - jacobian)) + count}) && are_finite(joint, e)) {
      return e.fault.refuse(j, "it returned a row that is not a finite number");
    }
    if (joint.stands_off) joints_.untilt(j, out.jacobian);
    const std::size_t first = at(own.rows.offset);
    std::copy_n(phi, count, &e.phi[first]);
    std::copy_n(nu, count, &e.nu[first]);
    double products[widest_joint] = {};
    const auto map = [&](int offset, int marker, const double* rows) {
      if (offset < 0) return;
      const auto& arm = e.arms_of<Bodies>()[at(marker)];
      double* to = &e.jacobian[at(offset)];
      for (std::size_t r = 0; r < count; ++r) {
        body_row(rows + 12 * r, arm, to + Bodies::velocities * r);
        products[r] += velocity_product(rows + 12 * r, arm);
      }
    };
    map(own.offset_a, joint.marker_a, jacobian);
    map(own.offset_b, joint.marker_b, jacobian + 6);
    for (std::size_t r = 0; r < count; ++r) e.gamma[first + r] = gamma[r] - products[r];
    if (joints_.variant() != Variant::closed) continue;
    const InitialOffset& offset = joints_.offset(j);
    for (std::size_t r = 0; r < count; ++r) {
      for (std::size_t i = 0; i < 3; ++i) e.nu[first + r] += jacobian[12 * r + 6 + i] * offset.velocity[i];
      e.nu[first + r] += jacobian[12 * r + 11] * offset.turn_rate;
      for (std::size_t i = 0; i < 3; ++i) e.nu[first + r] += jacobian[12 * r + 9 + i] * offset.tilt_rate[i];
    }
  }
  return true;
}

// Phi = s2 - ratio s1 - offset.
void Constraints::evaluate_gear(const GearRow& gear, double offset, Evaluation& e) const {
  const std::size_t r = at(gear.row), width = at(layout_.body_velocities());
  const double factors[2] = {-gear.ratio, 1.0};
  e.phi[r] = e.coordinate[at(gear.joints[1])] - gear.ratio * e.coordinate[at(gear.joints[0])] - offset;
  e.nu[r] = e.gamma[r] = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    double row[2 * spatial::velocities], bias = 0.0;
    joints_.coordinate_row(gear.joints[i], e, row, bias);
    e.gamma[r] -= factors[i] * bias;
    for (std::size_t c = 0; c < 2 * width; ++c) {
      const int to = gear.offsets[2 * i + c / width];
      if (to >= 0) e.jacobian[at(to) + c % width] = factors[i] * row[c];
    }
  }
}

double Constraints::fill_driver_row(const DriverRow& driver, Evaluation& e) const {
  const int width = layout_.body_velocities();
  double row[2 * spatial::velocities], bias = 0.0;
  joints_.coordinate_row(driver.joint, e, row, bias);
  if (driver.offset_a >= 0) std::copy_n(row, width, &e.jacobian[at(driver.offset_a)]);
  if (driver.offset_b >= 0) std::copy_n(row + width, width, &e.jacobian[at(driver.offset_b)]);
  return bias;
}

void Constraints::evaluate_driver(const DriverRow& driver, Evaluation& e) const {
  const double bias = driver.constant ? 0.0 : fill_driver_row(driver, e);
  const TimeValue& f = e.motion[at(driver.driver)];
  double error = e.coordinate[at(driver.joint)] - f.value;
  if (std::abs(error) > M_PI && driver.modulo_turns) error = without_turns(error);
  e.phi[at(driver.row)] = error;
  e.nu[at(driver.row)] = f.rate;
  e.gamma[at(driver.row)] = f.acceleration - bias;
}

}  // namespace freeplay
