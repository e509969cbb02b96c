#include "model/leg.h"

#include <cmath>
#include <limits>

namespace freeplay {
namespace {

struct OtherEnd {
  int joint = -1;
  int near = 0, far = 0;  // markers on the body asked for and on the other
};

bool ties(const JointElement& joint) { return joint.ideal_layout().constraint_rows > 0; }

// The only joint of `body` besides `known`, force elements left out; joint -1 when there is not exactly one.
OtherEnd only_other_joint(const Model& model, BodyId body, int known) {
  OtherEnd found;
  int count = 0;
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointElement& joint = model.joints[static_cast<std::size_t>(j)];
    if (j == known || !ties(joint)) continue;
    const BodyId a = model.markers[static_cast<std::size_t>(joint.marker_a)].body;
    const BodyId b = model.markers[static_cast<std::size_t>(joint.marker_b)].body;
    if (a != body && b != body) continue;
    ++count;
    found = a == body ? OtherEnd{j, joint.marker_a, joint.marker_b} : OtherEnd{j, joint.marker_b, joint.marker_a};
  }
  return count == 1 ? found : OtherEnd{};
}

struct Point {
  double x, y;
};
Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y}; }

}  // namespace

std::optional<LegChain> find_leg_chain(const Model& model, int driven, int frame) {
  if (model.space == Space::spatial) return std::nullopt;
  const auto body_of = [&](int m) { return model.markers[static_cast<std::size_t>(m)].body; };
  const auto is_pin = [&](int j) { return model.joints[static_cast<std::size_t>(j)].ideal_layout().pin != 0; };

  const JointElement& a = model.joints[static_cast<std::size_t>(driven)];
  const BodyId base = body_of(a.marker_a), crank = body_of(a.marker_b), platform = body_of(frame);
  if (!is_pin(driven) || crank == ground || crank == platform || base == platform) return std::nullopt;
  const OtherEnd b = only_other_joint(model, crank, driven);
  if (b.joint < 0 || !is_pin(b.joint)) return std::nullopt;
  const BodyId coupler = body_of(b.far);
  if (coupler == ground || coupler == platform || coupler == base) return std::nullopt;
  const OtherEnd c = only_other_joint(model, coupler, b.joint);
  if (c.joint < 0 || !is_pin(c.joint) || body_of(c.far) != platform) return std::nullopt;
  return LegChain{a.marker_b, b.near, b.far, c.near, c.far};
}

std::optional<Leg> find_leg(const Model& model, int driven, int frame) {
  const auto marker = [&](int m) -> const Marker& { return model.markers[static_cast<std::size_t>(m)]; };
  const auto at = [&](int m) { return Point{marker(m).position[0], marker(m).position[1]}; };

  const JointElement& a = model.joints[static_cast<std::size_t>(driven)];
  if (marker(a.marker_a).body != ground) return std::nullopt;
  const std::optional<LegChain> chain = find_leg_chain(model, driven, frame);
  if (!chain) return std::nullopt;
  const Point ab = at(chain->crank_at_b) - at(a.marker_b), bc = at(chain->coupler_at_c) - at(chain->coupler_at_b);
  const Point fc = at(chain->platform_at_c) - at(frame);
  Leg leg;
  leg.name = a.name;
  leg.ax = at(a.marker_a).x;
  leg.ay = at(a.marker_a).y;
  leg.crank = std::hypot(ab.x, ab.y);
  leg.coupler = std::hypot(bc.x, bc.y);
  if (leg.crank == 0.0 || leg.coupler == 0.0) return std::nullopt;
  leg.cx = fc.x;
  leg.cy = fc.y;
  leg.crank_direction = std::atan2(ab.y, ab.x);
  leg.coupler_direction = std::atan2(bc.y, bc.x);
  leg.coordinate_offset = marker(a.marker_b).angle - marker(a.marker_a).angle;
  leg.crank_body = marker(a.marker_b).body;
  leg.coupler_body = marker(chain->coupler_at_b).body;
  leg.crank_pin_x = at(a.marker_b).x;
  leg.crank_pin_y = at(a.marker_b).y;
  leg.coupler_pin_x = at(chain->coupler_at_b).x;
  leg.coupler_pin_y = at(chain->coupler_at_b).y;
  return leg;
}

std::optional<Leg> closed_form_leg(const Model& model, int driver) {
  const Driver& driven = model.drivers[static_cast<std::size_t>(driver)];
  if (driven.kinematics < 0) return std::nullopt;
  const InverseKinematics& entry = model.kinematics[static_cast<std::size_t>(driven.kinematics)];
  if (!entry.path.gives_all(3)) return std::nullopt;
  std::optional<Leg> leg = find_leg(model, driven.joint, entry.marker);
  if (leg) leg->elbow = driven.elbow;
  return leg;
}

