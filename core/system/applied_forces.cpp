#include "system/applied_forces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.h"
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

}  // namespace

AppliedForces::AppliedForces(const Model& model, const Layout& layout, const Markers& markers, const Joints& joints)
    : model_(model),
      layout_(layout),
      markers_(markers),
      joints_(joints),
      channels_(model, layout, markers, joints),
      load_of_force_(model.forces.size(), -1),
      load_of_driver_(model.drivers.size(), -1) {
  for (int f = 0; f < static_cast<int>(model.forces.size()); ++f) add_load(model.forces[at(f)].by_motion, f, -1);
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    if (prescribes(model.drivers[at(d)].kind)) continue;
    effort_drivers_.push_back(d);
    add_load(model.drivers[at(d)].by_motion, -1, d);
  }
}

void AppliedForces::add_load(const MotionFormulas& formulas, int force, int driver) {
  if (formulas.empty()) return;
  (force >= 0 ? load_of_force_[at(force)] : load_of_driver_[at(driver)]) = static_cast<int>(loads_.size());
  Load& load = loads_.emplace_back();
  load.formulas = &formulas;
  load.force = force;
  load.driver = driver;
  load.first_switch = static_cast<int>(switches_);
  if (force >= 0) {
    load.own[0] = markers_.unknown(model_.forces[at(force)].marker);
  } else {
    const JointRecord& joint = joints_[model_.drivers[at(driver)].joint];
    load.own[0] = layout_.unknown(joint.body_a);
    load.own[1] = layout_.unknown(joint.body_b);
  }
  switches_ += at(formulas.switches());
  most_channels_ = std::max(most_channels_, formulas.channels.size());
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

std::string AppliedForces::words_of_switch(int index) const {
  const auto after = std::ranges::upper_bound(loads_, index, {}, &Load::first_switch);
  const Load& load = *std::prev(after);
  if (load.force >= 0) return "force '" + model_.forces[at(load.force)].name + "'";
  return "driver '" + model_.drivers[at(load.driver)].name + "'";
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
    for (const Load& load : loads_) add_derivatives(load, point, e);
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
      return fail(e, load.force, load.driver, failure);
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
void AppliedForces::add_derivatives(const Load& load, const Point& point, Evaluation& e) const {
  const std::size_t width = at(layout_.body_velocities());
  std::fill_n(e.force_q.begin() + static_cast<std::ptrdiff_t>(load.first_number), load.numbers, 0.0);
  std::fill_n(e.force_v.begin() + static_cast<std::ptrdiff_t>(load.first_number), load.numbers, 0.0);
  const StateFormula::Input in = input(load, point, e, e.channel_space);
  const std::span<double> unit(e.channel_space.data() + most_channels_, in.variables.size());
  std::ranges::fill(unit, 0.0);
  for (std::size_t k = 0; k < in.variables.size(); ++k) {
    double change[3] = {0.0, 0.0, 0.0}, forces[2][spatial::velocities];
    unit[k] = 1.0;
    StateFormula::Input own = in;
    for (std::size_t i = 0; i < load.formulas->formulas.size(); ++i) {
      change[i] = load.formulas->formulas[i].rate(own, unit, 0.0);
      own.sides += load.formulas->formulas[i].switches();
    }
    unit[k] = 0.0;
    on_bodies(load, change, e, forces);
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

void AppliedForces::decide(const Point& point, std::span<const double> a, const Evaluation& e, std::span<double> room,
                           std::span<double> values, std::span<double> rates) const {
  std::ranges::fill(values, std::numeric_limits<double>::quiet_NaN());
  std::ranges::fill(rates, std::numeric_limits<double>::quiet_NaN());
  std::size_t next = 0;
  for (const Load& load : loads_) {
    const MotionFormulas& formulas = *load.formulas;
    if (formulas.switches() == 0) continue;
    StateFormula::Input in = input(load, point, e, room);
    const std::span<double> changes = room.subspan(most_channels_, in.variables.size());
    for (std::size_t k = 0; k < changes.size(); ++k) changes[k] = channels_.rate(formulas.channels[k], a, e);
    for (const StateFormula& formula : formulas.formulas) {
      const std::size_t count = at(formula.switches());
      if (count > 0) formula.decide(in, changes, 1.0, values.subspan(next, count), rates.subspan(next, count));
      next += count;
      in.sides += count;
    }
  }
}

void AppliedForces::decide(const Point& point, const Evaluation& e, std::span<double> room,
                           std::span<double> values) const {
  std::ranges::fill(values, std::numeric_limits<double>::quiet_NaN());
  std::size_t next = 0;
  for (const Load& load : loads_) {
    if (load.formulas->switches() == 0) continue;
    StateFormula::Input in = input(load, point, e, room);
    for (const StateFormula& formula : load.formulas->formulas) {
      const std::size_t count = at(formula.switches());
      if (count > 0) formula.decide(in, values.subspan(next, count));
      next += count;
      in.sides += count;
    }
  }
}

void AppliedForces::scale(const Point& point, double size, const Evaluation& e, std::span<double> room,
                          std::span<double> scales) const {
  std::ranges::fill(scales, 0.0);
  const std::span<double> of_one = room.subspan(2 * most_channels_);
  std::size_t first = 0;
  for (const Load& load : loads_) {
    const MotionFormulas& formulas = *load.formulas;
    const StateFormula::Input in = input(load, point, e, room);
    const std::size_t channels = in.variables.size();
    const std::span<double> unit = room.subspan(most_channels_, channels);
    std::ranges::fill(unit, 0.0);
    for (std::size_t k = 0; formulas.switches() > 0 && k <= channels; ++k) {
      if (k < channels) unit[k] = channels_.turns(formulas.channels[k]) ? 1.0 / size : 1.0;
      StateFormula::Input own = in;
      std::size_t next = first;
      for (const StateFormula& formula : formulas.formulas) {
        const std::size_t count = at(formula.switches());
        const std::span<double> values = of_one.first(count), rates = of_one.subspan(count, count);
        std::ranges::fill(rates, 0.0);
        if (count > 0) formula.decide(own, unit, k < channels ? 0.0 : 1.0, values, rates);
        for (const double rate : rates) {
          if (std::isfinite(rate)) scales[next] += std::abs(rate);
          ++next;
        }
        own.sides += count;
      }
      if (k < channels) unit[k] = 0.0;
    }
    first += at(formulas.switches());
  }
}

bool AppliedForces::take_sides(const Point& point, std::span<const double> a, const Evaluation& e,
                               std::span<double> room, std::span<double> sides) const {
  const std::span<double> values = room.subspan(2 * most_channels_, sides.size());
  const std::span<double> rates = room.subspan(2 * most_channels_ + sides.size(), sides.size());
  // Rates are wanted where a switch is zero from the start on.
  decide(point, e, room, values);
  for (std::size_t s = 0; s < values.size(); ++s) {
    if (values[s] == 0.0 && sides[s] == 0.0) {
      decide(point, a, e, room, values, rates);
      break;
    }
  }
  bool changed = false;
  std::size_t next = 0;
  for (const Load& load : loads_) {
    for (const StateFormula& formula : load.formulas->formulas) {
      for (int s = 0; s < formula.switches(); ++s, ++next) {
        const double before = sides[next], value = values[next];
        if (value > 0.0 || value < 0.0) {
          sides[next] = value > 0.0 ? 1.0 : -1.0;
          changed = changed || (before != 0.0 && before != sides[next]);
        } else if (value == 0.0 && before == 0.0) {
          sides[next] = formula.side_at_zero(s, rates[next]);
          changed = true;
        }
      }
    }
  }
  return changed;
}

}  // namespace freeplay
