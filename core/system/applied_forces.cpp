#include "system/applied_forces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.h"
#include "model/written_formula.h"
#include "system/evaluation.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

bool fail(Evaluation& e, int force, int driver, const EvaluationFailure& failure) {
  e.fault.kind = Fault::Kind::motion;
  e.fault.motion = MotionFault{};
  e.fault.motion.force = force;
  e.fault.motion.driver = driver;
  e.fault.motion.id = failure.id;
  abi::copy_text(e.fault.motion.text, sizeof e.fault.motion.text, failure.reason);
  return false;
}

bool fail(Evaluation& e, const Model& model, int joint, std::size_t formula, const EvaluationFailure& failure) {
  const FormulaPlace& place = model.joints[at(joint)].places[formula];
  tell_failure(place.begin, place.verbatim, failure, e.fault.message);
  return e.fault.blame(joint);
}

}  // namespace

AppliedForces::AppliedForces(const Model& model, const Layout& layout, const Markers& markers, const Joints& joints)
    : model_(model),
      layout_(layout),
      markers_(markers),
      joints_(joints),
      channels_(model, layout, markers, joints),
      load_of_force_(model.forces.size(), -1),
      load_of_driver_(model.drivers.size(), -1) {
  for (int f = 0; f < static_cast<int>(model.forces.size()); ++f) {
    add_load(model.forces[at(f)].by_motion,
             {.force = f, .own = {markers_.unknown(model.forces[at(f)].marker), ground}});
  }
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    if (prescribes(model.drivers[at(d)].kind)) continue;
    effort_drivers_.push_back(d);
    Load load{.driver = d};
    own_joint(load, model.drivers[at(d)].joint);
    add_load(model.drivers[at(d)].by_motion, load);
  }
  for (int j = 0; j < joints.count(); ++j) {
    Load load{.joint = j};
    own_joint(load, j);
    add_load(model.joints[at(j)].by_motion, load);
  }
}

void AppliedForces::own_joint(Load& load, int joint) const {
  load.own[0] = layout_.unknown(joints_[joint].body_a);
  load.own[1] = layout_.unknown(joints_[joint].body_b);
}

void AppliedForces::add_load(const MotionFormulas& formulas, const Load& of) {
  if (formulas.empty()) return;
  if (of.force >= 0) load_of_force_[at(of.force)] = static_cast<int>(loads_.size());
  if (of.driver >= 0) load_of_driver_[at(of.driver)] = static_cast<int>(loads_.size());
  has_functions_ = has_functions_ || of.joint >= 0;
  Load& load = loads_.emplace_back(of);
  load.formulas = &formulas;
  load.first_switch = static_cast<int>(switches_);
  switches_ += at(formulas.switches());
  most_channels_ = std::max(most_channels_, formulas.channels.size());
  most_formulas_ = std::max(most_formulas_, formulas.formulas.size());
}

void AppliedForces::add_pairs(std::vector<BodyPair>& pairs) {
  for (Load& load : loads_) add_pairs(load, pairs);
}

void AppliedForces::add_pairs(Load& load, std::vector<BodyPair>& pairs) const {
  const std::size_t width = at(layout_.body_velocities()), square = 4 * width * width, first = pairs.size();
  std::vector<BodyId> moved;  // bodies whose motion counts
  const auto add = [](std::vector<BodyId>& list, BodyId body) {
    if (body != ground && std::ranges::find(list, body) == list.end()) list.push_back(body);
  };
  for (const BodyId own : load.own) add(moved, own);
  for (const MotionChannel& channel : load.formulas->channels) {
    BodyId places[2];
    const int count = channels_.bodies(channel, places);
    for (int k = 0; k < count; ++k) add(moved, layout_.unknown(places[k]));
  }
  const auto offset_of = [&](BodyId row, BodyId column) {
    for (std::size_t p = first; p < pairs.size(); ++p) {
      const BodyPair& pair = pairs[p];
      if (pair.a == row && (pair.b == column || row == column)) return square * p + (row == column ? 0 : width);
      if (pair.b == row && (pair.a == column || row == column)) {
        return square * p + 2 * width * width + (row == column ? width : 0);
      }
    }
    pairs.push_back({row, row == column ? ground : column});
    return square * (pairs.size() - 1) + (row == column ? 0 : width);
  };
  // Pairs of two bodies have room for each alone.
  for (const bool alone : {false, true}) {
    for (const BodyId row : load.own) {
      for (const BodyId column : moved) {
        if (row == ground || alone != (row == column)) continue;
        const bool known = std::ranges::any_of(
            load.blocks, [&](const Block& block) { return block.row == row && block.column == column; });
        if (!known) load.blocks.push_back({row, column, offset_of(row, column)});
      }
    }
  }
  load.first_number = square * first;
  load.numbers = square * (pairs.size() - first);
}

