// System: the forces of joints, of drivers that apply them and of the model, and their derivatives.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.h"
#include "system/finite.h"
#include "system/joint_derivatives.h"
#include "system/system.h"

namespace freeplay {
namespace {

// System has a member of the name that the kinematics give it.
template <class Arm>
void add_to_force(const double* wrench, const Arm& arm, double* force) {
  add_wrench(wrench, arm, force);
}
}  // namespace

// What a joint returned, besides `out` in the work space.
template <class Bodies>
bool System::take_forces(std::size_t f, const JointForces& out, bool derivatives, Evaluation& e) const {
  const int j = force_blocks_[f].joint;
  const JointRecord& record = records_[at(j)];
  const std::size_t nz = at(record.internal.size);
  const Span<const double> rate(e.rate_space.data(), nz), slopes(e.derivative_space.data(), (12 + nz) * (24 + nz));
  std::copy(rate.begin(), rate.end(), e.internal_rate.begin() + record.internal.offset);
  const double size = size_of(out);
  const bool given = derivatives && record.layout->analytic_derivatives != 0;
  if (!(std::isfinite(size + energy_of(out)) && is_finite(rate) && (!given || is_finite(slopes))) &&
      markers_are_finite(record, e)) {
    return refuse(j, "it returned a force, a rate or a derivative that is not a finite number", e);
  }
  const unsigned char acts = size != 0.0 ? 1 : 0, acted = e.acts[f];
  e.acts[f] = acts;
  e.acting = 31 * e.acting + acts;
  e.potential[at(j)] = out.potential;
  e.potential_rate[at(j)] = out.potential_rate;
  if (acts != 0 || acted != 0) {
    double* wrench = &e.wrench[12 * at(j)];
    std::copy_n(out.wrench_a, 6, wrench);
    std::copy_n(out.wrench_b, 6, wrench + 6);
  }
  if (acts != 0) {  // also where it is no number
    const auto& arms = e.arms_of<Bodies>();
    constexpr std::size_t width = Bodies::velocities;
    if (record.body_a != ground) {
      add_to_force(out.wrench_a, arms[at(record.marker_a)], &e.force[width * at(record.body_a)]);
    }
    if (record.body_b != ground) {
      add_to_force(out.wrench_b, arms[at(record.marker_b)], &e.force[width * at(record.body_b)]);
    }
  }
  if (derivatives) map_derivatives<Bodies>(j, f, e.derivative_space.data(), static_cast<int>(24 + nz), e);
  if (derivatives && nz > 0) map_internal<Bodies>(j, f, e.derivative_space.data(), static_cast<int>(24 + nz), e);
  return true;
}

template <class Bodies>
bool System::evaluate_forces(const Point& point, bool derivatives, Evaluation& e) const {
  const Profile::Timer timer(e.profile(), Phase::joints);
  std::ranges::copy(weight_, e.force.begin());
  e.acting = 0;
  JointForces out;
  bool clean = false;  // zeroed for the first that is asked, and after those that wrote into it
  for (std::size_t f = 0; f < force_blocks_.size(); ++f) {
    const ForceBlock& block = force_blocks_[f];
    const int j = block.joint;
    const JointRecord& record = records_[at(j)];
    if (e.context != nullptr && e.context->is_asleep(j)) {
      Sleep& sleep = e.context->sleeps[at(j)];
      if (!sleep.holds(e.markers[at(record.marker_a)], e.markers[at(record.marker_b)])) {
        sleep.left = true;
      } else if (!derivatives && e.acts[f] == 0) {
        e.acting = 31 * e.acting;
        e.potential[at(j)] = e.potential_rate[at(j)] = 0.0;
        continue;
      }
    }
    const JointInput in = input(record, point, e);
    const JointLayout& layout = *record.layout;
    const std::size_t nz = at(record.internal.size), table = (12 + nz) * (24 + nz);
    if (!clean) {
      for (int i = 0; i < 6; ++i) out.wrench_a[i] = out.wrench_b[i] = 0.0;
      clean = true;
    }
    out.potential = 0.0;
    out.potential_rate = std::numeric_limits<double>::quiet_NaN();
    out.derivatives = {};
    const Span<double> rate(e.rate_space.data(), nz);
    for (double& z : rate) z = 0.0;
    guard::set(rate.end());
    out.internal_rate = rate;
    if (derivatives && layout.analytic_derivatives != 0) {
      std::fill_n(e.derivative_space.begin(), table, 0.0);
      out.derivatives = {e.derivative_space.data(), table};
    }
    bool good = record.joint.apply(in, out, e.fault.message);
    if (good && derivatives && layout.analytic_derivatives == 0) {
      good = difference_forces({record.joint, layout, size_, std::span(e.derivative_space).subspan(table)}, in, out,
                               std::span(e.derivative_space).first(table), e.fault.message);
    }
    if (!good) return blame(j, e);
    if (!guard::intact(rate.end())) return refuse(j, beside, e);
    // What neither acts nor did so before leaves everything as it was.
    if (!derivatives && nz == 0 && e.acts[f] == 0 && rests(out) && std::isfinite(energy_of(out))) {
      e.acting = 31 * e.acting;
      e.potential[at(j)] = out.potential;
      e.potential_rate[at(j)] = out.potential_rate;
      continue;
    }
    if (!take_forces<Bodies>(f, out, derivatives, e)) return false;
    clean = false;
  }
  return true;
}

// From marker space to the columns of the two bodies: Q = J^T W, so dQ = J^T dW + dJ^T W with
// dpose = J dq, dtwist = J dv + (dJ v) and d(s x F)/dtheta = -s.F.
template <>
void System::map_derivatives<planar::Bodies>(int joint, std::size_t block, const double* marker_space, int width,
                                             Evaluation& e) const {
  const JointElement& element = model_.joints[at(joint)];
  const planar::Arm arms[2] = {e.arms[at(element.marker_a)], e.arms[at(element.marker_b)]};
  double* by_q = &e.force_q[36 * block];
  double* by_v = &e.force_v[36 * block];
  for (int i = 0; i < 2; ++i) {    // wrench on body i
    for (int k = 0; k < 2; ++k) {  // moved by body k
      double q[3][3], v[3][3];     // rows Fx Fy Mz at the marker, columns x y theta of body k
      const planar::Arm& arm = arms[k];
      for (int r = 0; r < 3; ++r) {
        const double* row = marker_space + (6 * i + planar::components[r]) * width;
        const double* pose = row + 6 * k;
        const double* twist = row + 12 + 6 * k;
        q[r][0] = pose[0];
        q[r][1] = pose[1];
        q[r][2] = pose[5] - arm.y * pose[0] + arm.x * pose[1] - (arm.x * twist[0] + arm.y * twist[1]) * arm.w;
        v[r][0] = twist[0];
        v[r][1] = twist[1];
        v[r][2] = twist[5] - arm.y * twist[0] + arm.x * twist[1];
      }
      for (int c = 0; c < 3; ++c) {
        q[2][c] += arms[i].x * q[1][c] - arms[i].y * q[0][c];
        v[2][c] += arms[i].x * v[1][c] - arms[i].y * v[0][c];
      }
      if (i == k) {
        const double* wrench = &e.wrench[12 * at(joint) + 6 * at(i)];
        q[2][2] -= arms[i].x * wrench[0] + arms[i].y * wrench[1];
      }
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
          by_q[(3 * i + r) * 6 + 3 * k + c] = q[r][c];
          by_v[(3 * i + r) * 6 + 3 * k + c] = v[r][c];
        }
      }
    }
  }
}

