#include "system/system.h"

#include <algorithm>
#include <cmath>

#include "system/joint_derivatives.h"

namespace freeplay {
namespace {

constexpr int widest_joint = 6;  // rows of a joint that leaves no freedom
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

double rate_of(const double* row, const MarkerKinematics& a, const MarkerKinematics& b) {
  double rate = 0.0;
  for (int i = 0; i < 3; ++i) {
    rate += row[i] * a.velocity[i] + row[3 + i] * a.angular_velocity[i] + row[6 + i] * b.velocity[i] +
            row[9 + i] * b.angular_velocity[i];
  }
  return rate;
}

// A sum is finite only if every term is; differences of infinities are not finite either.
bool is_finite(const JointForces& f) {
  double sum = f.potential + (std::isnan(f.potential_rate) ? 0.0 : f.potential_rate);
  for (int i = 0; i < 6; ++i) sum += f.wrench_a[i] + f.wrench_b[i];
  return std::isfinite(sum);
}
bool is_finite(Span<double> numbers) {
  double sum = 0.0;
  for (const double x : numbers) sum += x;
  return std::isfinite(sum);
}
bool is_finite(const ConstraintRows& rows) {
  return is_finite(rows.phi) && is_finite(rows.jacobian) && is_finite(rows.nu) && is_finite(rows.gamma);
}
bool is_finite(const MarkerKinematics& k) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += k.position[i] + k.velocity[i] + k.angular_velocity[i];
  return std::isfinite(sum);
}

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
      needs_coordinate_(model.joints.size(), 0),
      has_forces_(model.joints.size(), 0),
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
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const bool is_gear = model.joints[at(j)].gear >= 0;
    const Slice rows = is_gear ? Slice{} : layout_.rows(j);
    row_block_a_.push_back(add_block(body_a(j), rows.offset, rows.size));
    row_block_b_.push_back(add_block(body_b(j), rows.offset, rows.size));
    const bool rows_read_it = joint_layout(j).constraint_rows > 0 && joint_layout(j).rows_without_coordinate == 0;
    if (joint_layout(j).coordinate != Coordinate::none && rows_read_it) needs_coordinate_[at(j)] = 1;
    if (joint_layout(j).forces != 0) {
      has_forces_[at(j)] = 1;
      const int nz = layout_.internal(j).size;
      force_blocks_.push_back({j, body_a(j), body_b(j), nz, internal_offset});
      internal_offset += nz * (18 + nz);
      if (joint_layout(j).coordinate != Coordinate::none) needs_coordinate_[at(j)] = 1;
    }
  }
  for (const Gear& gear : model.gears) {
    const int row = layout_.rows(gear.joint).offset;
    needs_coordinate_[at(gear.first)] = needs_coordinate_[at(gear.second)] = 1;
    gear_blocks_.push_back({add_block(body_a(gear.first), row, 1), add_block(body_b(gear.first), row, 1),
                            add_block(body_a(gear.second), row, 1), add_block(body_b(gear.second), row, 1)});
    gear_offsets_.push_back(gear.offset.value_or(0.0));
  }
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const int joint = model.drivers[at(d)].joint;
    needs_coordinate_[at(joint)] = 1;
    const int row = layout_.driver_row(d);
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
  motion.resize(model.drivers.size());
  potential.resize(joints);
  potential_rate.resize(joints);
  wrench.resize(12 * joints);
  internal_rate.resize(at(layout.nz()));
  applied.resize(3 * model.forces.size());
  shifted.assign(joints, still);
  int widest = 0;
  for (std::size_t j = 0; j < joints; ++j) widest = std::max(widest, layout.internal(static_cast<int>(j)).size);
  row_space.resize(at(15 * widest_joint) + 4 * guard::marks);
  rate_space.resize(at(widest) + guard::marks);
  derivative_space.resize(at((12 + widest) * (24 + widest) + 4 * widest));
  turns.resize(model.bodies.size());
  motion_time = std::numeric_limits<double>::quiet_NaN();
}

const JointRef& System::joint(int index) const {
  const JointElement& element = model_.joints[at(index)];
  return variant_ == Variant::closed ? element.ideal : element.joint;
}
const JointLayout& System::joint_layout(int index) const {
  const JointElement& element = model_.joints[at(index)];
  return variant_ == Variant::closed ? element.ideal_layout : element.layout;
}
BodyId System::body_a(int joint) const { return model_.markers[at(model_.joints[at(joint)].marker_a)].body; }
BodyId System::body_b(int joint) const { return model_.markers[at(model_.joints[at(joint)].marker_b)].body; }

