// System: driven bodies, whose motion is a function of time, and the loads of the rows that hold them.
#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "base/angle.h"
#include "base/index.h"
#include "system/system.h"

namespace freeplay {
namespace {
constexpr int width = planar::velocities;
}  // namespace

void System::add_driven(const planar::DrivenBody& body) {
  const JointRecord& r = records_[at(body.joint)];
  Driven d;
  d.place = layout_.place(body.body);
  d.joint = body.joint;
  d.driver = body.driver;
  d.own_marker = body.second ? r.marker_b : r.marker_a;
  d.parent_marker = body.second ? r.marker_a : r.marker_b;
  d.parent = body.second ? r.body_a : r.body_b;
  d.sign = body.second ? 1.0 : -1.0;
  d.angle = mounts_[at(d.parent_marker)].angle - mounts_[at(d.own_marker)].angle;
  d.slides = r.layout->coordinate == Coordinate::position && body.driver >= 0;
  d.modulo_turns = body.driver >= 0 && motions_->modulo_turns(body.driver);
  d.turn = r.turn;
  int next = 0;
  const auto add_row = [&](int row, int own, int parent) {
    d.rows[next] = row;
    d.blocks[next] = own;
    d.parent_blocks[next++] = parent;
  };
  const int own = blocks_[at(body.second ? r.block_b : r.block_a)].offset;
  const int parent_block = body.second ? r.block_a : r.block_b;
  for (int i = 0; i < r.rows.size; ++i) {
    add_row(r.rows.offset + i, own + i * width, parent_block < 0 ? -1 : blocks_[at(parent_block)].offset + i * width);
  }
  for (const DriverRow& row : driven_driver_rows_) {
    if (row.driver != body.driver) continue;
    add_row(row.row, body.second ? row.block_b : row.block_a, body.second ? row.block_a : row.block_b);
  }
  if (r.layout->planar_rows[0] == PlanarRow::turn) d.turn_row = 0;  // of a weld
  has_slides_ = has_slides_ || d.slides;
  driven_.push_back(d);
}

void System::begin_at(const System& whole, const State& start, State& own) {
  share_motions(whole);
  take_start_of(whole);
  const std::size_t coordinates = at(body_coordinates()), velocities = at(body_velocities());
  own.t() = start.t();
  for (std::size_t place = 0; place < at(layout_.free_bodies()); ++place) {
    const std::size_t body = at(layout_.body_at(static_cast<int>(place)));
    std::copy_n(&start.q()[coordinates * body], coordinates, &own.q()[coordinates * place]);
    std::copy_n(&start.v()[velocities * body], velocities, &own.v()[velocities * place]);
    std::copy_n(&start.a()[velocities * body], velocities, &own.a()[velocities * place]);
  }
  const auto take_rows = [&](Slice to, Slice from) {
    for (int i = 0; i < to.size; ++i) own.lambda()[at(to.offset + i)] = start.lambda()[at(from.offset + i)];
  };
  for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
    take_rows(layout_.rows(j), whole.layout_.rows(j));
  }
  for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
    if (layout_.driver_row(d) >= 0) take_rows({layout_.driver_row(d), 1}, {whole.layout_.driver_row(d), 1});
  }
  std::copy_n(start.z().begin(), layout_.nz(), own.z().begin());
  std::ranges::copy(start.h(), own.h().begin());
  if (driven_.empty()) return;
  // Angles are known from the joints up to whole turns.
  Evaluation e(*this);
  MotionFault fault;
  if (!motions_->evaluate(own.t(), {e.motion.data(), e.motion.size()}, fault)) return;  // the run will meet it
  for (Driven& d : driven_) {
    e.driven_time = std::numeric_limits<double>::quiet_NaN();
    place_driven(point(own), e);
    const double apart = start.q()[3 * at(layout_.body_at(d.place)) + 2] - e.q[3 * at(d.place) + 2];
    d.angle += whole_turn * std::round(apart / whole_turn);
  }
}