// The same in space.
template <>
void System::map_derivatives<spatial::Bodies>(int joint, std::size_t block, const double* marker_space, int width,
                                              Evaluation& e) const {
  const JointElement& element = model_.joints[at(joint)];
  const spatial::Arm* arms[2] = {&e.spatial_arms[at(element.marker_a)], &e.spatial_arms[at(element.marker_b)]};
  double* by_q = &e.force_q[144 * block];
  double* by_v = &e.force_v[144 * block];
  for (std::size_t i = 0; i < 2; ++i) {    // wrench on body i
    for (std::size_t k = 0; k < 2; ++k) {  // moved by body k
      for (int c = 0; c < 6; ++c) {
        double pose[6], twist[6], speed[6];
        spatial::by_increment(c, *arms[k], pose, twist);
        spatial::by_velocity(c, *arms[k], speed);
        double wrench_q[6], wrench_v[6];
        for (std::size_t r = 0; r < 6; ++r) {
          const double* row = marker_space + (6 * i + r) * at(width) + 6 * k;
          wrench_q[r] = wrench_v[r] = 0.0;
          for (std::size_t n = 0; n < 6; ++n) {
            wrench_q[r] += row[n] * pose[n] + row[12 + n] * twist[n];
            wrench_v[r] += row[12 + n] * speed[n];
          }
        }
        double force_q[6] = {}, force_v[6] = {};
        spatial::add_wrench(wrench_q, *arms[i], force_q);
        spatial::add_wrench(wrench_v, *arms[i], force_v);
        if (i == k) spatial::add_wrench_derivative(c, &e.wrench[12 * at(joint) + 6 * i], *arms[i], force_q);
        for (std::size_t r = 0; r < 6; ++r) {
          by_q[(6 * i + r) * 12 + 6 * k + at(c)] = force_q[r];
          by_v[(6 * i + r) * 12 + 6 * k + at(c)] = force_v[r];
        }
      }
    }
  }
}

