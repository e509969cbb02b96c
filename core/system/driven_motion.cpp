#include "system/driven_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "base/angle.h"
#include "base/index.h"
#include "system/evaluation.h"

namespace freeplay {
namespace {

constexpr int width = planar::velocities;
constexpr double no_time = std::numeric_limits<double>::quiet_NaN();

/// A point that moves with a body that turns.
struct Carried {
  double x, y;
  double vx = 0.0, vy = 0.0, ax = 0.0, ay = 0.0;
  double angle, along;  // of the body that it carries; of the axis of a slide
  double w = 0.0, alpha = 0.0;

  // A parent that moves: P' = r' + E s w, P'' = r'' + E s w' - s w^2.
  void ride(const planar::Arm& pin, const double* q, const double* v, const double* a) {
    angle += q[2];
    along += q[2];
    w = v[2];
    alpha = a[2];
    vx = v[0] - pin.y * w;
    vy = v[1] + pin.x * w;
    ax = a[0] - pin.y * alpha - pin.x * w * w;
    ay = a[1] + pin.x * alpha - pin.y * w * w;
  }
  // Along the axis h of a slide, by d = h times its coordinate.
  void slide(double sign, const TimeValue& value) {
    const double hx = sign * std::cos(along), hy = sign * std::sin(along);
    const double dx = hx * value.value, dy = hy * value.value, rate_x = hx * value.rate, rate_y = hy * value.rate;
    x += dx;
    y += dy;
    vx += rate_x - dy * w;
    vy += rate_y + dx * w;
    ax += hx * value.acceleration - 2.0 * w * rate_y - alpha * dy - w * w * dx;
    ay += hy * value.acceleration + 2.0 * w * rate_x + alpha * dx - w * w * dy;
  }
  void turn(double sign, double turned, const TimeValue& value) {
    angle += sign * turned;
    w += sign * value.rate;
    alpha += sign * value.acceleration;
  }
};

}  // namespace

DrivenValues::DrivenValues(std::size_t bodies)
    : driven_a(width * bodies), driven_load(driven_a.size()), driven_time(no_time) {}

DrivenMotion::DrivenMotion(std::span<const planar::DrivenBody> bodies, const Layout& layout, const Markers& markers,
                           const Joints& joints, const Constraints& constraints, const Inertia& inertia,
                           const Motions& motions)
    : layout_(layout), markers_(markers), constraints_(constraints), inertia_(inertia) {
  for (const planar::DrivenBody& body : bodies) add(body, joints, motions);
}

void DrivenMotion::add(const planar::DrivenBody& body, const Joints& joints, const Motions& motions) {
  const JointRecord& joint = joints[body.joint];
  const std::span<const planar::Mount> mounts = markers_.mounts();
  Body b;
  b.place = layout_.place(body.body);
  b.driver = body.driver;
  b.own_marker = body.second ? joint.marker_b : joint.marker_a;
  b.parent_marker = body.second ? joint.marker_a : joint.marker_b;
  b.parent = body.second ? joint.body_a : joint.body_b;
  b.sign = body.second ? 1.0 : -1.0;
  b.angle = mounts[at(b.parent_marker)].angle - mounts[at(b.own_marker)].angle;
  b.slides = joint.layout->coordinate == Coordinate::position && body.driver >= 0;
  b.modulo_turns = body.driver >= 0 && motions.modulo_turns(body.driver);
  b.turn = joint.turn;
  if (joint.layout->planar_rows[0] == PlanarRow::turn) b.turn_row = 0;  // of a weld
  int next = 0;
  const auto add_row = [&](int row, int own, int parent) {
    b.rows[next] = row;
    b.offsets[next] = own;
    b.parent_offsets[next++] = parent;
  };
  const int own = constraints_.offset(body.joint, body.second), parent = constraints_.offset(body.joint, !body.second);
  const Slice rows = layout_.rows(body.joint);
  for (int i = 0; i < rows.size; ++i) {
    add_row(rows.offset + i, own + i * width, parent < 0 ? -1 : parent + i * width);
  }
  for (const DriverRow& row : constraints_.driven_driver_rows()) {
    if (row.driver != body.driver) continue;
    add_row(row.row, body.second ? row.offset_b : row.offset_a, body.second ? row.offset_a : row.offset_b);
  }
  has_slides_ = has_slides_ || b.slides;
  bodies_.push_back(b);
}

void DrivenMotion::count_turns(std::span<const double> q, const Point& point, Evaluation& e) {
  for (Body& b : bodies_) {
    place(point, e);
    const double apart = q[width * at(layout_.body_at(b.place)) + 2] - e.q[width * at(b.place) + 2];
    b.angle += whole_turn * std::round(apart / whole_turn);
  }
}

// With P the marker of the parent, s the own marker's arm and d the way along a slide:
//   theta = theta_parent + angle + value,  r = P + d - s,  r' = P' + d' - E s w,  r'' = P'' + d'' - E s w' + s w^2
void DrivenMotion::place(const Point& point, Evaluation& e) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& b = bodies_[i];
    const TimeValue value = b.driver < 0 ? TimeValue{} : e.motion[at(b.driver)];
    const planar::Arm& pin = e.arms[at(b.parent_marker)];
    Carried carried{
        .x = pin.at_x, .y = pin.at_y, .angle = b.angle, .along = markers_.mounts()[at(b.parent_marker)].angle};
    if (b.parent != ground) {
      carried.ride(pin, &e.q[at(width * b.parent)], &e.v[at(width * b.parent)],
                   &e.driven_a[at(width * (b.parent - layout_.free_bodies()))]);
    }
    if (b.slides) {
      carried.slide(b.sign, value);
    } else {
      double turned = value.value;
      const double off = b.modulo_turns ? point.h[at(b.turn)] - turned : 0.0;
      if (std::abs(off) > M_PI) turned += whole_turn * std::round(off / whole_turn);
      carried.turn(b.sign, turned, value);
    }
    const double angle = carried.angle, w = carried.w, alpha = carried.alpha;
    planar::Turn& turned = e.turns[at(b.place)];
    if (turned.angle != angle) turned = {std::cos(angle), std::sin(angle), angle};
    const planar::Mount& own = markers_.mounts()[at(b.own_marker)];
    const double sx = turned.cosine * own.x - turned.sine * own.y, sy = turned.sine * own.x + turned.cosine * own.y;
    double *const q = &e.q[at(width * b.place)], *const v = &e.v[at(width * b.place)],
                  *const a = &e.driven_a[width * i];
    q[0] = carried.x - sx;
    q[1] = carried.y - sy;
    q[2] = angle;
    v[0] = carried.vx + sy * w;
    v[1] = carried.vy - sx * w;
    v[2] = w;
    a[0] = carried.ax + sy * alpha + sx * w * w;
    a[1] = carried.ay - sx * alpha + sy * w * w;
    a[2] = alpha;
    markers_.move_with(b.place, turned, e);
  }
  e.driven_time = point.t;
}

