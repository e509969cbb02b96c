#include "system/applied_forces.h"

#include <algorithm>
#include <ranges>

#include "base/index.h"
#include "system/evaluation.h"

namespace freeplay {

AppliedForces::AppliedForces(const Model& model, const Markers& markers, const Joints& joints)
    : model_(model), markers_(markers), joints_(joints) {
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    if (!prescribes(model.drivers[at(d)].kind)) effort_drivers_.push_back(d);
  }
}

// Inputs that were set, whatever the time.
void AppliedForces::take_inputs(const Point& point, Evaluation& e) const {
  std::size_t place = point.h.size();
  for (const int d : std::views::reverse(effort_drivers_)) {
    if (!model_.drivers[at(d)].input) continue;
    place -= Layout::numbers_of_input;
    if (point.h[place] != 0.0) e.motion[at(d)] = {point.h[place + 1], 0.0, 0.0};
  }
}

bool AppliedForces::add(const Point& point, Evaluation& e) const {
  take_inputs(point, e);
  for (const int d : effort_drivers_) add_effort(d, e);
  for (std::size_t f = 0; f < model_.forces.size(); ++f) {
    if (!add_force(f, point.t, e)) return false;
  }
  return true;
}

void AppliedForces::add_effort(int driver, Evaluation& e) const {
  const JointRecord& joint = joints_[model_.drivers[at(driver)].joint];
  const double effort = e.motion[at(driver)].value;
  const std::size_t width = model_.space == Space::planar ? planar::velocities : spatial::velocities;
  double row[2 * spatial::velocities], bias = 0.0;
  joints_.coordinate_row(joint.index, e, row, bias);
  for (std::size_t i = 0; i < width; ++i) {
    if (joint.body_a != ground) e.force[width * at(joint.body_a) + i] += effort * row[i];
    if (joint.body_b != ground) e.force[width * at(joint.body_b) + i] += effort * row[width + i];
  }
}

bool AppliedForces::add_force(std::size_t index, double t, Evaluation& e) const {
  const AppliedForce& force = model_.forces[index];
  double value[3] = {0.0, 0.0, 0.0};
  for (std::size_t i = 0; i < force.value.size(); ++i) {
    Jet jet;
    EvaluationFailure failure;
    if (!force.value[i].evaluate(t, jet, failure)) {
      e.fault.kind = Fault::Kind::motion;
      e.fault.motion = MotionFault{};
      e.fault.motion.force = static_cast<int>(index);
      e.fault.motion.id = failure.id;
      abi::copy_text(e.fault.motion.text, sizeof e.fault.motion.text, failure.reason);
      return false;
    }
    value[i] = jet.value;
  }
  const MarkerKinematics& k = e.markers[at(force.marker)];
  double wrench[6] = {};
  const bool turns = force.kind == ForceKind::torque;
  double* part = turns ? wrench + 3 : wrench;
  if (turns && force.value.size() == 1) {
    wrench[5] = value[0];
  } else if (force.frame_axes) {
    for (std::size_t r = 0; r < 3; ++r) {
      part[r] = k.rotation[3 * r] * value[0] + k.rotation[3 * r + 1] * value[1];
      if (model_.space == Space::spatial) part[r] += k.rotation[3 * r + 2] * value[2];
    }
  } else {
    std::copy_n(value, 3, part);
  }
  std::copy_n(wrench, 6, &e.applied[6 * index]);
  if (markers_.place(force.marker) != ground) markers_.apply(force.marker, wrench, e, e.force);
  return true;
}

}  // namespace freeplay
