#include "system/forces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.h"
#include "system/evaluation.h"
#include "system/finite.h"
#include "system/guard_marks.h"
#include "system/joint_derivatives.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

// Numbers of the derivatives that a joint with nz internal variables gives: see JointForces::derivatives.
constexpr std::size_t derivatives_of(std::size_t nz) { return (12 + nz) * (24 + nz); }

}  // namespace

InternalDerivatives internal_derivatives(const ForceBlock& block, int body_velocities, std::span<double> all) {
  std::size_t next = at(block.internal_offset);
  const auto take = [&](int count) {
    const auto part = all.subspan(next, at(count));
    next += at(count);
    return part;
  };
  const int nz = block.internal, columns = 2 * body_velocities;
  return {take(columns * nz), take(nz * columns), take(nz * columns), take(nz * nz)};
}

Forces::Forces(const Model& model, const Layout& layout, const Markers& markers, const Joints& joints,
               const Inertia& inertia, double size)
    : model_(model),
      layout_(layout),
      joints_(joints),
      inertia_(inertia),
      size_(size),
      applied_(model, layout, markers, joints) {
  int internal_offset = 0;
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointRecord& r = joints[j];
    if (r.layout->forces == 0) continue;
    blocks_.push_back({j, layout.unknown(r.body_a), layout.unknown(r.body_b), r.internal.size, internal_offset});
    internal_offset += r.internal.size * (6 * layout.body_velocities() + r.internal.size);
  }
  for (const ForceBlock& block : blocks_) pairs_.push_back({block.a, block.b});
  applied_.add_pairs(pairs_);
}

ForceValues::ForceValues(const Forces& forces, const Model& model)
    : force(forces.inertia_.weight().size()),
      potential(model.joints.size()),
      potential_rate(model.joints.size()),
      wrench(12 * model.joints.size()),
      internal_rate(at(forces.layout_.nz())),
      applied(6 * model.forces.size()),
      functions(forces.joints_.functions()),
      function_slopes(12 * forces.joints_.functions()),
      acts(forces.blocks_.size(), 0) {
  if (model.space == Space::spatial) gyroscopic_v.resize(9 * model.bodies.size());
  const int width = forces.layout_.body_velocities();
  force_q.resize(at(4 * width * width) * forces.pairs_.size());
  channel_space.resize(forces.applied_.channel_numbers());
  force_v.resize(force_q.size());
  for (const ForceBlock& block : forces.blocks_) {
    internal_derivatives.resize(at(block.internal_offset + block.internal * (6 * width + block.internal)));
  }
  int widest = 0;
  std::size_t most_events = 0;
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    widest = std::max(widest, forces.joints_[j].internal.size);
    most_events = std::max(most_events, forces.joints_.layout(j).events.size);
  }
  rate_space.resize(at(widest) + guard::marks);
  derivative_space.resize(derivatives_of(at(widest)) + difference_numbers(at(widest), most_events));
}

bool Forces::evaluate(const Point& point, bool derivatives, Evaluation& e) const {
  return model_.space == Space::planar ? evaluate_in<planar::Bodies>(point, derivatives, e)
                                       : evaluate_in<spatial::Bodies>(point, derivatives, e);
}

inline bool Forces::ask(const JointRecord& joint, const Point& point, bool derivatives, JointForces& out,
                        Evaluation& e) const {
  const JointInput in = Joints::input(joint, point, e);
  const JointLayout& layout = *joint.layout;
  const std::size_t nz = at(joint.internal.size), table = derivatives_of(nz);
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
  bool good = joint.joint.apply(in, out, e.fault.message);
  if (good && derivatives && layout.analytic_derivatives == 0) {
    good = difference_forces({joint.joint, layout, size_, std::span(e.derivative_space).subspan(table)}, in, out,
                             std::span(e.derivative_space).first(table), e.fault.message);
  }
  if (!good) return e.fault.blame(joint.index);
  return guard::intact(rate.end()) || e.fault.refuse(joint.index, wrote_beside);
}