// The same for z and z': rows and columns of internal variables have no arm.
template <>
void System::map_internal<planar::Bodies>(int joint, std::size_t block, const double* marker_space, int width,
                                          Evaluation& e) const {
  const JointElement& element = model_.joints[at(joint)];
  const planar::Arm arms[2] = {e.arms[at(element.marker_a)], e.arms[at(element.marker_b)]};
  const InternalDerivatives out(force_blocks_[block], planar::velocities, e.internal_derivatives);
  const std::size_t nz = at(force_blocks_[block].internal);
  const auto row = [&](std::size_t r) { return marker_space + r * at(width); };
  for (std::size_t z = 0; z < nz; ++z) {
    for (std::size_t i = 0; i < 2; ++i) {
      double wrench[3];
      for (std::size_t r = 0; r < 3; ++r) wrench[r] = row(6 * i + at(planar::components[r]))[24 + z];
      wrench[2] += arms[i].x * wrench[1] - arms[i].y * wrench[0];
      for (std::size_t r = 0; r < 3; ++r) out.force_z[(3 * i + r) * nz + z] = wrench[r];

      const double* pose = row(12 + z) + 6 * i;
      const double* twist = row(12 + z) + 12 + 6 * i;
      double* by_q = &out.rate_q[6 * z + 3 * i];
      double* by_v = &out.rate_v[6 * z + 3 * i];
      planar::body_row(twist, arms[i], by_v);
      planar::body_row(pose, arms[i], by_q);
      by_q[2] -= (arms[i].x * twist[0] + arms[i].y * twist[1]) * arms[i].w;
    }
    for (std::size_t k = 0; k < nz; ++k) out.rate_z[z * nz + k] = row(12 + z)[24 + k];
  }
}

