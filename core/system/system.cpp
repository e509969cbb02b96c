#include "system/system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/index.h"
#include "system/joint_derivatives.h"

namespace freeplay {
namespace {

double length(const Vector3& v) { return std::hypot(std::hypot(v[0], v[1]), v[2]); }

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

planar::DeclaredRows::Ends ends_of(const JointRecord& r) { return {r.marker_a, r.marker_b, r.body_a, r.body_b}; }

std::vector<planar::DrivenBody> driven(const Model& model, Variant variant, Unknowns unknowns) {
  if (variant != Variant::released || unknowns != Unknowns::free_bodies) return {};
  return planar::driven_bodies(model);
}

// Largest distance between anything that the model places: bodies are as far apart as their markers let them be.
double model_size(const Model& model) {
  double size = 0.0;
  for (const Marker& marker : model.markers) {
    Vector3 place = marker.position;
    if (marker.body != ground) {
      for (std::size_t i = 0; i < 3; ++i) place[i] -= model.bodies[at(marker.body)].com[i];
    }
    size = std::max(size, length(place));
  }
  for (const Body& body : model.bodies) {
    if (body.position) size = std::max(size, length(*body.position));
  }
  return size > 0.0 ? size : 1.0;
}

}  // namespace

System::System(const Model& model, Variant variant, Unknowns unknowns)
    : model_(model),
      variant_(variant),
      layout_(model, variant, driven(model, variant, unknowns)),
      motions_(std::make_shared<Motions>(model)),
      coordinates_(model),
      offsets_(model.joints.size(), InitialOffset{}),
      size_(model_size(model)) {
  const bool planar = model.space == Space::planar;
  for (int place = 0; place < bodies(); ++place) {
    const Body& body = model.bodies[at(layout_.body_at(place))];
    const double m = body.mass;
    if (planar) {
      mass_.insert(mass_.end(), {m, m, body.inertia[8]});
      weight_.insert(weight_.end(), {m * body.gravity[0], m * body.gravity[1], 0.0});
      continue;
    }
    const spatial::Vector& moments = coordinates_.principal_moments(layout_.body_at(place));
    mass_.insert(mass_.end(), {m, m, m, moments[0], moments[1], moments[2]});
    weight_.insert(weight_.end(), {m * body.gravity[0], m * body.gravity[1], m * body.gravity[2], 0.0, 0.0, 0.0});
  }
  for (const Marker& marker : model.markers) {
    marker_places_.push_back(layout_.place(marker.body));
    if (planar) {
      mounts_.push_back(planar::mount(model, marker));
      continue;
    }
    spatial::Mount mount{marker.body, spatial::vector(marker.position.data()),
                         Eigen::Map<const RowMajor>(marker.rotation.data())};
    if (marker.body != ground) {
      const spatial::Matrix to_principal = coordinates_.principal_axes(marker.body).transpose();
      mount.position = to_principal * (mount.position - spatial::vector(model.bodies[at(marker.body)].com.data()));
      mount.rotation = to_principal * mount.rotation;
    }
    spatial_mounts_.push_back(mount);
  }

  int offset = 0, internal_offset = 0;
  const auto add_block = [&](BodyId body, int row, int rows) {
    if (body == ground || rows == 0) return -1;
    blocks_.push_back({row, rows, body, offset});
    if (row < layout_.nc() && unknown(body) != ground) unknown_blocks_.push_back(blocks_.back());
    for (int r = 0; row < layout_.nc() && unknown(body) == ground && r < rows; ++r) {
      couplings_.push_back({row + r, offset + r * body_velocities(), body});
    }
    offset += rows * body_velocities();
    return static_cast<int>(blocks_.size()) - 1;
  };
  const auto offset_of = [&](int block) { return block < 0 ? -1 : blocks_[at(block)].offset; };
  std::vector<int> declared;  // joints that declare their coordinate
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
    r.body_a = marker_places_[at(element.marker_a)];
    r.body_b = marker_places_[at(element.marker_b)];
    r.stands_off = closed && element.has_play;
    r.rows = layout_.rows(j);
    r.internal = layout_.internal(j);
    r.history = layout_.history(j);
    r.turn = layout_.turn(j);
    const bool may_declare = planar && !r.stands_off;
    const bool declares_rows = may_declare && layout.planar_rows.size > 0;
    r.declares_coordinate = may_declare && layout.planar_coordinate != 0;
    r.coordinate_terms = r.turn < 0 ? term_coordinate : term_coordinate | term_turn;
    if (layout.constraint_rows > 0 && layout.rows_without_coordinate == 0) r.coordinate_terms |= term_position;
    if (layout.forces_without_coordinate == 0) {
      if (layout.forces != 0) r.coordinate_terms |= term_force;
      if (!layout.events.empty() || layout.history > 0) r.coordinate_terms |= term_event;
    }
    if (element.gear < 0 && r.rows.size > 0) {
      r.block_a = add_block(r.body_a, r.rows.offset, r.rows.size);
      r.block_b = add_block(r.body_b, r.rows.offset, r.rows.size);
      if (declares_rows) {
        auto& rows = r.rows.offset < layout_.nc() ? declared_ : driven_rows_;
        rows.add_rows(layout.planar_rows, ends_of(r), r.rows.offset, offset_of(r.block_a), offset_of(r.block_b));
      } else {
        r.row_space = static_cast<int>(row_blank_.size());
        for (const int count : {12 * r.rows.size, r.rows.size, r.rows.size, r.rows.size}) {
          row_blank_.insert(row_blank_.end(), at(count), 0.0);
          row_blank_.insert(row_blank_.end(), guard::marks, guard::mark());
        }
        with_rows_.push_back(j);
      }
    }
    if (layout.coordinate != Coordinate::none) (r.declares_coordinate ? declared : with_coordinate_).push_back(j);
    if (layout.forces != 0) {
      force_blocks_.push_back({j, unknown(r.body_a), unknown(r.body_b), r.internal.size, internal_offset});
      internal_offset += r.internal.size * (6 * body_velocities() + r.internal.size);
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
    JointRecord& r = records_[at(joint)];
    const bool constant = r.declares_coordinate && r.layout->coordinate == Coordinate::angle;
    // Its rate makes the driver's power, but for driven bodies, whose motion is that of time.
    if (row < layout_.nc() || !constant) r.coordinate_terms |= term_position | term_force;
    if (row < 0) {
      effort_drivers_.push_back(d);
      continue;
    }
    const int block_a = add_block(r.body_a, row, 1), block_b = add_block(r.body_b, row, 1);
    auto& rows = row < layout_.nc() ? driver_rows_ : driven_driver_rows_;
    rows.push_back({d, row, joint, offset_of(block_a), offset_of(block_b), constant});
  }
  for (const int j : declared) {
    const JointRecord& r = records_[at(j)];
    declared_.add_coordinate(r.layout->coordinate, ends_of(r), j, r.coordinate_terms, r.turn);
  }
  sort_markers();
  sort_rows();
  for (const planar::DrivenBody& body : driven(model, variant, unknowns)) add_driven(body);
}

void System::sort_rows() {
  row_starts_.assign(at(layout_.nc()) + 1, 0);
  for (const JacobianBlock& block : unknown_blocks_) {
    for (int r = block.row; r < block.row + block.rows; ++r) ++row_starts_[at(r) + 1];
  }
  std::partial_sum(row_starts_.begin(), row_starts_.end(), row_starts_.begin());
  row_pieces_.resize(row_starts_.back());
  std::vector<std::size_t> next(row_starts_.begin(), row_starts_.end() - 1);
  const int width = body_velocities();
  for (const JacobianBlock& block : unknown_blocks_) {
    for (int r = 0; r < block.rows; ++r) {
      row_pieces_[next[at(block.row + r)]++] = {block.offset + r * width, width * block.body};
    }
  }
}

void System::sort_markers() {
  for (int m = 0; m < static_cast<int>(model_.markers.size()); ++m) {
    if (marker_places_[at(m)] != ground) moving_markers_.push_back(m);
  }
  const auto place = [&](int m) { return marker_places_[at(m)]; };
  std::ranges::stable_sort(moving_markers_, {}, place);
  const auto first_of = [&](int body) {
    return static_cast<int>(std::ranges::lower_bound(moving_markers_, body, {}, place) - moving_markers_.begin());
  };
  for (int b = 0; b < bodies(); ++b) markers_of_body_.push_back({first_of(b), first_of(b + 1)});
}

double System::marker_angle(int marker, std::span<const double> q) const {
  const BodyId place = marker_places_[at(marker)];
  return model_.markers[at(marker)].angle + (place == ground ? 0.0 : q[3 * at(place) + 2]);
}

void System::take_start_of(const System& other) {
  motions_->take_starts_of(*other.motions_);
  gear_offsets_ = other.gear_offsets_;
}

InternalDerivatives::InternalDerivatives(const ForceBlock& block, int body_velocities, std::span<double> all) {
  std::size_t next = at(block.internal_offset);
  const auto take = [&](int count) {
    const auto part = all.subspan(next, at(count));
    next += at(count);
    return part;
  };
  const int nz = block.internal, columns = 2 * body_velocities;
  force_z = take(columns * nz);
  rate_q = take(nz * columns);
  rate_v = take(nz * columns);
  rate_z = take(nz * nz);
}

Evaluation::Evaluation(const System& system, EvaluationContext* own_context) : context(own_context) {
  const Model& model = system.model_;
  const Layout& layout = system.layout_;
  const std::size_t joints = model.joints.size();
  MarkerKinematics still{};
  still.rotation[0] = still.rotation[4] = still.rotation[8] = 1.0;
  markers.assign(model.markers.size(), still);
  const bool planar = model.space == Space::planar;
  if (planar) {
    arms.resize(model.markers.size());
    turns.resize(model.bodies.size());
  } else {
    spatial_arms.resize(model.markers.size());
    spatial_turns.resize(model.bodies.size());
    gyroscopic_v.resize(9 * model.bodies.size());
  }
  for (std::size_t m = 0; m < markers.size(); ++m) {
    const double rest[7] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0}, still_body[6] = {};
    if (model.markers[m].body != ground) continue;
    if (planar) {
      planar::marker_arm(system.mounts_[m], still_body, still_body, planar::Turn{}, arms[m]);
      planar::marker_kinematics(system.mounts_[m], still_body, planar::Turn{}, arms[m], markers[m]);
    } else {
      spatial::marker_kinematics(system.spatial_mounts_[m], rest, still_body, spatial::Turn{}, markers[m],
                                 spatial_arms[m]);
    }
  }
  phi.resize(at(layout.nc()));
  nu.resize(at(layout.nc()));
  gamma.resize(at(layout.nc()));
  force.resize(system.mass_.size());
  q.resize(at(layout.body_coordinates()) * model.bodies.size());
  v.resize(system.mass_.size());
  driven_a.resize(3 * system.driven_.size());
  driven_load.resize(driven_a.size());
  std::size_t jacobian_size = 0;
  for (const JacobianBlock& block : system.blocks_) jacobian_size += at(block.rows * layout.body_velocities());
  jacobian.resize(jacobian_size);
  const std::size_t columns = at(2 * layout.body_velocities());
  force_q.resize(columns * columns * system.force_blocks_.size());
  force_v.resize(force_q.size());
  for (const ForceBlock& block : system.force_blocks_) {
    internal_derivatives.resize(
        at(block.internal_offset + block.internal * (6 * layout.body_velocities() + block.internal)));
  }
  coordinate.resize(joints);
  coordinate_rate.resize(joints);
  coordinate_rows.resize(joints);
  motion.resize(model.drivers.size());
  potential.resize(joints);
  potential_rate.resize(joints);
  wrench.resize(12 * joints);
  internal_rate.resize(at(layout.nz()));
  acts.assign(system.force_blocks().size(), 0);
  applied.resize(6 * model.forces.size());
  shifted.assign(joints, still);
  int widest = 0;
  std::size_t most_events = 0;
  for (int j = 0; j < static_cast<int>(joints); ++j) {
    widest = std::max(widest, layout.internal(j).size);
    most_events = std::max(most_events, system.joint_layout(j).events.size);
  }
  row_space = system.row_blank_;
  system.declared_.write_constants(*this);
  system.driven_rows_.write_constants(*this);
  for (const auto* rows : {&system.driver_rows_, &system.driven_driver_rows_}) {
    for (const System::DriverRow& row : *rows) {
      if (!row.constant) continue;
      if (row.block_a >= 0) jacobian[at(row.block_a) + 2] = -1.0;
      if (row.block_b >= 0) jacobian[at(row.block_b) + 2] = 1.0;
    }
  }
  rate_space.resize(at(widest) + guard::marks);
  derivative_space.resize(at((12 + widest) * (24 + widest)) + difference_numbers(at(widest), most_events));
  other_motion.resize(model.drivers.size());
  forget_motions();
  z.resize(at(layout.nz()));
  h.resize(at(layout.nh()));
}

