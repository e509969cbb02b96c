#include "assembly/closed_mechanism.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "assembly/placing.h"
#include "base/index.h"
#include "linear/row_solutions.h"

namespace freeplay {
namespace {

using Eigen::VectorXd;

constexpr double largest_turn =
    3.0;  // of a body in one step [rad]: where a row hardly turns it, Newton asks for any number

}  // namespace

void throw_fault(const Model& model, const Fault& fault) {
  if (fault.kind == Fault::Kind::motion) throw_motion_fault(model, fault.motion, Error::Category::input);
  const JointElement& joint = model.joints[at(fault.joint)];
  if (fault.of_expression()) {
    throw Error(Error::Category::input, fault.message.id, fmt::format("joint '{}': {}", joint.name, fault.message.text),
                joint.location);
  }
  throw Error(Error::Category::plugin, "plugin-failed",
              fmt::format("joint '{}' of {} failed while the model was assembled: {}", joint.name,
                          model.instances.words_of(*joint.component), fault.message.text),
              joint.location);
}

ClosedMechanism::ClosedMechanism(const System& owner)
    : system(owner.model(), Variant::closed), state(system.layout(), 0), e(system) {
  system.share_motions(owner);
  state.t() = model().settings.start;
  held_row.assign(at(system.layout().nc()), 1);
}

void ClosedMechanism::count_gears(std::vector<bool> counted, bool from_slides) {
  gear_turns_.emplace(model(), system.layout(), std::move(counted), from_slides);
}

void ClosedMechanism::stand_at(const System& other, const State& start) {
  system.take_start_of(other);
  std::ranges::copy(start.q(), state.q().begin());
  for (int j = 0; j < static_cast<int>(model().joints.size()); ++j) {
    const int turn = system.layout().turn(j), own = other.layout().turn(j);
    if (turn >= 0 && own >= 0) state.h()[at(turn)] = start.h()[at(own)];
  }
}

void ClosedMechanism::evaluate(unsigned terms) {
  if (!system.evaluate(point(state), terms | term_coordinate, e)) throw_fault(model(), e.fault);
  if (!gear_turns_ || !gear_turns_->recount(e.coordinate, state.h())) return;
  if (!system.evaluate(point(state), terms | term_coordinate, e)) throw_fault(model(), e.fault);
}

PathPose ClosedMechanism::path_pose(const PathRow& path) const {
  PathPose pose;
  MotionFault fault;
  if (!system.motions().path(path.kinematics, state.t(), pose, fault)) {
    throw_motion_fault(model(), fault, Error::Category::input);
  }
  return pose;
}

ClosedMechanism::Rows ClosedMechanism::position_rows() {
  Rows out;
  for (int r = 0; r < system.layout().nc(); ++r) {
    if (held_row[at(r)]) out.row.push_back(r);
  }
  out.path.assign(out.row.size() + leads.size(), -1);
  for (std::size_t p = 0; p < paths.size(); ++p) out.path.push_back(static_cast<int>(p));
  return assemble(std::move(out), leads, false);
}

ClosedMechanism::Rows ClosedMechanism::speed_rows(const std::vector<Lead>& leading) {
  Rows out;
  for (int r = 0; r < system.layout().nc(); ++r) out.row.push_back(r);
  out.path.assign(out.row.size() + leading.size(), -1);
  return assemble(std::move(out), leading, true);
}

// `rows` has those of the system, and by path all of them.
ClosedMechanism::Rows ClosedMechanism::assemble(Rows rows, const std::vector<Lead>& leading, bool speeds) {
  evaluate(term_position | term_velocity);
  const int nc = system.layout().nc(), nv = system.layout().nv();
  VectorXd flow(nc);
  system.jacobian().multiply(e.jacobian, state.v(), {flow.data(), at(nc)});
  const std::size_t own = rows.row.size();
  rows.row.resize(rows.path.size(), -1);
  rows.lead.assign(rows.path.size(), -1);
  for (std::size_t i = 0; i < leading.size(); ++i) rows.lead[own + i] = leading[i].joint;
  const auto count = static_cast<Eigen::Index>(rows.row.size());
  std::vector<SparseEntry> system_entries, entries;
  system.jacobian().list(e.jacobian, system_entries);
  std::vector<int> place(at(nc), -1);
  rows.residual = VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const int r = rows.row[index];
    if (r >= 0) {
      place[at(r)] = static_cast<int>(i);
      rows.residual[i] = speeds ? flow[r] - e.nu[at(r)] : e.phi[at(r)];
    } else if (rows.path[index] >= 0) {
      add_path(rows, i, entries);
    } else {
      add_lead(rows, i, leading[index - own].value, speeds, entries);
    }
  }
  for (const SparseEntry& entry : system_entries) {
    if (const int i = place[at(entry.row())]; i >= 0) entries.emplace_back(i, entry.col(), entry.value());
  }
  rows.matrix = sparse_matrix(count, nv, entries);
  return rows;
}