bool System::evaluate(const Point& point, unsigned terms, Evaluation& e) const {
  e.fault.kind = Fault::Kind::none;
  for (std::size_t b = 0; b < e.turns.size(); ++b) {
    const double angle = point.q[3 * b + 2];
    e.turns[b] = {std::cos(angle), std::sin(angle)};
  }
  for (std::size_t m = 0; m < mounts_.size(); ++m) {
    const BodyId body = mounts_[m].body;
    if (body == ground) continue;
    planar::marker_kinematics(mounts_[m], &point.q[3 * at(body)], &point.v[3 * at(body)], e.turns[at(body)],
                              e.markers[m], e.arms[m]);
  }
  if (variant_ == Variant::closed) {
    for (std::size_t j = 0; j < model_.joints.size(); ++j) {
      if (!model_.joints[j].has_play) continue;
      MarkerKinematics& k = e.shifted[j] = e.markers[at(model_.joints[j].marker_b)];
      for (int i = 0; i < 3; ++i) {
        k.position[i] -= offsets_[j].position[i];
        k.velocity[i] -= offsets_[j].velocity[i];
      }
    }
  }
  if (!model_.drivers.empty() && e.motion_time != point.t) {
    e.motion_time = std::numeric_limits<double>::quiet_NaN();
    if (!motions_->evaluate(point.t, {e.motion.data(), e.motion.size()}, e.fault.motion)) {
      e.fault.kind = Fault::Kind::motion;
      return false;
    }
    e.motion_time = point.t;
  }
  if (!evaluate_coordinates(point, (terms & term_coordinate) != 0, e)) return false;
  if ((terms & term_position) != 0 &&
      !(evaluate_rows(point, e) && evaluate_gear_rows(point, e) && evaluate_driver_rows(point, e))) {
    return false;
  }
  if ((terms & term_force) != 0) {
    return evaluate_forces(point, (terms & term_derivative) != 0, e) && evaluate_applied(point, e);
  }
  return true;
}

JointInput System::input(int index, const Point& point, const Evaluation& e) const {
  const JointElement& element = model_.joints[at(index)];
  const bool stands_off = variant_ == Variant::closed && element.has_play;
  const Slice internal = layout_.internal(index), history = layout_.history(index);
  return {point.t,
          &e.markers[at(element.marker_a)],
          stands_off ? &e.shifted[at(index)] : &e.markers[at(element.marker_b)],
          e.coordinate[at(index)],
          e.coordinate_rate[at(index)],
          {point.z.data() + internal.offset, at(internal.size)},
          {point.h.data() + history.offset, at(history.size)},
          per_contact_};
}

bool System::evaluate_coordinates(const Point& point, bool all, Evaluation& e) const {
  for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
    if (joint_layout(j).coordinate == Coordinate::none || !(all || needs_coordinate_[at(j)])) continue;
    const JointInput in = input(j, point, e);
    CoordinateRow row{};
    if (!joint(j).coordinate(in, row, e.fault.message)) {
      e.fault.kind = Fault::Kind::plugin;
      e.fault.joint = j;
      return false;
    }
    if (!std::isfinite(row.value) && markers_are_finite(j, e)) {
      return refuse(j, "it returned a coordinate that is not a finite number", e);
    }
    if (const int turn = layout_.turn(j); turn >= 0) {
      // The turn nearest to the last accepted angle: a step never turns a joint by more than half a revolution.
      row.value += 2.0 * M_PI * std::round((point.h[at(turn)] - row.value) / (2.0 * M_PI));
    }
    e.coordinate[at(j)] = row.value;
    e.coordinate_rate[at(j)] = rate_of(row.jacobian, *in.a, *in.b);
  }
  return true;
}

void System::map_row(int joint, const double* marker_row, const Evaluation& e, double* row) const {
  const JointElement& element = model_.joints[at(joint)];
  planar::body_row(marker_row, e.arms[at(element.marker_a)], row);
  planar::body_row(marker_row + 6, e.arms[at(element.marker_b)], row + 3);
}

double System::row_velocity_product(int joint, const double* marker_row, const Evaluation& e) const {
  const JointElement& element = model_.joints[at(joint)];
  double product = 0.0;
  if (body_a(joint) != ground) product += planar::velocity_product(marker_row, e.arms[at(element.marker_a)]);
  if (body_b(joint) != ground) product += planar::velocity_product(marker_row + 6, e.arms[at(element.marker_b)]);
  return product;
}

constexpr const char* beside = "it wrote beside the numbers that it was given to fill";