void System::add_transposed(const Evaluation& e, std::span<const double> lambda, std::span<double> out) const {
  by_space([&]<class Bodies>(Bodies) {
    constexpr int width = Bodies::velocities;
    for (const JacobianBlock& block : unknown_blocks_) {
      const double* entries = &e.jacobian[at(block.offset)];
      double* to = &out[at(width * block.body)];
      double sum[width];
      std::copy_n(to, width, sum);
      for (int r = 0; r < block.rows; ++r, entries += width) {
        const double l = lambda[at(block.row + r)];
        for (int c = 0; c < width; ++c) sum[c] += entries[c] * l;
      }
      std::copy_n(sum, width, to);
    }
  });
}

void System::multiply(const Evaluation& e, std::span<const double> v, std::span<double> out) const {
  by_space([&]<class Bodies>(Bodies) {
    for (std::size_t r = 0; r < out.size(); ++r) {
      double sum = 0.0;
      for (const RowPiece& piece : row_pieces(r)) {
        const double *entries = &e.jacobian[at(piece.offset)], *from = &v[at(piece.velocity)];
        for (int c = 0; c < Bodies::velocities; ++c) sum += entries[c] * from[c];
      }
      out[r] = sum;
    }
  });
}

void System::jacobian_entries(const Evaluation& e, std::vector<SparseEntry>& out) const {
  const int width = body_velocities();
  out.clear();
  for (const JacobianBlock& block : unknown_blocks_) {
    const double* entry = &e.jacobian[at(block.offset)];
    for (int r = block.row; r < block.row + block.rows; ++r) {
      for (int c = 0; c < width; ++c) out.emplace_back(r, width * block.body + c, *entry++);
    }
  }
}

