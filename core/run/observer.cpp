#include "run/observer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <Eigen/Geometry>

#include "base/angle.h"
#include "base/index.h"
#include "component/joint_answer.h"
#include "model/gear_teeth.h"
#include "run/energy_account.h"
#include "system/finite.h"
#include "system/path_row.h"
#include "system/tooth_forces.h"

namespace freeplay {

Observer::Observer(const System& system, const Channels& channels)
    : system_(system),
      channels_(channels),
      motion_(system.model(), system.layout(), system.markers(), system.joints()) {
  for (int j = 0; j < system.joints().count(); ++j) {
    if (!system.joints().layout(j).channels.empty()) with_own_.push_back(j);
  }
}

bool Observer::observe(const State& state, const Evaluation& e, std::span<double> row, Fault& fault) {
  const Model& model = system_.model();
  const Point point = freeplay::point(state);
  const std::span<const double> lambda = state.lambda();
  observe_loads(state, e, row);
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) observe_coordinate(j, e, row);
  for (const int j : with_own_) {
    if (!observe_own(j, point, e, lambda, row, fault)) return false;
  }
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) observe_driver(d, e, row);
  for (int k = 0; k < static_cast<int>(model.kinematics.size()); ++k) {
    if (!observe_path(k, point, e, row, fault)) return false;
  }
  for (int f = 0; f < static_cast<int>(channels_.frames.size()); ++f) observe_frame(f, e, row);
  observe_accelerations(state.a(), e, row);
  channels_.fill_formulas(row);
  return true;
}

void Observer::observe_loads(const State& state, const Evaluation& e, std::span<double> row) const {
  const Model& model = system_.model();
  const std::span<const double> lambda = state.lambda();
  row[at(channels_.time)] = state.t();
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) observe_body(b, e, row);
  double wrench[6];
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    system_.constraints().reaction(j, e, lambda, wrench);
    write_wrench(wrench, &row[at(channels_.joints[at(j)].force)]);
  }
  for (const Gear& gear : model.gears) {
    if (!has_teeth(model.joints[at(gear.joint)])) continue;
    for (const ToothWrench& one : tooth_wrenches(system_, gear, e, lambda)) {
      one.add_to(&row[at(channels_.joints[at(one.joint)].force)], 2);
    }
  }
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const int r = system_.layout().driver_row(d);
    row[at(channels_.drivers[at(d)].effort)] = r < 0 ? e.motion[at(d)].value : -lambda[at(r)];
  }
  for (int f = 0; f < static_cast<int>(model.forces.size()); ++f) observe_force(f, e, row);
  double stored = system_.inertia().gravity_potential(e.q);
  for (const double potential : e.potential) stored += potential;
  row[at(channels_.energy.kinetic)] = system_.inertia().kinetic_energy(e.v);
  row[at(channels_.energy.potential)] = stored;
}

void Observer::observe_accelerations(std::span<const double> a, const Evaluation& e, std::span<double> row) const {
  double of[6];
  for (const AskedColumn& asked : channels_.body_accelerations) {
    motion_.body_acceleration(asked.element, a, e, of);
    row[at(asked.column)] = of[asked.component];
  }
  for (const AskedColumn& asked : channels_.frame_accelerations) {
    motion_.acceleration(system_.model().settings.frames[at(asked.element)], a, e, of);
    row[at(asked.column)] = of[asked.component];
  }
}

void Observer::observe_body(int index, const Evaluation& e, std::span<double> row) const {
  double* to = &row[at(channels_.bodies[at(index)])];
  const int place = system_.layout().place(index);
  if (system_.model().space == Space::planar) {
    const double *q = &e.q[3 * at(place)], *v = &e.v[3 * at(place)];
    for (int i = 0; i < 3; ++i) to[i] = q[i], to[3 + i] = v[i];
    return;
  }
  std::copy_n(&e.q[7 * at(place)], 3, to);
  std::ranges::copy(system_.coordinates().frame_quaternion(place, e.q), to + 3);
  system_.coordinates().body_twist(place, e.q, e.v, to + 7);
}

// A wrench (6 numbers) in the columns from `to` on.
void Observer::write_wrench(const double* wrench, double* to) const {
  if (system_.model().space == Space::planar) {
    to[0] = wrench[0], to[1] = wrench[1], to[2] = wrench[5];
  } else {
    std::copy_n(wrench, 6, to);
  }
}

