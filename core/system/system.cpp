#include "system/system.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace freeplay {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Largest distance between anything that the model places: bodies are as far apart as their markers let them be.
double model_size(const Model& model) {
  double size = 0.0;
  for (const Marker& marker : model.markers) {
    double x = marker.position[0], y = marker.position[1];
    if (marker.body != ground) {
      x -= model.bodies[at(marker.body)].com[0];
      y -= model.bodies[at(marker.body)].com[1];
    }
    size = std::max(size, std::hypot(x, y));
  }
  for (const Body& body : model.bodies) {
    if (body.position) size = std::max(size, std::hypot((*body.position)[0], (*body.position)[1]));
  }
  return size > 0.0 ? size : 1.0;
}

}  // namespace

System::System(const Model& model, Variant variant)
    : model_(model),
      variant_(variant),
      layout_(model, variant),
      motions_(std::make_shared<Motions>(model)),
      offsets_(model.joints.size(), InitialOffset{}),
      size_(model_size(model)) {
  for (const Body& body : model.bodies) {
    mass_.insert(mass_.end(), {body.mass, body.mass, body.inertia[8]});
    weight_.insert(weight_.end(), {body.mass * body.gravity[0], body.mass * body.gravity[1], 0.0});
  }
  for (const Marker& marker : model.markers) mounts_.push_back(planar::mount(model, marker));

  int offset = 0, internal_offset = 0;
  const auto add_block = [&](BodyId body, int row, int rows) {
    if (body == ground || rows == 0) return -1;
    blocks_.push_back({row, rows, body, offset});
    offset += rows * planar::velocities;
    return static_cast<int>(blocks_.size()) - 1;
  };
  records_.reserve(model.joints.size());
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointElement& element = model.joints[at(j)];
    const bool closed = variant == Variant::closed;
    const JointLayout& layout = closed ? element.ideal_layout : element.layout;
    JointRecord r;
    r.joint = closed ? element.ideal : element.joint;
    r.layout = &layout;
    r.index = j;
    r.marker_a = element.marker_a;
    r.marker_b = element.marker_b;
    r.body_a = model.markers[at(element.marker_a)].body;
    r.body_b = model.markers[at(element.marker_b)].body;
    r.stands_off = closed && element.has_play;
    r.rows = layout_.rows(j);
    r.internal = layout_.internal(j);
    r.history = layout_.history(j);
    r.turn = layout_.turn(j);
    r.coordinate_terms = term_coordinate;
    if (layout.constraint_rows > 0 && layout.rows_without_coordinate == 0) r.coordinate_terms |= term_position;
    if (layout.forces_without_coordinate == 0) {
      if (layout.forces != 0) r.coordinate_terms |= term_force;
      if (!layout.events.empty() || layout.history > 0) r.coordinate_terms |= term_event;
    }
    if (element.gear < 0 && r.rows.size > 0) {
      r.block_a = add_block(r.body_a, r.rows.offset, r.rows.size);
      r.block_b = add_block(r.body_b, r.rows.offset, r.rows.size);
      r.row_space = static_cast<int>(row_blank_.size());
      for (const int count : {12 * r.rows.size, r.rows.size, r.rows.size, r.rows.size}) {
        row_blank_.insert(row_blank_.end(), at(count), 0.0);
        row_blank_.insert(row_blank_.end(), guard::marks, guard::mark());
      }
      with_rows_.push_back(j);
    }
    if (layout.coordinate != Coordinate::none) with_coordinate_.push_back(j);
    if (layout.forces != 0) {
      force_blocks_.push_back({j, r.body_a, r.body_b, r.internal.size, internal_offset});
      internal_offset += r.internal.size * (18 + r.internal.size);
    }
    records_.push_back(r);
  }
  for (const Gear& gear : model.gears) {
    const int row = layout_.rows(gear.joint).offset;
    for (const int j : {gear.first, gear.second}) records_[at(j)].coordinate_terms |= term_position;
    gear_blocks_.push_back({add_block(body_a(gear.first), row, 1), add_block(body_b(gear.first), row, 1),
                            add_block(body_a(gear.second), row, 1), add_block(body_b(gear.second), row, 1)});
    gear_offsets_.push_back(gear.offset.value_or(0.0));
  }
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const int joint = model.drivers[at(d)].joint;
    const int row = layout_.driver_row(d);
    records_[at(joint)].coordinate_terms |= term_position | term_force;  // its rate makes the driver's power
    driver_block_a_.push_back(row < 0 ? -1 : add_block(body_a(joint), row, 1));
    driver_block_b_.push_back(row < 0 ? -1 : add_block(body_b(joint), row, 1));
  }
}