template <class Bodies>
bool Forces::evaluate_in(const Point& point, bool derivatives, Evaluation& e) const {
  const Profile::Timer timer(e.profile(), Phase::joints);
  std::copy_n(inertia_.weight().data(), inertia_.weight().size(), e.force.data());
  e.acting = 0;
  JointForces out;
  bool clean = false;  // zeroed for the first that is asked, and after those that wrote into it
  const std::span<const ForceBlock> blocks(blocks_);
  const std::span<Sleep> sleeps = e.context == nullptr ? std::span<Sleep>() : std::span<Sleep>(e.context->sleeps);
  for (std::size_t f = 0; f < blocks.size(); ++f) {
    const int j = blocks[f].joint;
    const JointRecord& joint = joints_[j];
    if (at(j) < sleeps.size() && sleeps[at(j)].radius > 0.0) {
      Sleep& sleep = sleeps[at(j)];
      if (!sleep.holds(e.markers[at(joint.marker_a)], e.markers[at(joint.marker_b)])) {
        sleep.left = true;
      } else if (e.acts[f] == 0 && (!derivatives || joint.layout->analytic_derivatives != 0)) {
        e.acting = 31 * e.acting;
        e.potential[at(j)] = e.potential_rate[at(j)] = 0.0;
        if (!derivatives) continue;
        // What acts nowhere near does not change either.
        constexpr std::size_t numbers = 4 * Bodies::velocities * Bodies::velocities;
        std::fill_n(&e.force_q[numbers * f], numbers, 0.0);
        std::fill_n(&e.force_v[numbers * f], numbers, 0.0);
        continue;
      }
    }
    if (!clean) {
      for (int i = 0; i < 6; ++i) out.wrench_a[i] = out.wrench_b[i] = 0.0;
      clean = true;
    }
    if (!ask(joint, point, derivatives, out, e)) return false;
    // What neither acts nor did so before leaves everything as it was.
    if (!derivatives && joint.internal.size == 0 && e.acts[f] == 0 && rests(out) && std::isfinite(energy_of(out))) {
      e.acting = 31 * e.acting;
      e.potential[at(j)] = out.potential;
      e.potential_rate[at(j)] = out.potential_rate;
      continue;
    }
    if (!take<Bodies>(f, out, derivatives, e)) return false;
    clean = false;
  }
  if (!applied_.empty() && !applied_.add(point, derivatives, e)) return false;
  if (Bodies::velocities == spatial::velocities) {
    inertia_.add_gyroscopic(point.v, e.force, derivatives ? std::span(e.gyroscopic_v) : std::span<double>());
  }
  return true;
}

// Besides `out` it is in the work space.
template <class Bodies>
bool Forces::take(std::size_t f, const JointForces& out, bool derivatives, Evaluation& e) const {
  const int j = blocks_[f].joint;
  const JointRecord& joint = joints_[j];
  const std::size_t nz = at(joint.internal.size);
  const Span<const double> rate(e.rate_space.data(), nz), slopes(e.derivative_space.data(), derivatives_of(nz));
  std::copy(rate.begin(), rate.end(), e.internal_rate.begin() + joint.internal.offset);
  const double size = size_of(out);
  const bool given = derivatives && joint.layout->analytic_derivatives != 0;
  if (!(std::isfinite(size + energy_of(out)) && is_finite(rate) && (!given || is_finite(slopes))) &&
      are_finite(joint, e)) {
    return e.fault.refuse(j, "it returned a force, a rate or a derivative that is not a finite number");
  }
  const unsigned char acts = size != 0.0 ? 1 : 0, acted = e.acts[f];
  e.acts[f] = acts;
  e.acting = 31 * e.acting + acts;
  e.potential[at(j)] = out.potential;
  e.potential_rate[at(j)] = out.potential_rate;
  double* const wrench = &e.wrench[12 * at(j)];
  if (acts != 0 || acted != 0) {
    std::copy_n(out.wrench_a, 6, wrench);
    std::copy_n(out.wrench_b, 6, wrench + 6);
  }
  const auto& arms = e.arms_of<Bodies>();
  if (acts != 0) {  // also where it is no number
    constexpr std::size_t width = Bodies::velocities;
    if (joint.body_a != ground) {
      add_wrench(out.wrench_a, arms[at(joint.marker_a)], &e.force[width * at(joint.body_a)]);
    }
    if (joint.body_b != ground) {
      add_wrench(out.wrench_b, arms[at(joint.marker_b)], &e.force[width * at(joint.body_b)]);
    }
  }
  if (!derivatives) return true;
  constexpr std::size_t square = 4 * Bodies::velocities * Bodies::velocities;
  const typename Bodies::Arm* const ends[2] = {&arms[at(joint.marker_a)], &arms[at(joint.marker_b)]};
  force_map::to_bodies(ends, wrench, slopes.data, 24 + nz, &e.force_q[square * f], &e.force_v[square * f]);
  if (nz == 0) return true;
  force_map::to_internal(ends, slopes.data, 24 + nz, nz,
                         freeplay::internal_derivatives(blocks_[f], Bodies::velocities, e.internal_derivatives));
  return true;
}

}  // namespace freeplay