// Inputs that were set, whatever the time.
void AppliedForces::take_inputs(const Point& point, Evaluation& e) const {
  std::size_t place = point.h.size();
  for (auto d = effort_drivers_.rbegin(); d != effort_drivers_.rend(); ++d) {
    if (!model_.drivers[at(*d)].input) continue;
    place -= Layout::numbers_of_input;
    if (point.h[place] != 0.0) e.motion[at(*d)] = {point.h[place + 1], 0.0, 0.0};
  }
}

bool AppliedForces::add(const Point& point, bool derivatives, Evaluation& e) const {
  take_inputs(point, e);
  for (const int d : effort_drivers_) {
    if (!add_effort(d, point, e)) return false;
  }
  for (std::size_t f = 0; f < model_.forces.size(); ++f) {
    if (!add_force(f, point, e)) return false;
  }
  if (derivatives) {
    for (const Load& load : loads_) {
      if (!add_derivatives(load, point, e)) return false;
    }
  }
  return true;
}

bool AppliedForces::set_functions(const Point& point, Evaluation& e) const {
  if (!has_functions_) return true;
  for (const Load& load : loads_) {
    if (load.joint < 0) continue;
    if (!values(load, point, e, &e.functions[at(joints_[load.joint].functions.offset)])) return false;
  }
  return true;
}

bool AppliedForces::add_effort(int driver, const Point& point, Evaluation& e) const {
  const JointRecord& joint = joints_[model_.drivers[at(driver)].joint];
  double effort = e.motion[at(driver)].value;
  if (const int load = load_of_driver_[at(driver)]; load >= 0) {
    if (!values(loads_[at(load)], point, e, &effort)) return false;
    e.motion[at(driver)] = {effort, 0.0, 0.0};
  }
  const std::size_t width = model_.space == Space::planar ? planar::velocities : spatial::velocities;
  double row[2 * spatial::velocities], bias = 0.0;
  joints_.coordinate_row(joint.index, e, row, bias);
  for (std::size_t i = 0; i < width; ++i) {
    if (joint.body_a != ground) e.force[width * at(joint.body_a) + i] += effort * row[i];
    if (joint.body_b != ground) e.force[width * at(joint.body_b) + i] += effort * row[width + i];
  }
  return true;
}

StateFormula::Input AppliedForces::input(const Load& load, const Point& point, const Evaluation& e,
                                         std::span<double> room) const {
  const std::vector<MotionChannel>& channels = load.formulas->channels;
  for (std::size_t k = 0; k < channels.size(); ++k) room[k] = channels_.value(channels[k], e);
  return {point.t, room.first(channels.size()), point.h.data() + layout_.switches().offset + load.first_switch};
}

bool AppliedForces::values(const Load& load, const Point& point, Evaluation& e, double* value) const {
  StateFormula::Input in = input(load, point, e, e.channel_space);
  EvaluationFailure failure;
  for (const StateFormula& formula : load.formulas->formulas) {
    if (!formula.value(in, *value++, failure)) {
      return load.joint < 0 ? fail(e, load.force, load.driver, failure)
                            : fail(e, model_, load.joint,
                                   static_cast<std::size_t>(&formula - load.formulas->formulas.data()), failure);
    }
    in.sides += formula.switches();
  }
  return true;
}