void System::take_start_of(const System& other) {
  motions_->take_starts_of(*other.motions_);
  gear_offsets_ = other.gear_offsets_;
}

InternalDerivatives::InternalDerivatives(const ForceBlock& block, std::span<double> all) {
  std::size_t next = at(block.internal_offset);
  const auto take = [&](int count) {
    const auto part = all.subspan(next, at(count));
    next += at(count);
    return part;
  };
  const int nz = block.internal;
  force_z = take(6 * nz);
  rate_q = take(6 * nz);
  rate_v = take(6 * nz);
  rate_z = take(nz * nz);
}

Evaluation::Evaluation(const System& system) {
  const Model& model = system.model_;
  const Layout& layout = system.layout_;
  const std::size_t joints = model.joints.size();
  MarkerKinematics still{};
  still.rotation[0] = still.rotation[4] = still.rotation[8] = 1.0;
  markers.assign(model.markers.size(), still);
  arms.resize(model.markers.size());
  for (std::size_t m = 0; m < markers.size(); ++m) {
    const double rest[3] = {0.0, 0.0, 0.0};
    if (model.markers[m].body != ground) continue;
    planar::marker_kinematics(system.mounts_[m], rest, rest, planar::Turn{}, markers[m], arms[m]);
  }
  phi.resize(at(layout.nc()));
  nu.resize(at(layout.nc()));
  gamma.resize(at(layout.nc()));
  force.resize(at(layout.nv()));
  std::size_t jacobian_size = 0;
  for (const JacobianBlock& block : system.blocks_) jacobian_size += at(block.rows * planar::velocities);
  jacobian.resize(jacobian_size);
  force_q.resize(36 * system.force_blocks_.size());
  force_v.resize(36 * system.force_blocks_.size());
  for (const ForceBlock& block : system.force_blocks_) {
    internal_derivatives.resize(at(block.internal_offset + block.internal * (18 + block.internal)));
  }
  coordinate.resize(joints);
  coordinate_rate.resize(joints);
  coordinate_rows.resize(joints);
  motion.resize(model.drivers.size());
  potential.resize(joints);
  potential_rate.resize(joints);
  wrench.resize(12 * joints);
  internal_rate.resize(at(layout.nz()));
  applied.resize(3 * model.forces.size());
  shifted.assign(joints, still);
  int widest = 0;
  for (std::size_t j = 0; j < joints; ++j) widest = std::max(widest, layout.internal(static_cast<int>(j)).size);
  row_space = system.row_blank_;
  rate_space.resize(at(widest) + guard::marks);
  derivative_space.resize(at((12 + widest) * (24 + widest) + 4 * widest));
  turns.resize(model.bodies.size());
  motion_time = std::numeric_limits<double>::quiet_NaN();
  place.resize(at(1 + layout.nq() + layout.nv() + layout.nz() + layout.nh()));
}

void System::add_transposed(const Evaluation& e, std::span<const double> lambda, std::span<double> out) const {
  for (const JacobianBlock& block : blocks_) {
    const double* entries = &e.jacobian[at(block.offset)];
    double* to = &out[3 * at(block.body)];
    double sum[3] = {to[0], to[1], to[2]};
    for (int r = 0; r < block.rows; ++r, entries += 3) {
      const double l = lambda[at(block.row + r)];
      for (int c = 0; c < 3; ++c) sum[c] += entries[c] * l;
    }
    std::copy_n(sum, 3, to);
  }
}