void ClosedMechanism::keep_turns() {
  for (int j = 0; j < static_cast<int>(model().joints.size()); ++j) {
    const int turn = system.layout().turn(j);
    if (turn >= 0) state.h()[at(turn)] = e.coordinate[at(j)];
  }
}

void ClosedMechanism::add_path(Rows& rows, Eigen::Index i, std::vector<SparseEntry>& entries) {
  const PathRow& path = paths[at(rows.path[static_cast<std::size_t>(i)])];
  double row[6];
  path.entries(system, e, row);
  const int width = system.layout().body_velocities();
  for (int c = 0; c < width && path.body != ground; ++c) entries.emplace_back(i, width * path.body + c, row[c]);
  rows.residual[i] = path.residual(system, point(state), e, path_pose(path));
}

void ClosedMechanism::add_lead(Rows& rows, Eigen::Index i, double value, bool speeds,
                               std::vector<SparseEntry>& entries) {
  const int j = rows.lead[static_cast<std::size_t>(i)];
  double row[12], bias = 0.0;
  system.joints().coordinate_row(j, e, row, bias);
  const int width = system.layout().body_velocities();
  const JointElement& joint = model().joints[at(j)];
  const int bodies[2] = {model().markers[at(joint.marker_a)].body, model().markers[at(joint.marker_b)].body};
  for (int k = 0; k < 2; ++k) {
    for (int c = 0; c < width && bodies[k] != ground; ++c) {
      entries.emplace_back(i, width * bodies[k] + c, row[width * k + c]);
    }
  }
  rows.residual[i] = (speeds ? e.coordinate_rate[at(j)] : e.coordinate[at(j)]) - value;
}

ClosedMechanism::Rows ClosedMechanism::converge() {
  const double tolerance = model().settings.assembly_tolerance;
  Rows now = position_rows();
  for (int iteration = 0; iteration < model().settings.assembly_iterations; ++iteration) {
    const double before = now.residual.norm();
    if (before == 0.0) break;
    const VectorXd step = least_norm_solution(now.matrix, -now.residual);
    const std::vector<double> q(state.q().begin(), state.q().end());
    double length = 1.0, after = before;
    for (int i = 0; i < static_cast<int>(step.size()); ++i) {
      if (system.coordinates().is_turn(i)) length = std::min(length, largest_turn / std::abs(step[i]));
    }
    for (int halving = 0; halving < 12; ++halving, length *= 0.5) {
      const VectorXd increment = length * step;
      system.coordinates().retract(q, {increment.data(), at(static_cast<int>(increment.size()))}, state.q());
      now = position_rows();
      after = now.residual.norm();
      if (after < before) break;
    }
    if (!(after < before)) {
      std::ranges::copy(q, state.q().begin());
      now = position_rows();
      break;
    }
    // Past the tolerance go on while it pays: later steps start from rounding, not from here.
    if (now.largest() <= 1e-3 * tolerance && after > 0.1 * before) break;
  }
  return now;
}

}  // namespace freeplay