void System::reaction(int index, const Evaluation& e, std::span<const double> lambda, double* wrench) const {
  const Slice rows = layout_.rows(index);
  const int gear = model_.joints[at(index)].gear;
  const int block_a = gear >= 0 ? gear_blocks_[at(gear)][2] : records_[at(index)].block_a;
  const int block_b = gear >= 0 ? gear_blocks_[at(gear)][3] : records_[at(index)].block_b;
  const bool second = block_b >= 0;
  const int block = second ? block_b : block_a;
  const JointElement& element = model_.joints[at(gear >= 0 ? model_.gears[at(gear)].second : index)];
  double constraint[6] = {};
  if (block >= 0) {
    by_space([&]<class Bodies>(Bodies) {
      constexpr int width = Bodies::velocities;
      const double* entries = &e.jacobian[at(blocks_[at(block)].offset)];
      double force[width] = {};
      for (int r = 0; r < rows.size; ++r, entries += width) {
        for (int c = 0; c < width; ++c) force[c] -= entries[c] * lambda[at(rows.offset + r)];
      }
      // Rows hold the marker's columns in body form: the moment about the marker is that about the centre less s x F.
      wrench_of(force, e.arms_of<Bodies>()[at(second ? element.marker_b : element.marker_a)], constraint);
    });
    if (!second) {
      // Only the first body moves: the opposite of its force, and the moment carried to the second marker.
      const MarkerKinematics& a = e.markers[at(element.marker_a)];
      const MarkerKinematics& b = e.markers[at(element.marker_b)];
      const double d[3] = {a.position[0] - b.position[0], a.position[1] - b.position[1], a.position[2] - b.position[2]};
      for (double& component : constraint) component = -component;
      const double* f = constraint;
      constraint[3] += d[1] * f[2] - d[2] * f[1];
      constraint[4] += d[2] * f[0] - d[0] * f[2];
      constraint[5] += d[0] * f[1] - d[1] * f[0];
    }
  }
  const double* applied = &e.wrench[12 * at(index) + 6];
  for (std::size_t i = 0; i < 6; ++i) wrench[i] = constraint[i] + applied[i];
}