void System::multiply(const Evaluation& e, std::span<const double> v, std::span<double> out) const {
  std::ranges::fill(out, 0.0);
  for (const JacobianBlock& block : blocks_) {
    const double* entries = &e.jacobian[at(block.offset)];
    const double* from = &v[3 * at(block.body)];
    for (int r = 0; r < block.rows; ++r) {
      out[at(block.row + r)] += entries[3 * r] * from[0] + entries[3 * r + 1] * from[1] + entries[3 * r + 2] * from[2];
    }
  }
}

void System::jacobian_entries(const Evaluation& e, std::vector<SparseEntry>& out) const {
  out.clear();
  for (const JacobianBlock& block : blocks_) {
    const double* entry = &e.jacobian[at(block.offset)];
    for (int r = block.row; r < block.row + block.rows; ++r) {
      for (int c = 0; c < 3; ++c) out.emplace_back(r, 3 * block.body + c, *entry++);
    }
  }
}

void System::reaction(int index, const Evaluation& e, std::span<const double> lambda, double* wrench) const {
  // Rows hold the marker's columns in body form: the moment about the marker is that about the centre less s x F.
  double body_force[3] = {0.0, 0.0, 0.0};
  const Slice rows = layout_.rows(index);
  const int gear = model_.joints[at(index)].gear;
  const int block_a = gear >= 0 ? gear_blocks_[at(gear)][2] : records_[at(index)].block_a;
  const int block_b = gear >= 0 ? gear_blocks_[at(gear)][3] : records_[at(index)].block_b;
  const bool second = block_b >= 0;
  const int block = second ? block_b : block_a;
  const JointElement& element = model_.joints[at(gear >= 0 ? model_.gears[at(gear)].second : index)];
  if (block >= 0) {
    const double* entries = &e.jacobian[at(blocks_[at(block)].offset)];
    for (int r = 0; r < rows.size; ++r) {
      for (int c = 0; c < 3; ++c) body_force[c] -= entries[3 * r + c] * lambda[at(rows.offset + r)];
    }
    const planar::Arm& arm = e.arms[at(second ? element.marker_b : element.marker_a)];
    body_force[2] -= arm.x * body_force[1] - arm.y * body_force[0];
    if (!second) {
      // Only the first body moves: its force turned round, and the moment carried to the second marker.
      const MarkerKinematics& a = e.markers[at(element.marker_a)];
      const MarkerKinematics& b = e.markers[at(element.marker_b)];
      const double dx = a.position[0] - b.position[0], dy = a.position[1] - b.position[1];
      for (double& component : body_force) component = -component;
      body_force[2] += dx * body_force[1] - dy * body_force[0];
    }
  }
  const double* applied = &e.wrench[12 * at(index) + 6];
  for (std::size_t i = 0; i < 3; ++i) wrench[i] = body_force[i] + applied[planar::components[i]];
}

void System::marker_accelerations(int index, const Evaluation& e, std::span<const double> a,
                                  MarkerAccelerations& out) const {
  const JointElement& element = model_.joints[at(index)];
  const double rest[3] = {0.0, 0.0, 0.0};
  const auto of = [&](BodyId body) { return body == ground ? rest : &a[3 * at(body)]; };
  planar::marker_acceleration(of(body_a(index)), e.arms[at(element.marker_a)], out.a);
  planar::marker_acceleration(of(body_b(index)), e.arms[at(element.marker_b)], out.b);
}

double System::kinetic_energy(std::span<const double> v) const {
  double energy = 0.0;
  for (std::size_t i = 0; i < mass_.size(); ++i) energy += 0.5 * mass_[i] * v[i] * v[i];
  return energy;
}

double System::gravity_potential(std::span<const double> q) const {
  double energy = 0.0;
  for (std::size_t i = 0; i < weight_.size(); ++i) energy -= weight_[i] * q[i];
  return energy;
}

}  // namespace freeplay