void Observer::observe_coordinate(int index, const Evaluation& e, std::span<double> row) const {
  const JointColumns& columns = channels_.joints[at(index)];
  if (columns.coordinate >= 0) {
    row[at(columns.coordinate)] = e.coordinate[at(index)];
    if (columns.speed >= 0) row[at(columns.speed)] = e.coordinate_rate[at(index)];
  }
  if (columns.power < 0) return;
  const JointElement& joint = system_.model().joints[at(index)];
  row[at(columns.power)] = power(&e.wrench[12 * at(index)], e.markers[at(joint.marker_a)]) +
                           power(&e.wrench[12 * at(index) + 6], e.markers[at(joint.marker_b)]);
}

bool Observer::observe_own(int index, const Point& point, const Evaluation& e, std::span<const double> lambda,
                           std::span<double> row, Fault& fault) const {
  const JointColumns& columns = channels_.joints[at(index)];
  const std::size_t own = system_.joints().layout(index).channels.size;
  const Slice rows = system_.layout().rows(index);
  const Span<double> values(row.data() + columns.own, own);
  if (system_.joints().handle(index).observe(system_.joints().input(index, point, e),
                                             {lambda.data() + rows.offset, at(rows.size)}, values, fault.message)) {
    if (is_finite(values)) return true;
    const std::size_t wild = first_wild(values);
    if (wild == own) return true;  // their sum was too large
    const char* name = system_.joints().layout(index).channels[wild].name;
    std::snprintf(fault.message.text, sizeof fault.message.text, "its channel '%s' is not a finite number", name);
  }
  fault.kind = Fault::Kind::plugin;
  fault.joint = index;
  return false;
}

void Observer::observe_driver(int index, const Evaluation& e, std::span<double> row) const {
  const DriverColumns& columns = channels_.drivers[at(index)];
  const int r = system_.layout().driver_row(index);
  const std::size_t joint = at(system_.model().drivers[at(index)].joint);
  const double prescribed = e.motion[at(index)].value;
  const double effort = row[at(columns.effort)];
  // An angle from inverse kinematics is known up to whole turns; the joint counts them.
  const bool turns = r >= 0 && system_.motions().modulo_turns(index);
  const bool speed = system_.model().drivers[at(index)].kind == DriverKind::velocity;
  row[at(columns.value)] = turns   ? e.coordinate[joint] - (r < system_.layout().nc() ? e.phi[at(r)] : 0.0)
                           : speed ? e.motion[at(index)].rate
                                   : prescribed;
  row[at(columns.power)] = effort * e.coordinate_rate[joint];
}

bool Observer::observe_path(int index, const Point& point, const Evaluation& e, std::span<double> row, Fault& fault) {
  PathPose wanted;
  if (!system_.motions().path(index, point.t, wanted, motion_work_, fault.motion)) {
    fault.kind = Fault::Kind::motion;
    return false;
  }
  const int marker = system_.model().kinematics[at(index)].marker;
  const PathColumns& columns = channels_.paths[at(index)];
  const MarkerKinematics& frame = e.markers[at(marker)];
  row[at(columns.error_x)] = frame.position[0] - wanted[0].value;
  row[at(columns.error_y)] = frame.position[1] - wanted[1].value;
  if (columns.error_z < 0) {
    row[at(columns.error_angle)] = without_turns(system_.markers().angle(marker, e.q) - wanted[2].value);
    return true;
  }
  const Vector3 turn = turn_between(wanted.turning.rotation.data(), frame.rotation);
  row[at(columns.error_z)] = frame.position[2] - wanted[2].value;
  row[at(columns.error_angle)] = std::hypot(turn[0], turn[1], turn[2]);
  return true;
}

void Observer::observe_force(int index, const Evaluation& e, std::span<double> row) const {
  const ForceColumns& columns = channels_.forces[at(index)];
  const double* applied = &e.applied[6 * at(index)];
  write_wrench(applied, &row[at(columns.force)]);
  row[at(columns.power)] = power(applied, e.markers[at(system_.model().forces[at(index)].marker)]);
}

void Observer::observe_frame(int index, const Evaluation& e, std::span<double> row) const {
  const int marker = system_.model().settings.frames[at(index)];
  const MarkerKinematics& k = e.markers[at(marker)];
  if (system_.model().space == Space::spatial) {
    double* to = &row[at(channels_.frames[at(index)])];
    std::copy_n(k.position, 3, to);
    const Eigen::Quaterniond turned(
        spatial::Matrix(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(k.rotation)));
    to[3] = turned.w(), to[4] = turned.x(), to[5] = turned.y(), to[6] = turned.z();
    std::copy_n(k.velocity, 3, to + 7);
    std::copy_n(k.angular_velocity, 3, to + 10);
    return;
  }
  const double values[6] = {k.position[0], k.position[1], system_.markers().angle(marker, e.q),
                            k.velocity[0], k.velocity[1], k.angular_velocity[2]};
  std::copy_n(values, 6, row.begin() + channels_.frames[at(index)]);
}

}  // namespace freeplay