void AppliedForces::wrench_of(const AppliedForce& force, const MarkerKinematics& k, const double* value,
                              double* wrench) const {
  std::fill_n(wrench, 6, 0.0);
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
}

bool AppliedForces::add_force(std::size_t index, const Point& point, Evaluation& e) const {
  const AppliedForce& force = model_.forces[index];
  double value[3] = {0.0, 0.0, 0.0}, wrench[6];
  if (const int load = load_of_force_[index]; load >= 0) {
    if (!values(loads_[at(load)], point, e, value)) return false;
  } else {
    for (std::size_t i = 0; i < force.value.size(); ++i) {
      Jet jet;
      EvaluationFailure failure;
      if (!force.value[i].evaluate(point.t, jet, failure)) return fail(e, static_cast<int>(index), -1, failure);
      value[i] = jet.value;
    }
  }
  wrench_of(force, e.markers[at(force.marker)], value, wrench);
  std::copy_n(wrench, 6, &e.applied[6 * index]);
  if (markers_.place(force.marker) != ground) markers_.apply(force.marker, wrench, e, e.force);
  return true;
}

// The generalised forces of a load of this value on its bodies.
void AppliedForces::on_bodies(const Load& load, const double* value, const Evaluation& e,
                              double (&forces)[2][spatial::velocities]) const {
  const std::size_t width = at(layout_.body_velocities());
  if (load.joint >= 0) {
    const JointRecord& joint = joints_[load.joint];
    double wrenches[12] = {};
    for (std::size_t i = 0; i < load.formulas->formulas.size(); ++i) {
      const double* const slopes = &e.function_slopes[12 * (at(joint.functions.offset) + i)];
      for (std::size_t k = 0; k < 12; ++k) wrenches[k] += value[i] * slopes[k];
    }
    by_space(model_.space, [&]<class Bodies>(Bodies) {
      const int markers[] = {joint.marker_a, joint.marker_b};
      for (std::size_t k = 0; k < 2; ++k) {
        std::fill_n(forces[k], width, 0.0);
        add_wrench(wrenches + 6 * k, e.arms_of<Bodies>()[at(markers[k])], forces[k]);
      }
    });
    return;
  }
  if (load.force < 0) {
    double row[2 * spatial::velocities], bias = 0.0;
    joints_.coordinate_row(model_.drivers[at(load.driver)].joint, e, row, bias);
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t i = 0; i < width; ++i) forces[k][i] = *value * row[width * k + i];
    }
    return;
  }
  const AppliedForce& force = model_.forces[at(load.force)];
  double wrench[6];
  wrench_of(force, e.markers[at(force.marker)], value, wrench);
  std::fill_n(forces[0], width, 0.0);
  by_space(model_.space,
           [&]<class Bodies>(Bodies) { add_wrench(wrench, e.arms_of<Bodies>()[at(force.marker)], forces[0]); });
}

// With Q = J^T W: dQ = J^T dW/dc (dc/dq dq + dc/dv dv) over the channels c, and what turning its own body does. That
// the row of a coordinate turns, too, is left out for the effort of a driver, as for one that depends on time.
bool AppliedForces::add_derivatives(const Load& load, const Point& point, Evaluation& e) const {
  if (load.joint >= 0 && !find_slopes(load, point, e)) return false;
  const std::size_t width = at(layout_.body_velocities());
  std::fill_n(e.force_q.begin() + static_cast<std::ptrdiff_t>(load.first_number), load.numbers, 0.0);
  std::fill_n(e.force_v.begin() + static_cast<std::ptrdiff_t>(load.first_number), load.numbers, 0.0);
  const StateFormula::Input in = input(load, point, e, e.channel_space);
  const std::span<double> unit(e.channel_space.data() + most_channels_, in.variables.size());
  std::ranges::fill(unit, 0.0);
  const std::span<double> change(e.channel_space.data() + 2 * most_channels_, most_formulas_);
  std::ranges::fill(change, 0.0);
  for (std::size_t k = 0; k < in.variables.size(); ++k) {
    double forces[2][spatial::velocities];
    unit[k] = 1.0;
    StateFormula::Input own = in;
    for (std::size_t i = 0; i < load.formulas->formulas.size(); ++i) {
      change[i] = load.formulas->formulas[i].rate(own, unit, 0.0);
      own.sides += load.formulas->formulas[i].switches();
    }
    unit[k] = 0.0;
    on_bodies(load, change.data(), e, forces);
    ChannelRows rows[2];
    channels_.rows(load.formulas->channels[k], e, rows);
    for (const Block& block : load.blocks) {
      const double* const force = forces[block.row == load.own[0] ? 0 : 1];
      for (const ChannelRows& row : rows) {
        if (row.place != block.column) continue;
        for (std::size_t r = 0; r < width; ++r) {
          for (std::size_t c = 0; c < width; ++c) {
            e.force_q[block.offset + 2 * width * r + c] += force[r] * row.by_q[c];
            e.force_v[block.offset + 2 * width * r + c] += force[r] * row.by_v[c];
          }
        }
      }
    }
  }
  if (load.force >= 0 && load.own[0] != ground) add_own_turn(load, e);
  return true;
}