// With P the marker of the parent, s the own marker's arm and h the axis of a slide, which carries the body by x h = d:
//   theta = theta_parent + angle + value,  r = P + d - s,  r' = P' + d' - E s w,  r'' = P'' + d'' - E s w' + s w^2
void System::place_driven(const Point& point, Evaluation& e) const {
  if (e.driven_time == point.t) return;
  for (std::size_t i = 0; i < driven_.size(); ++i) {
    const Driven& d = driven_[i];
    const TimeValue value = d.driver < 0 ? TimeValue{} : e.motion[at(d.driver)];
    const planar::Arm& pin = e.arms[at(d.parent_marker)];
    double x = pin.at_x, y = pin.at_y, vx = 0.0, vy = 0.0, ax = 0.0, ay = 0.0;
    double angle = d.angle, w = 0.0, alpha = 0.0, along = mounts_[at(d.parent_marker)].angle;
    if (d.parent != ground) {
      const double *q = &e.q[at(width * d.parent)], *v = &e.v[at(width * d.parent)];
      const double* a = &e.driven_a[at(width * (d.parent - layout_.free_bodies()))];
      angle += q[2];
      along += q[2];
      w = v[2];
      alpha = a[2];
      vx = v[0] - pin.y * w;
      vy = v[1] + pin.x * w;
      ax = a[0] - pin.y * alpha - pin.x * w * w;
      ay = a[1] + pin.x * alpha - pin.y * w * w;
    }
    if (d.slides) {
      const double hx = d.sign * std::cos(along), hy = d.sign * std::sin(along);
      const double dx = hx * value.value, dy = hy * value.value, rate_x = hx * value.rate, rate_y = hy * value.rate;
      x += dx;
      y += dy;
      vx += rate_x - dy * w;
      vy += rate_y + dx * w;
      ax += hx * value.acceleration - 2.0 * w * rate_y - alpha * dy - w * w * dx;
      ay += hy * value.acceleration + 2.0 * w * rate_x + alpha * dx - w * w * dy;
    } else {
      double turned = value.value;
      const double off = d.modulo_turns ? point.h[at(d.turn)] - turned : 0.0;
      if (std::abs(off) > M_PI) turned += whole_turn * std::round(off / whole_turn);
      angle += d.sign * turned;
      w += d.sign * value.rate;
      alpha += d.sign * value.acceleration;
    }
    planar::Turn& turned = e.turns[at(d.place)];
    if (turned.angle != angle) turned = {std::cos(angle), std::sin(angle), angle};
    const planar::Mount& own = mounts_[at(d.own_marker)];
    const double sx = turned.cosine * own.x - turned.sine * own.y, sy = turned.sine * own.x + turned.cosine * own.y;
    double* const q = &e.q[at(width * d.place)];
    double* const v = &e.v[at(width * d.place)];
    double* const a = &e.driven_a[width * i];
    q[0] = x - sx;
    q[1] = y - sy;
    q[2] = angle;
    v[0] = vx + sy * w;
    v[1] = vy - sx * w;
    v[2] = w;
    a[0] = ax + sy * alpha + sx * w * w;
    a[1] = ay - sx * alpha + sy * w * w;
    a[2] = alpha;
    const MarkersOfBody markers = markers_of_body_[at(d.place)];
    for (int k = markers.first; k < markers.end; ++k) {
      const std::size_t m = at(moving_markers_[at(k)]);
      planar::marker_arm(mounts_[m], q, v, turned, e.arms[m]);
      planar::marker_kinematics(mounts_[m], v, turned, e.arms[m], e.markers[m]);
    }
  }
  e.driven_time = point.t;
}

// What a driven body moves in a row of unknowns goes to the right side.
void System::move_rows_with_driven(std::span<const double> moved, std::span<double> right, const Evaluation& e) const {
  const double* const of_driven = moved.data() + moved.size() - e.driven_a.size();
  for (const Coupling& c : couplings_) {
    const double *row = &e.jacobian[at(c.offset)], *rate = of_driven + width * (c.place - layout_.free_bodies());
    right[at(c.row)] = right[at(c.row)] - row[0] * rate[0] - row[1] * rate[1] - row[2] * rate[2];
  }
}