void System::marker_accelerations(int index, const Evaluation& e, std::span<const double> a,
                                  MarkerAccelerations& out) const {
  const JointRecord& record = records_[at(index)];
  by_space([&]<class Bodies>(Bodies) {
    const double rest[Bodies::velocities] = {};
    const auto of = [&](BodyId body) {
      if (body == ground) return rest;
      const int driven = body - layout_.free_bodies();
      return driven < 0 ? &a[Bodies::velocities * at(body)] : &e.driven_a[Bodies::velocities * at(driven)];
    };
    marker_acceleration(of(record.body_a), e.arms_of<Bodies>()[at(record.marker_a)], out.a);
    marker_acceleration(of(record.body_b), e.arms_of<Bodies>()[at(record.marker_b)], out.b);
  });
}

double System::kinetic_energy(std::span<const double> v) const {
  double energy = 0.0;
  for (std::size_t i = 0; i < mass_.size(); ++i) energy += 0.5 * mass_[i] * v[i] * v[i];
  return energy;
}

double System::gravity_potential(std::span<const double> q) const {
  double energy = 0.0;
  const std::size_t coordinates = at(body_coordinates()), velocities = at(body_velocities());
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    // Weight acts on positions, which come first in both.
    for (std::size_t i = 0; i < 3; ++i) energy -= weight_[velocities * b + i] * q[coordinates * b + i];
  }
  return energy;
}

bool System::angles_follow_bodies() const {
  const auto tells_angle = [&](int j) { return records_[at(j)].turn >= 0; };
  return model_.space == Space::planar && std::ranges::none_of(with_coordinate_, tells_angle);
}

}  // namespace freeplay
