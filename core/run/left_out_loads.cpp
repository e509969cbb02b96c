#include "run/left_out_loads.h"

#include <cmath>

#include "base/index.h"
#include "model/gear_teeth.h"
#include "system/tooth_forces.h"

namespace freeplay {
namespace {

/// Numbers of a force or of a velocity: the plane has no third.
template <class Bodies>
constexpr int directions = Bodies::velocities == 3 ? 2 : 3;

/// Of the first numbers of a wrench or of velocities. As PeakValues has it.
template <class Bodies>
double amount(const double* x) {
  double sum = x[0] * x[0];
  for (int c = 1; c < directions<Bodies>; ++c) sum += x[c] * x[c];
  return std::sqrt(sum);
}

}  // namespace

LeftOutLoads::LeftOutLoads(const System& system, const Channels& channels) : system_(system), channels_(channels) {
  for (int j = 0; j < system.joints().count(); ++j) {
    const Slice rows = system.layout().rows(j);
    const bool second = system.constraints().offset(j, true) >= 0;
    rows_.push_back({.offset = system.constraints().offset(j, second),
                     .first = rows.offset,
                     .count = rows.size,
                     .second = second,
                     .of_gear = rows.size > 0 && system.model().joints[at(j)].gear >= 0});
  }
  for (const Gear& gear : system.model().gears) {
    if (!has_teeth(system.model().joints[at(gear.joint)])) continue;
    for (const int joint : {gear.first, gear.second}) rows_[at(joint)].of_gear = true;
  }
}

template <class Bodies>
double LeftOutLoads::force_of_gear(int joint, const Evaluation& e, std::span<const double> lambda) const {
  double wrench[6];
  system_.constraints().reaction(joint, e, lambda, wrench);
  for (const Gear& gear : system_.model().gears) {
    if (!has_teeth(system_.model().joints[at(gear.joint)])) continue;
    if (joint != gear.joint && joint != gear.first && joint != gear.second) continue;
    for (const ToothWrench& one : tooth_wrenches(system_, gear, e, lambda)) {
      if (one.joint == joint) one.add_to(wrench, 5);
    }
  }
  return amount<Bodies>(wrench);
}

// As Constraints::reaction() sums it up.
template <class Bodies>
inline double LeftOutLoads::force(int joint, const Evaluation& e, std::span<const double> lambda) const {
  const Rows& rows = rows_[at(joint)];
  if (rows.of_gear) return force_of_gear<Bodies>(joint, e, lambda);
  double sum[3] = {};
  if (rows.offset >= 0) {
    const double *entries = &e.jacobian[at(rows.offset)], *multiplier = &lambda[at(rows.first)];
    for (int r = 0; r < rows.count; ++r, entries += Bodies::velocities) {
      for (int c = 0; c < directions<Bodies>; ++c) sum[c] -= entries[c] * multiplier[r];
    }
  }
  const double* applied = &e.wrench[12 * at(joint) + 6];
  for (int c = 0; c < directions<Bodies>; ++c) sum[c] = (rows.second ? sum[c] : -sum[c]) + applied[c];
  return amount<Bodies>(sum);
}

template <class Bodies>
void LeftOutLoads::see_in(const State& state, const Evaluation& e, LargestValues& largest) const {
  const Model& model = system_.model();
  const std::span<const double> lambda = state.lambda();
  const PeakValues& places = largest.places();
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    largest.raise_before(places.speed(b), amount<Bodies>(&e.v[Bodies::velocities * at(system_.layout().place(b))]));
  }
  for (int j = 0; j < static_cast<int>(rows_.size()); ++j) {
    largest.raise_before(places.force(j), force<Bodies>(j, e, lambda));
  }
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const int r = system_.layout().driver_row(d);
    largest.raise_before(places.effort(d), std::abs(r < 0 ? e.motion[at(d)].value : lambda[at(r)]));
  }
  for (int f = 0; f < static_cast<int>(model.force_elements.size()); ++f) {
    const ForceElement& element = model.force_elements[at(f)];
    const bool of_joint = element.joint >= 0;
    const double* wrench = of_joint ? &e.wrench[12 * at(element.joint) + 6] : &e.applied[6 * at(element.applied)];
    largest.raise_before(places.applied_force(f),
                         of_joint ? force<Bodies>(element.joint, e, lambda) : amount<Bodies>(wrench));
    largest.raise_before(places.applied_torque(f),
                         Bodies::velocities == 3 ? std::abs(wrench[5]) : amount<Bodies>(wrench + 3));
  }
}

void LeftOutLoads::see(const State& state, const Evaluation& e, LargestValues& largest) const {
  by_space(system_.model().space, [&]<class Bodies>(Bodies) { see_in<Bodies>(state, e, largest); });
}

void LeftOutLoads::see_contact(int joint, std::span<const double> row, LargestValues& largest) const {
  const JointColumns& columns = channels_.joints[at(joint)];
  const auto value = [&](int column) { return column < 0 ? 0.0 : row[at(column)]; };
  const PeakValues& places = largest.places();
  largest.raise_before(places.normal_force(joint), value(columns.normal_force));
  largest.raise_before(places.penetration(joint), value(columns.penetration));
  if (columns.contact < 0 || columns.eccentricity_x < 0) return;
  const double off[3] = {value(columns.eccentricity_x), value(columns.eccentricity_y), value(columns.eccentricity_z)};
  largest.raise_before(places.eccentricity(joint), amount<spatial::Bodies>(off));
}

}  // namespace freeplay