/// Notes what a joint has done wrong. A point that is no number itself is nobody's fault but the iteration's.
bool System::refuse(int joint, const char* why, Evaluation& e) {
  abi::copy_text(e.fault.message.text, sizeof e.fault.message.text, why);
  e.fault.kind = Fault::Kind::plugin;
  e.fault.joint = joint;
  return false;
}

bool System::markers_are_finite(int joint, const Evaluation& e) const {
  const JointElement& element = model_.joints[at(joint)];
  return is_finite(e.markers[at(element.marker_a)]) && is_finite(e.markers[at(element.marker_b)]);
}

bool System::evaluate_rows(const Point& point, Evaluation& e) const {
  for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
    const Slice rows = layout_.rows(j);
    if (rows.size == 0 || model_.joints[at(j)].gear >= 0) continue;
    double* next = e.row_space.data();
    const auto part = [&next](int count) {
      const Span<double> span(next, at(count));
      std::fill_n(next, count, 0.0);
      guard::set(next += count);
      next += guard::marks;
      return span;
    };
    const Span<double> jacobian = part(12 * rows.size), phi = part(rows.size), nu = part(rows.size),
                       gamma = part(rows.size);
    ConstraintRows out{phi, jacobian, nu, gamma};
    if (!joint(j).constrain(input(j, point, e), out, e.fault.message)) {
      e.fault.kind = Fault::Kind::plugin;
      e.fault.joint = j;
      return false;
    }
    for (const Span<double>& filled : {jacobian, phi, nu, gamma}) {
      if (!guard::intact(filled.end())) return refuse(j, beside, e);
    }
    out = {phi, jacobian, nu, gamma};
    std::ranges::copy(phi, e.phi.begin() + rows.offset);
    std::ranges::copy(nu, e.nu.begin() + rows.offset);
    std::ranges::copy(gamma, e.gamma.begin() + rows.offset);
    if (!is_finite(out) && markers_are_finite(j, e))
      return refuse(j, "it returned a row that is not a finite number", e);
    const int block_a = row_block_a_[at(j)], block_b = row_block_b_[at(j)];
    for (int r = 0; r < rows.size; ++r) {
      const double* marker_row = jacobian.data + 12 * r;
      double row[6];
      map_row(j, marker_row, e, row);
      if (block_a >= 0) std::copy_n(row, 3, e.jacobian.begin() + blocks_[at(block_a)].offset + 3 * r);
      if (block_b >= 0) std::copy_n(row + 3, 3, e.jacobian.begin() + blocks_[at(block_b)].offset + 3 * r);
      e.gamma[at(rows.offset + r)] -= row_velocity_product(j, marker_row, e);
      if (variant_ == Variant::closed) {
        for (int i = 0; i < 3; ++i) e.nu[at(rows.offset + r)] += marker_row[6 + i] * offsets_[at(j)].velocity[i];
      }
    }
  }
  return true;
}

bool System::coordinate_row(int index, const Point& point, Evaluation& e, CoordinateRow& marker_row, double* row,
                            double& bias) const {
  marker_row = CoordinateRow{};
  if (!joint(index).coordinate(input(index, point, e), marker_row, e.fault.message)) {
    e.fault.kind = Fault::Kind::plugin;
    e.fault.joint = index;
    return false;
  }
  map_row(index, marker_row.jacobian, e, row);
  bias = marker_row.bias + row_velocity_product(index, marker_row.jacobian, e);
  return true;
}

// Phi = s2 - ratio s1 - offset.
bool System::evaluate_gear_rows(const Point& point, Evaluation& e) const {
  for (std::size_t g = 0; g < model_.gears.size(); ++g) {
    const Gear& gear = model_.gears[g];
    const int joints[2] = {gear.first, gear.second};
    const double factors[2] = {-gear.ratio, 1.0};
    const std::size_t r = at(layout_.rows(gear.joint).offset);
    e.phi[r] = e.coordinate[at(gear.second)] - gear.ratio * e.coordinate[at(gear.first)] - gear_offsets_[g];
    e.nu[r] = e.gamma[r] = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      CoordinateRow marker_row;
      double row[6], bias = 0.0;
      if (!coordinate_row(joints[i], point, e, marker_row, row, bias)) return false;
      e.gamma[r] -= factors[i] * bias;
      for (std::size_t c = 0; c < 6; ++c) {
        const int block = gear_blocks_[g][2 * i + c / 3];
        if (block >= 0) e.jacobian[at(blocks_[at(block)].offset) + c % 3] = factors[i] * row[c];
      }
    }
  }
  return true;
}