namespace {

// C relative to A.
struct Reach {
  Jet x, y;
};

Reach reach_of(const Leg& leg, const Jet& x, const Jet& y, const PlatformTurn& platform) {
  const double w = platform.angle.rate, alpha = platform.angle.acceleration;
  const double px = platform.cosine * leg.cx - platform.sine * leg.cy;
  const double py = platform.sine * leg.cx + platform.cosine * leg.cy;
  return {{x.value + px - leg.ax, x.rate - py * w, x.acceleration - py * alpha - px * w * w},
          {y.value + py - leg.ay, y.rate + px * w, y.acceleration + px * alpha - py * w * w}};
}

// The length |r| = l2 of the coupler, r = C - A - l1 u with the direction u of the crank, E the quarter turn,
// differentiated twice; r.E u l1 = -elbow root/2 has its digits near stretch, too.
CrankPose solve_crank(const Leg& leg, const Reach& reach) {
  const double x = reach.x.value, y = reach.y.value, squared = x * x + y * y;
  const double w1 = 2.0 * leg.crank * x, w2 = 2.0 * leg.crank * y;
  const double w3 = squared + (leg.crank * leg.crank - leg.coupler * leg.coupler);
  const double far = w1 * w1 + w2 * w2, room = far - w3 * w3;
  CrankPose pose;
  pose.distance = std::sqrt(squared);
  pose.reachable = room > 0.0;
  if (!pose.reachable) return pose;
  const double root = leg.elbow * std::sqrt(room), to_x = w1 * w3 - root * w2, to_y = w2 * w3 + root * w1;
  const double bx = leg.crank * to_x / far, by = leg.crank * to_y / far;  // B relative to A
  const double rx = x - bx, ry = y - by, lever = -2.0 / root;
  const double rate = (rx * reach.x.rate + ry * reach.y.rate) * lever;
  const double rx_rate = reach.x.rate + by * rate, ry_rate = reach.y.rate - bx * rate;
  const double inward = rx * (reach.x.acceleration + bx * rate * rate) + ry * (reach.y.acceleration + by * rate * rate);
  pose.crank = {std::atan2(to_y, to_x) - leg.crank_direction, rate,
                (rx_rate * rx_rate + ry_rate * ry_rate + inward) * lever};
  return pose;
}

}  // namespace

CrankPose solve_crank(const Leg& leg, const Jet& x, const Jet& y, const PlatformTurn& platform) {
  return solve_crank(leg, reach_of(leg, x, y, platform));
}

LegPose solve_leg(const Leg& leg, const Jet& x, const Jet& y, const PlatformTurn& platform) {
  const Reach reach = reach_of(leg, x, y, platform);
  LegPose pose{solve_crank(leg, reach), {}};
  if (!pose.reachable) return pose;
  const Jet direction = pose.crank + Jet::constant(leg.crank_direction), length = Jet::constant(leg.crank);
  pose.coupler = atan2(reach.y - length * sin(direction), reach.x - length * cos(direction)) -
                 Jet::constant(leg.coupler_direction);
  return pose;
}

LegAngles leg_angles(const Leg& leg, double x, double y, double cosine, double sine) {
  const double px = x + cosine * leg.cx - sine * leg.cy - leg.ax, py = y + sine * leg.cx + cosine * leg.cy - leg.ay;
  const double squared = px * px + py * py;
  const double w1 = 2.0 * leg.crank * px, w2 = 2.0 * leg.crank * py;
  const double w3 = squared + leg.crank * leg.crank - leg.coupler * leg.coupler;
  double room = w1 * w1 + w2 * w2 - w3 * w3;
  LegAngles angles;
  angles.distance = std::sqrt(squared);
  if (room < 0.0) {
    // A pose on the edge of reach, written in decimals, misses it by the rounding of pin C: d(room) is
    // 8 l1 l2 |C - A| times that, besides the rounding of room itself.
    constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();
    const double pin = std::abs(x) + std::abs(y) + std::abs(leg.cx) + std::abs(leg.cy) + std::abs(leg.ax) +
                       std::abs(leg.ay) + leg.crank + leg.coupler;
    const double slack = 8.0 * leg.crank * leg.coupler * angles.distance * pin + w1 * w1 + w2 * w2 + w3 * w3;
    angles.reachable = room >= -rounding * slack;
    if (!angles.reachable) return angles;
    room = 0.0;
  }
  const double root = leg.elbow * std::sqrt(room);
  const double direction = std::atan2(w2 * w3 + root * w1, w1 * w3 - root * w2);
  angles.crank = direction - leg.crank_direction;
  angles.coupler =
      std::atan2(py - leg.crank * std::sin(direction), px - leg.crank * std::cos(direction)) - leg.coupler_direction;
  return angles;
}

}  // namespace freeplay