template <>
void System::map_internal<spatial::Bodies>(int joint, std::size_t block, const double* marker_space, int width,
                                           Evaluation& e) const {
  const JointElement& element = model_.joints[at(joint)];
  const spatial::Arm* arms[2] = {&e.spatial_arms[at(element.marker_a)], &e.spatial_arms[at(element.marker_b)]};
  const InternalDerivatives out(force_blocks_[block], spatial::velocities, e.internal_derivatives);
  const std::size_t nz = at(force_blocks_[block].internal);
  const auto row = [&](std::size_t r) { return marker_space + r * at(width); };
  for (std::size_t z = 0; z < nz; ++z) {
    for (std::size_t i = 0; i < 2; ++i) {
      double wrench[6], force[6] = {};
      for (std::size_t r = 0; r < 6; ++r) wrench[r] = row(6 * i + r)[24 + z];
      spatial::add_wrench(wrench, *arms[i], force);
      for (std::size_t r = 0; r < 6; ++r) out.force_z[(6 * i + r) * nz + z] = force[r];
      const double* rate = row(12 + z) + 6 * i;
      for (int c = 0; c < 6; ++c) {
        double pose[6], twist[6], speed[6], by_q = 0.0, by_v = 0.0;
        spatial::by_increment(c, *arms[i], pose, twist);
        spatial::by_velocity(c, *arms[i], speed);
        for (std::size_t n = 0; n < 6; ++n) {
          by_q += rate[n] * pose[n] + rate[12 + n] * twist[n];
          by_v += rate[12 + n] * speed[n];
        }
        out.rate_q[12 * z + 6 * i + at(c)] = by_q;
        out.rate_v[12 * z + 6 * i + at(c)] = by_v;
      }
    }
    for (std::size_t k = 0; k < nz; ++k) out.rate_z[z * nz + k] = row(12 + z)[24 + k];
  }
}

template <class Bodies>
bool System::evaluate_applied(const Point& point, Evaluation& e) const {
  constexpr std::size_t width = Bodies::velocities;
  for (const int d : effort_drivers_) {
    const int j = model_.drivers[at(d)].joint;
    double row[2 * width], bias = 0.0;
    coordinate_row(j, e, row, bias);
    for (std::size_t i = 0; i < width; ++i) {
      if (body_a(j) != ground) e.force[width * at(body_a(j)) + i] += e.motion[at(d)].value * row[i];
      if (body_b(j) != ground) e.force[width * at(body_b(j)) + i] += e.motion[at(d)].value * row[width + i];
    }
  }
  for (std::size_t f = 0; f < model_.forces.size(); ++f) {
    const AppliedForce& force = model_.forces[f];
    double value[3] = {0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < force.value.size(); ++i) {
      Jet jet;
      EvaluationFailure failure;
      if (!force.value[i].evaluate(point.t, jet, failure)) {
        e.fault.kind = Fault::Kind::motion;
        e.fault.motion = MotionFault{};
        e.fault.motion.force = static_cast<int>(f);
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
        if (width > 3) part[r] += k.rotation[3 * r + 2] * value[2];
      }
    } else {
      std::copy_n(value, 3, part);
    }
    std::copy_n(wrench, 6, &e.applied[6 * f]);
    const BodyId body = marker_places_[at(force.marker)];
    if (body != ground) add_to_force(wrench, e.arms_of<Bodies>()[at(force.marker)], &e.force[width * at(body)]);
  }
  return true;
}

void System::add_wrench(int marker, const double* wrench, const Evaluation& e, std::span<double> force) const {
  const std::size_t body = at(marker_places_[at(marker)]), width = at(body_velocities());
  by_space([&]<class Bodies>(Bodies) { add_to_force(wrench, e.arms_of<Bodies>()[at(marker)], &force[width * body]); });
}

template bool System::evaluate_forces<planar::Bodies>(const Point&, bool, Evaluation&) const;
template bool System::evaluate_forces<spatial::Bodies>(const Point&, bool, Evaluation&) const;
template bool System::evaluate_applied<planar::Bodies>(const Point&, Evaluation&) const;
template bool System::evaluate_applied<spatial::Bodies>(const Point&, Evaluation&) const;

}  // namespace freeplay
