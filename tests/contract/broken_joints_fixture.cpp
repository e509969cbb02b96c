#include <algorithm>
#include <new>

#include "broken_joints.h"

namespace freeplay::test {
namespace {
constexpr Channel fields[] = {{"count", "1"}};
constexpr Event events_[] = {{"touch", Crossing::rising, 0, fields}};
constexpr Channel channels_[] = {{"depth", "m"}};
// The square about the play, and one three times as wide.
constexpr double bounds_[] = {0.01, 1, 0, 0, 0, 0, 0, 0.01, 0, 1, 0, 0, 0, 0},
                 wide_bounds_[] = {0.03, 1, 0, 0, 0, 0, 0, 0.03, 0, 1, 0, 0, 0, 0};
}  // namespace

void Cage::declare(JointLayout& layout) const {
  layout.internal_variables = relaxing_ ? 1 : 0;
  layout.history = 2;
  layout.forces = flaw_ == Flaw::undeclared_forces ? 0 : 1;
  layout.analytic_derivatives = 1;
  layout.clearance = clearance_;
  layout.play_bounds = flaw_ == Flaw::bounds_too_wide ? wide_bounds_ : bounds_;
  layout.events = events_;
  layout.channels = channels_;
  layout.time_scale = unbounded;
}

void Cage::apply(const JointInput& in, JointForces& out) const {
  const Gap gap(in);
  const bool touches = gap.delta > 0.0;
  if (relaxing_ && !out.derivatives.empty()) out.derivatives[12 * 25 + 24] = -1.0 / tau_;
  if (relaxing_) out.internal_rate[0] = ((touches ? gap.delta : 0.0) - in.internal[0]) / tau_;
  if (touches) {
    const double damping = flaw_ == Flaw::negative_damping ? -damping_ : damping_;
    double force = k_ * gap.delta + damping * gap.rate;
    if (relaxing_)
      force += (flaw_ == Flaw::bristle_pushes ? -1.0 : 1.0) * relaxing_stiffness_ * (gap.delta - in.internal[0]);
    for (int i = 0; i < 2; ++i) {
      out.wrench_b[i] = -force * gap.n[i];
      out.wrench_a[i] = force * gap.n[i];
    }
    if (flaw_ != Flaw::silent_potential) {
      out.potential = 0.5 * k_ * gap.delta * gap.delta;
      out.potential_rate = (flaw_ == Flaw::potential_rate ? 1.01 : 1.0) * k_ * gap.delta * gap.rate;
    }
    if (!out.derivatives.empty()) differentiate(gap, force, out.derivatives);
  }
  break_forces(in, out);
}

void Cage::break_forces(const JointInput& in, JointForces& out) const {
  const bool asked = !out.derivatives.empty();
  switch (flaw_) {
    case Flaw::no_reaction:
      std::fill_n(out.wrench_a, 6, 0.0);
      break;
    case Flaw::no_moment:
      // A force across the line of the origins needs a moment.
      out.wrench_b[0] += 1.0;
      out.wrench_a[0] -= 1.0;
      break;
    case Flaw::timed_force:
      for (int i = 0; i < 6; ++i)
        out.wrench_a[i] *= 1.0 + 1e-3 * std::sin(in.t), out.wrench_b[i] *= 1.0 + 1e-3 * std::sin(in.t);
      break;
    case Flaw::derivative_entry:
      if (asked) out.derivatives[6 * (24 + in.internal.size) + 7] *= 1.01;
      break;
    case Flaw::derivative_by_speed:
      if (asked) out.derivatives[7 * (24 + in.internal.size) + 18] *= 1.01;
      break;
    case Flaw::derivative_by_z:
      if (asked) out.derivatives[12 * (24 + in.internal.size) + 24] *= 1.01;
      break;
    case Flaw::force_with_derivatives:
      if (asked) out.wrench_b[5] += 1e-12, out.wrench_a[5] -= 1e-12;
      break;
    case Flaw::counts_calls:
      out.potential += ++calls_ % 3;
      break;
    case Flaw::not_a_number:
      if (in.t > 0.5) out.potential = std::numeric_limits<double>::quiet_NaN();
      break;
    case Flaw::throws:
      if (in.t > 0.5) throw std::runtime_error("the cage is broken");
      break;
    case Flaw::allocates:
      ::operator delete(::operator new(8));
      break;
    case Flaw::writes_beside_rates:
      out.internal_rate.data[out.internal_rate.size] = 1.0;
      break;
    default:
      break;
  }
}

// F_b = -f(delta, delta', z) n with f = (k + k_z) delta + d delta' - k_z z.
void Cage::differentiate(const Gap& gap, double force, Span<double> table) const {
  const std::size_t width = relaxing_ ? 25 : 24;
  const double slope = k_ + (relaxing_ ? relaxing_stiffness_ : 0.0);
  const Eigen::Matrix2d across = (Eigen::Matrix2d::Identity() - gap.n * gap.n.transpose()) / gap.distance;
  const Vector2 rate_by_e = across * gap.e_rate;
  const Eigen::Matrix2d by_e = -gap.n * (slope * gap.n + damping_ * rate_by_e).transpose() - force * across;
  const Eigen::Matrix2d by_speed = -damping_ * gap.n * gap.n.transpose();
  for (int r = 0; r < 2; ++r) {
    for (const int body : {0, 1}) {
      const double row_sign = body == 0 ? -1.0 : 1.0;
      double* row = table.data + static_cast<std::size_t>(6 * body + r) * width;
      for (int c = 0; c < 2; ++c) {
        row[c] = -row_sign * by_e(r, c);
        row[6 + c] = row_sign * by_e(r, c);
        row[12 + c] = -row_sign * by_speed(r, c);
        row[18 + c] = row_sign * by_speed(r, c);
      }
      if (relaxing_) row[24] = row_sign * relaxing_stiffness_ * gap.n[r];
    }
  }
  if (!relaxing_) return;
  double* row = table.data + 12 * width;
  for (int c = 0; c < 2; ++c) {
    row[c] = -gap.n[c] / tau_;
    row[6 + c] = gap.n[c] / tau_;
  }
}

}  // namespace freeplay::test