double System::power_from_driven(const Evaluation& e, std::span<const double> lambda) const {
  double power = 0.0;
  for (const Coupling& c : couplings_) {
    if (c.row >= layout_.first_driver_row()) continue;
    for (int i = 0; i < width; ++i) {
      power += lambda[at(c.row)] * e.jacobian[at(c.offset + i)] * e.v[at(width * c.place + i)];
    }
  }
  return power;
}

void System::recover_loads(Evaluation& e, std::span<double> lambda) const {
  if (driven_.empty()) return;
  const std::size_t first = at(layout_.nv());
  double* const force = e.driven_load.data();
  for (std::size_t i = 0; i < e.driven_a.size(); ++i) force[i] = e.force[first + i] - mass_[first + i] * e.driven_a[i];
  solve_for_loads(e, e.driven_load, lambda);
}

void System::recover_impulses(Evaluation& e, std::span<const double> change, std::span<double> impulse) const {
  const std::size_t first = at(layout_.nv());
  for (std::size_t i = 0; i < change.size(); ++i) e.driven_load[i] = -mass_[first + i] * change[i];
  solve_for_loads(e, e.driven_load, impulse);
}

void System::fill_driven_jacobian(Evaluation& e) const {
  driven_rows_.fill_jacobian(mounts_, e);
  for (const DriverRow& row : driven_driver_rows_) {
    if (!row.constant) fill_driver_row<planar::Bodies>(row, e);
  }
}

// From the last body to the first: what its rows do not take from `force`, three numbers for each driven body, is taken
// by nothing.
void System::solve_for_loads(Evaluation& e, std::span<double> force, std::span<double> lambda) const {
  const int first = layout_.free_bodies();
  for (const Coupling& c : couplings_) {
    double* const on = &force[at(width * (c.place - first))];
    for (int i = 0; i < width; ++i) on[i] -= e.jacobian[at(c.offset + i)] * lambda[at(c.row)];
  }
  if (has_slides_) fill_driven_jacobian(e);
  for (std::size_t i = driven_.size(); i-- > 0;) {
    const Driven& d = driven_[i];
    const double* f = &force[width * i];
    double* const on_parent = d.parent == ground ? nullptr : &force[at(width * (d.parent - first))];
    if (d.slides) {
      Eigen::Matrix3d transposed;  // of its rows in its own columns
      for (int r = 0; r < width; ++r) {
        for (int c = 0; c < width; ++c) transposed(c, r) = e.jacobian[at(d.blocks[r] + c)];
      }
      const Eigen::Vector3d loads = transposed.inverse() * Eigen::Map<const Eigen::Vector3d>(f);
      for (int r = 0; r < width; ++r) {
        lambda[at(d.rows[r])] = loads[r];
        for (int c = 0; c < width && on_parent != nullptr; ++c) {
          on_parent[c] -= e.jacobian[at(d.parent_blocks[r] + c)] * loads[r];
        }
      }
      continue;
    }
    // The rows of a pin take the force at the marker, and the driver or the row of a weld the moment about it.
    const planar::Arm& own = e.arms[at(d.own_marker)];
    const double moment = f[2] + own.y * f[0] - own.x * f[1];
    const int x = d.turn_row == 0 ? 1 : 0;
    lambda[at(d.rows[x])] = d.sign * f[0];
    lambda[at(d.rows[x + 1])] = d.sign * f[1];
    lambda[at(d.rows[d.turn_row])] = d.sign * moment;
    if (on_parent == nullptr) continue;
    const planar::Arm& pin = e.arms[at(d.parent_marker)];
    on_parent[0] += f[0];
    on_parent[1] += f[1];
    on_parent[2] += moment - pin.y * f[0] + pin.x * f[1];
  }
}

}  // namespace freeplay
