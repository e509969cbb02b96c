// System: the forces of joints, of drivers that apply them and of the model, and their derivatives.
#include <algorithm>
#include <cmath>

#include "system/finite.h"
#include "system/joint_derivatives.h"
#include "system/system.h"

namespace freeplay {
namespace {
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace

bool System::evaluate_forces(const Point& point, bool derivatives, Evaluation& e) const {
  const Profile::Timer timer(profile_, Phase::joints);
  std::ranges::copy(weight_, e.force.begin());
  for (std::size_t f = 0; f < force_blocks_.size(); ++f) {
    const ForceBlock& block = force_blocks_[f];
    const int j = block.joint;
    const JointRecord& record = records_[at(j)];
    const JointInput in = input(record, point, e);
    const JointLayout& layout = *record.layout;
    const std::size_t nz = at(record.internal.size), table = (12 + nz) * (24 + nz);
    JointForces out{};
    const Span<double> rate(e.rate_space.data(), nz);
    std::ranges::fill(rate, 0.0);
    guard::set(rate.end());
    out.internal_rate = rate;
    Span<double> slopes;
    if (derivatives && layout.analytic_derivatives != 0) {
      std::fill_n(e.derivative_space.begin(), table, 0.0);
      out.derivatives = slopes = {e.derivative_space.data(), table};
    }
    bool good = record.joint.apply(in, out, e.fault.message);
    if (good && derivatives && layout.analytic_derivatives == 0) {
      good = difference_forces(record.joint, in, layout.coordinate != Coordinate::none,
                               std::span(e.derivative_space).first(table), std::span(e.derivative_space).subspan(table),
                               e.fault.message);
    }
    if (!good) return blame(j, e);
    if (!guard::intact(rate.end())) return refuse(j, beside, e);
    std::ranges::copy(rate, e.internal_rate.begin() + record.internal.offset);
    if (!(is_finite(out) && is_finite(rate) && is_finite(slopes)) && markers_are_finite(record, e)) {
      return refuse(j, "it returned a force, a rate or a derivative that is not a finite number", e);
    }
    double* wrench = &e.wrench[12 * at(j)];
    std::copy_n(out.wrench_a, 6, wrench);
    std::copy_n(out.wrench_b, 6, wrench + 6);
    e.potential[at(j)] = out.potential;
    e.potential_rate[at(j)] = out.potential_rate;
    if (block.a != ground) planar::add_wrench(wrench, e.arms[at(record.marker_a)], &e.force[3 * at(block.a)]);
    if (block.b != ground) planar::add_wrench(wrench + 6, e.arms[at(record.marker_b)], &e.force[3 * at(block.b)]);
    if (derivatives) map_derivatives(j, f, e.derivative_space.data(), static_cast<int>(24 + nz), e);
    if (derivatives && nz > 0) map_internal(j, f, e.derivative_space.data(), static_cast<int>(24 + nz), e);
  }
  return true;
}

// From marker space to the columns of the two bodies: Q = J^T W, so dQ = J^T dW + dJ^T W with
// dpose = J dq, dtwist = J dv + (dJ v) and d(s x F)/dtheta = -s.F.
void System::map_derivatives(int joint, std::size_t block, const double* marker_space, int width, Evaluation& e) const {
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

// The same for z and z': rows and columns of internal variables have no arm.
void System::map_internal(int joint, std::size_t block, const double* marker_space, int width, Evaluation& e) const {
  const JointElement& element = model_.joints[at(joint)];
  const planar::Arm arms[2] = {e.arms[at(element.marker_a)], e.arms[at(element.marker_b)]};
  const InternalDerivatives out(force_blocks_[block], e.internal_derivatives);
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

bool System::evaluate_applied(const Point& point, Evaluation& e) const {
  for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
    if (layout_.driver_row(d) >= 0) continue;
    const int j = model_.drivers[at(d)].joint;
    double row[6], bias = 0.0;
    coordinate_row(j, e, row, bias);
    for (std::size_t i = 0; i < 3; ++i) {
      if (body_a(j) != ground) e.force[3 * at(body_a(j)) + i] += e.motion[at(d)].value * row[i];
      if (body_b(j) != ground) e.force[3 * at(body_b(j)) + i] += e.motion[at(d)].value * row[3 + i];
    }
  }
  for (std::size_t f = 0; f < model_.forces.size(); ++f) {
    const AppliedForce& force = model_.forces[f];
    double value[2] = {0.0, 0.0};
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
    if (force.kind == ForceKind::torque) {
      wrench[5] = value[0];
    } else if (force.frame_axes) {
      wrench[0] = k.rotation[0] * value[0] + k.rotation[1] * value[1];
      wrench[1] = k.rotation[3] * value[0] + k.rotation[4] * value[1];
    } else {
      wrench[0] = value[0];
      wrench[1] = value[1];
    }
    for (std::size_t i = 0; i < 3; ++i) e.applied[3 * f + i] = wrench[planar::components[i]];
    const BodyId body = model_.markers[at(force.marker)].body;
    if (body != ground) planar::add_wrench(wrench, e.arms[at(force.marker)], &e.force[3 * at(body)]);
  }
  return true;
}

}  // namespace freeplay