// Forces are linear in each function between kinks, so that differences are exact but for rounding.
bool AppliedForces::find_slopes(const Load& load, const Point& point, Evaluation& e) const {
  const JointRecord& joint = joints_[load.joint];
  const std::size_t nz = at(joint.internal.size), first = at(joint.functions.offset);
  const auto add_wrenches = [&](double share, double* slopes) {
    JointForces out{};
    std::fill_n(e.rate_space.begin(), nz, 0.0);
    out.internal_rate = {e.rate_space.data(), nz};
    if (!joint.joint.apply(Joints::input(joint, point, e), out, e.fault.message)) return e.fault.blame(joint.index);
    for (std::size_t k = 0; k < 6; ++k) {
      slopes[k] += share * out.wrench_a[k];
      slopes[6 + k] += share * out.wrench_b[k];
    }
    return true;
  };
  constexpr double part = 0x1p-20;
  for (std::size_t i = first; i < first + at(joint.functions.size); ++i) {
    double* const slopes = &e.function_slopes[12 * i];
    std::fill_n(slopes, 12, 0.0);
    const double there = e.functions[i], low = there - part * std::max(1.0, std::abs(there)),
                 high = there + part * std::max(1.0, std::abs(there));
    bool good = true;
    for (const double end : {low, high}) {
      e.functions[i] = end;
      good = good && add_wrenches((end == low ? -1.0 : 1.0) / (high - low), slopes);
    }
    e.functions[i] = there;
    if (!good) return false;
  }
  return true;
}

// A wrench that keeps its direction, or that turns with the body, as the body turns.
void AppliedForces::add_own_turn(const Load& load, Evaluation& e) const {
  const AppliedForce& force = model_.forces[at(load.force)];
  const double* const wrench = &e.applied[6 * at(load.force)];
  const auto alone = std::ranges::find(load.blocks, load.own[0], &Block::column);
  double* const by_q = &e.force_q[alone->offset];
  if (model_.space == Space::planar) {
    const planar::Arm& arm = e.arms[at(force.marker)];
    if (force.frame_axes) {
      by_q[2] -= wrench[1];
      by_q[8] += wrench[0];
    } else {
      by_q[14] -= arm.x * wrench[0] + arm.y * wrench[1];
    }
    return;
  }
  const spatial::Arm& arm = e.spatial_arms[at(force.marker)];
  for (int c = 3; c < spatial::velocities; ++c) {
    double change[spatial::velocities] = {};
    spatial::add_wrench_derivative(c, wrench, arm, change);
    if (force.frame_axes) {
      const spatial::Vector u = arm.turn.rotation.col(c - 3);
      double turned[6];
      spatial::target(turned) = u.cross(spatial::vector(wrench));
      spatial::target(turned + 3) = u.cross(spatial::vector(wrench + 3));
      spatial::add_wrench(turned, arm, change);
    }
    for (int r = 0; r < spatial::velocities; ++r) by_q[12 * r + c] += change[r];
  }
}

}  // namespace freeplay