bool System::evaluate_driver_rows(const Point& point, Evaluation& e) const {
  for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
    const int r = layout_.driver_row(d);
    if (r < 0) continue;
    const int j = model_.drivers[at(d)].joint;
    CoordinateRow marker_row;
    double row[6], bias = 0.0;
    if (!coordinate_row(j, point, e, marker_row, row, bias)) return false;
    const TimeValue& f = e.motion[at(d)];
    double error = e.coordinate[at(j)] - f.value;
    if (motions_->modulo_turns(d)) error -= 2.0 * M_PI * std::round(error / (2.0 * M_PI));
    e.phi[at(r)] = error;
    e.nu[at(r)] = f.rate;
    e.gamma[at(r)] = f.acceleration - bias;
    const int block_a = driver_block_a_[at(d)], block_b = driver_block_b_[at(d)];
    if (block_a >= 0) std::copy_n(row, 3, e.jacobian.begin() + blocks_[at(block_a)].offset);
    if (block_b >= 0) std::copy_n(row + 3, 3, e.jacobian.begin() + blocks_[at(block_b)].offset);
  }
  return true;
}

bool System::evaluate_forces(const Point& point, bool derivatives, Evaluation& e) const {
  std::ranges::copy(weight_, e.force.begin());
  for (std::size_t f = 0; f < force_blocks_.size(); ++f) {
    const ForceBlock& block = force_blocks_[f];
    const int j = block.joint;
    const JointInput in = input(j, point, e);
    const JointLayout& layout = joint_layout(j);
    const Slice internal = layout_.internal(j);
    const std::size_t nz = at(internal.size), table = (12 + nz) * (24 + nz);
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
    bool good = joint(j).apply(in, out, e.fault.message);
    if (good && derivatives && layout.analytic_derivatives == 0) {
      good = difference_forces(joint(j), in, layout.coordinate != Coordinate::none,
                               std::span(e.derivative_space).first(table), std::span(e.derivative_space).subspan(table),
                               e.fault.message);
    }
    if (!good) {
      e.fault.kind = Fault::Kind::plugin;
      e.fault.joint = j;
      return false;
    }
    if (!guard::intact(rate.end())) return refuse(j, beside, e);
    std::ranges::copy(rate, e.internal_rate.begin() + internal.offset);
    if (!(is_finite(out) && is_finite(rate) && is_finite(slopes)) && markers_are_finite(j, e)) {
      return refuse(j, "it returned a force, a rate or a derivative that is not a finite number", e);
    }
    double* wrench = &e.wrench[12 * at(j)];
    std::copy_n(out.wrench_a, 6, wrench);
    std::copy_n(out.wrench_b, 6, wrench + 6);
    e.potential[at(j)] = out.potential;
    e.potential_rate[at(j)] = out.potential_rate;
    const JointElement& element = model_.joints[at(j)];
    if (block.a != ground) planar::add_wrench(wrench, e.arms[at(element.marker_a)], &e.force[3 * at(block.a)]);
    if (block.b != ground) planar::add_wrench(wrench + 6, e.arms[at(element.marker_b)], &e.force[3 * at(block.b)]);
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
    CoordinateRow marker_row;
    double row[6], bias = 0.0;
    if (!coordinate_row(j, point, e, marker_row, row, bias)) return false;
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

void System::add_transposed(const Evaluation& e, std::span<const double> lambda, std::span<double> out) const {
  for (const JacobianBlock& block : blocks_) {
    const double* entries = &e.jacobian[at(block.offset)];
    double* to = &out[3 * at(block.body)];
    for (int r = 0; r < block.rows; ++r) {
      const double l = lambda[at(block.row + r)];
      for (int c = 0; c < 3; ++c) to[c] += entries[3 * r + c] * l;
    }
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

void System::dense_jacobian(const Evaluation& e, std::span<double> out) const {
  std::ranges::fill(out, 0.0);
  const int nv = layout_.nv();
  for (const JacobianBlock& block : blocks_) {
    for (int r = 0; r < block.rows; ++r) {
      for (int c = 0; c < 3; ++c) {
        out[at((block.row + r) * nv + 3 * block.body + c)] += e.jacobian[at(block.offset + 3 * r + c)];
      }
    }
  }
}

void System::reaction(int index, const Evaluation& e, std::span<const double> lambda, double* wrench) const {
  // Rows hold the marker's columns in body form: the moment about the marker is that about the centre less s x F.
  double body_force[3] = {0.0, 0.0, 0.0};
  const Slice rows = layout_.rows(index);
  const int gear = model_.joints[at(index)].gear;
  const int block_a = gear >= 0 ? gear_blocks_[at(gear)][2] : row_block_a_[at(index)];
  const int block_b = gear >= 0 ? gear_blocks_[at(gear)][3] : row_block_b_[at(index)];
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
