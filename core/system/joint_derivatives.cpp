#include "system/joint_derivatives.h"

#include <algorithm>
#include <cmath>

#include "system/planar_kinematics.h"

namespace freeplay {
namespace {

// Cube root of the rounding unit: least error of a central difference of a function of order one.
constexpr double step = 6e-6;

void turn_about_z(double angle, MarkerKinematics& k) {
  const double c = std::cos(angle), s = std::sin(angle);
  for (int column = 0; column < 3; ++column) {
    const double x = k.rotation[column], y = k.rotation[3 + column];
    k.rotation[column] = c * x - s * y;
    k.rotation[3 + column] = s * x + c * y;
  }
}

// Moves the pose (component 0..2) or twist (3..5) of a marker.
void perturb(int component, double by, MarkerKinematics& k) {
  switch (component) {
    case 0:
    case 1:
      k.position[component] += by;
      break;
    case 2:
      turn_about_z(by, k);
      break;
    case 3:
    case 4:
      k.velocity[component - 3] += by;
      break;
    default:
      k.angular_velocity[2] += by;
      break;
  }
}

// Column of the derivative table: [pose a, pose b, twist a, twist b], 6 numbers each.
std::size_t column_of(bool second, int component) {
  const int block = (component < 3 ? 0 : 12) + (second ? 6 : 0);
  return static_cast<std::size_t>(block + planar::components[component % 3]);
}

}  // namespace

bool difference_forces(const JointRef& joint, const JointInput& input, bool coordinate, std::span<double> derivatives,
                       std::span<double> work, Message& message) {
  const std::size_t nz = input.internal.size, columns = 24 + nz;
  std::ranges::fill(derivatives, 0.0);
  const auto wrench = [](const JointForces& f, std::size_t i) { return i < 6 ? f.wrench_a[i] : f.wrench_b[i - 6]; };

  const auto difference = [&](JointInput& low, JointInput& high, double width, std::size_t column) {
    JointForces below{}, above{};
    below.internal_rate = {work.data(), nz};
    above.internal_rate = {work.data() + nz, nz};
    std::fill_n(work.begin(), 2 * nz, 0.0);
    if (!joint.apply(low, below, message) || !joint.apply(high, above, message)) return false;
    for (std::size_t i = 0; i < 12; ++i) {
      derivatives[i * columns + column] = (wrench(above, i) - wrench(below, i)) / width;
    }
    for (std::size_t i = 0; i < nz; ++i) {
      derivatives[(12 + i) * columns + column] = (above.internal_rate[i] - below.internal_rate[i]) / width;
    }
    return true;
  };
  const auto follow = [&](JointInput& in) {
    if (!coordinate) return true;
    CoordinateRow row{};
    if (!joint.coordinate(in, row, message)) return false;
    in.coordinate = row.value + 2.0 * M_PI * std::round((input.coordinate - row.value) / (2.0 * M_PI));
    in.coordinate_rate = 0.0;
    for (int i = 0; i < 3; ++i) {
      in.coordinate_rate += row.jacobian[i] * in.a->velocity[i] + row.jacobian[3 + i] * in.a->angular_velocity[i] +
                            row.jacobian[6 + i] * in.b->velocity[i] + row.jacobian[9 + i] * in.b->angular_velocity[i];
    }
    return true;
  };

  for (const bool second : {false, true}) {
    for (int component = 0; component < 6; ++component) {
      MarkerKinematics low = second ? *input.b : *input.a, high = low;
      perturb(component, -step, low);
      perturb(component, step, high);
      JointInput below = input, above = input;
      (second ? below.b : below.a) = &low;
      (second ? above.b : above.a) = &high;
      if (!follow(below) || !follow(above)) return false;
      if (!difference(below, above, 2.0 * step, column_of(second, component))) return false;
    }
  }
  for (std::size_t i = 0; i < nz; ++i) {
    // Internal variables have sizes of their own (a bristle bends by microns): the step follows the value.
    const double width = step * std::max(std::abs(input.internal[i]), 1e-3);
    const std::span<double> moved = work.subspan(2 * nz, nz), raised = work.subspan(3 * nz, nz);
    std::ranges::copy(input.internal, moved.begin());
    std::ranges::copy(input.internal, raised.begin());
    moved[i] -= width;
    raised[i] += width;
    JointInput below = input, above = input;
    below.internal = {moved.data(), nz};
    above.internal = {raised.data(), nz};
    if (!difference(below, above, 2.0 * width, 24 + i)) return false;
  }
  return true;
}

}  // namespace freeplay