double DrivenMotion::power(const Evaluation& e, std::span<const double> lambda) const {
  return constraints_.jacobian().power_from_driven(e.jacobian, lambda, std::span(e.v).subspan(at(layout_.nv())));
}

void DrivenMotion::recover_loads(Evaluation& e, std::span<double> lambda) const {
  if (empty()) return;
  const std::span<const double> force = std::span(e.force).subspan(at(layout_.nv())), mass = inertia_.driven_mass();
  for (std::size_t i = 0; i < e.driven_a.size(); ++i) e.driven_load[i] = force[i] - mass[i] * e.driven_a[i];
  solve_for_loads(e, e.driven_load, lambda);
}

void DrivenMotion::recover_impulses(Evaluation& e, std::span<const double> change, std::span<double> impulse) const {
  const std::span<const double> mass = inertia_.driven_mass();
  for (std::size_t i = 0; i < change.size(); ++i) e.driven_load[i] = -mass[i] * change[i];
  solve_for_loads(e, e.driven_load, impulse);
}

void DrivenMotion::solve_for_loads(Evaluation& e, std::span<double> force, std::span<double> lambda) const {
  constraints_.jacobian().take_from_driven(e.jacobian, lambda, force);
  if (has_slides_) constraints_.fill_driven(e);
  for (std::size_t i = bodies_.size(); i-- > 0;) {
    const Body& b = bodies_[i];
    const double* f = &force[width * i];
    double* const on_parent = b.parent == ground ? nullptr : &force[at(width * (b.parent - layout_.free_bodies()))];
    if (b.slides) {
      solve_slide(b, e, f, on_parent, lambda);
      continue;
    }
    // The rows of a pin take the force at the marker, and the driver or the row of a weld the moment about it.
    const planar::Arm& own = e.arms[at(b.own_marker)];
    const double moment = f[2] + own.y * f[0] - own.x * f[1];
    const int x = b.turn_row == 0 ? 1 : 0;
    lambda[at(b.rows[x])] = b.sign * f[0];
    lambda[at(b.rows[x + 1])] = b.sign * f[1];
    lambda[at(b.rows[b.turn_row])] = b.sign * moment;
    if (on_parent == nullptr) continue;
    const planar::Arm& pin = e.arms[at(b.parent_marker)];
    on_parent[0] += f[0];
    on_parent[1] += f[1];
    on_parent[2] += moment - pin.y * f[0] + pin.x * f[1];
  }
}

void DrivenMotion::solve_slide(const Body& body, const Evaluation& e, const double* force, double* on_parent,
                               std::span<double> lambda) const {
  Eigen::Matrix3d transposed;  // of its rows in its own columns
  for (int r = 0; r < width; ++r) {
    for (int c = 0; c < width; ++c) transposed(c, r) = e.jacobian[at(body.offsets[r] + c)];
  }
  const Eigen::Vector3d loads = transposed.inverse() * Eigen::Map<const Eigen::Vector3d>(force);
  for (int r = 0; r < width; ++r) {
    lambda[at(body.rows[r])] = loads[r];
    for (int c = 0; c < width && on_parent != nullptr; ++c) {
      on_parent[c] -= e.jacobian[at(body.parent_offsets[r] + c)] * loads[r];
    }
  }
}

}  // namespace freeplay
