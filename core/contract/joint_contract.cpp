#include "contract/joint_contract.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/angle.h"
#include "freeplay/eigen.h"

namespace freeplay {
namespace {

// Angles in any turn: what is left after the nearest whole turn.

/// Sizes of a moment's numbers: ordinary, or those of a large, fast or long simulation.
struct Extent {
  StateSize size;
  double latest = 1.0;  ///< [s]
};
Extent extent_of(int moment) {
  Extent extent;
  if (moment % 2 == 1) extent.size.distance = extent.size.speed = 5.0;
  if (moment / 2 % 2 == 1) extent.size.turning = 10.0;
  if (moment % 3 == 1) extent.latest = 50.0;
  return extent;
}

/// Finite, with a matrix that turns and does nothing else.
bool is_pose(const Pose& pose) {
  const Eigen::Map<const RowMajor3> r(pose.rotation);
  const double off = (r.transpose() * r - Eigen::Matrix3d::Identity()).norm() + std::abs(r.determinant() - 1.0);
  return off <= 1e-12 && vector3(pose.position).allFinite();
}

/// Markers as a joint with play has them, but for the eccentricity: where it places a body, if it does, with a small
/// tilt in space.
MarkerPair within_play(const JointProbe& probe, const MarkerPair& base, RandomNumbers& random) {
  Pose pose{};
  if (!probe.place(random.between(-M_PI, M_PI), pose) || !is_pose(pose)) return base;
  Twelve tilt{};
  if (probe.space() == Space::spatial) {
    for (const std::size_t i : {9u, 10u, 11u}) tilt[i] = random.between(-0.02, 0.02);
  }
  return moved(placed_pair(base, pose), tilt);
}

/// Moments at which a joint is asked: anywhere, near where it places a body, or around the end of its play; and in each
/// of the states that its history can be in after a step has begun and after an event.
std::vector<JointMoment> moments_of(const JointProbe& probe, RandomNumbers& random) {
  std::vector<JointMoment> moments;
  int turn_of_event = 0;
  const double play = probe.layout().clearance;
  const Space space = probe.space();
  const auto add = [&](const MarkerPair& markers, double latest) {
    const double t = random.between(0.5, 1.0) * latest;
    const JointMoment fresh = probe.start(markers, t);
    moments.push_back(fresh);
    // History from elsewhere, with a step begun from there.
    const JointMoment other = probe.start(
        play > 0.0 ? distant_pair(within_play(probe, random_pair(space, random), random), space, 0.99 * play, random)
                   : random_pair(space, random),
        t);
    JointMoment begun = fresh;
    begun.h = other.h;
    const double dt = 1e-4;
    probe.begin_step(other, random_twelve(space, random, 10.0), dt, begun);
    if (probe.layout().history > 0) moments.push_back(begun);
    // Of many events some each time; where contacts begin each has moments of its own.
    const int events = static_cast<int>(probe.layout().events.size);
    for (int i = 0; i < std::min(events, 2); ++i) {
      JointMoment after_event = fresh;
      probe.on_event(turn_of_event++ % events, after_event);
      moments.push_back(after_event);
    }
  };
  // A joint with play is no model of anything where its parts have left each other's reach.
  const int count = play > 0.0 ? 0 : 12;
  for (int i = 0; i < count; ++i) {
    const Extent extent = extent_of(i);
    // One in each twelfth of the turn; 5 and 12 have no common divisor, so that extents and angles mix.
    const double turn = (2.0 * (5 * i % count + random.between(0.0, 1.0)) / count - 1.0) * M_PI;
    add(turned_pair(space, extent.size, turn, random), extent.latest);
  }
  Pose pose{};
  for (int i = 0; i < 4; ++i) {
    const Extent extent = extent_of(i);
    const double coordinate = random.between(-1.0, 1.0) * (i % 2 == 1 ? 3.0 : 1.0);
    // In the middle of its play a joint's eccentricity has no direction.
    if (play > 0.0 || !probe.place(coordinate, pose) || !is_pose(pose)) continue;
    add(placed_pair(turned_pair(space, extent.size, 0.0, random), pose), extent.latest);
  }
  if (play > 0.0) {
    int i = 0;
    for (const double beyond : {-0.4, 0.001, 0.004, 0.013, 0.05}) {
      for (int k = 0; k < 3; ++k) {
        const Extent extent = extent_of(i++);
        const MarkerPair base = turned_pair(space, extent.size, random.between(-M_PI, M_PI), random);
        add(distant_pair(within_play(probe, base, random), space, play * (1.0 + beyond), random), extent.latest);
      }
    }
  }
  return moments;
}

/// Moments about the beginning of each contact, in flight and after its begin event, in runs of both kinds.
void add_contacts(const JointProbe& probe, const std::vector<ContactPose>& poses, RandomNumbers& random,
                  std::vector<JointMoment>& moments) {
  for (const ContactPose& pose : poses) {
    for (const double depth : {-0.003, 0.001, 0.01}) {
      const Twelve twist = random_twelve(probe.space(), random, 1.5);
      JointMoment fresh = probe.start(with_twists(pose.at(depth * pose.way), twist), random.between(0.5, 1.0));
      moments.push_back(fresh);
      fresh.per_contact = depth > 0.005 ? 20.0 : 0.0;
      probe.on_event(pose.begin, fresh);
      moments.push_back(fresh);
    }
  }
}

/// Keeps the first and about every fifth of the others, by chance: kinds of moment follow each other in turn.
void thin(std::vector<JointMoment>& moments, RandomNumbers& random) {
  std::erase_if(moments, [&, first = true](const JointMoment&) mutable {
    return !std::exchange(first, false) && random.between(0.0, 1.0) > 0.2;
  });
}

void check_place(const JointProbe& probe, RandomNumbers& random, Findings& findings) {
  for (const double wanted : {0.0, 0.3, -0.8, 2.5}) {
    Pose pose{};
    if (!probe.place(wanted, pose)) continue;
    const bool turns = is_pose(pose);
    findings.expect("place", turns,
                    [&] { return fmt::format("a body placed at {} has a rotation that is none", wanted); });
    if (!turns) continue;
    const JointMoment placed = probe.start(placed_pair(random_pair(probe.space(), random), pose), 0.0);
    const ProbedRows rows = probe.rows(placed);
    // Rounding of a rotation applied to lengths, a few times, as the rows enlarge it.
    const double rounding = 1e-13 * (1.0 + vector3(pose.position).norm());
    double tolerance = rounding;
    for (const double entry : rows.jacobian) tolerance = std::max(tolerance, rounding * std::abs(entry));
    for (const double phi : rows.phi) {
      findings.expect("place", std::abs(phi) <= tolerance,
                      [&] { return fmt::format("a body placed at {} leaves a residual of {}", wanted, phi); });
    }
    if (probe.layout().coordinate == Coordinate::none) continue;
    const double found = probe.coordinate(placed).value;
    const double off = probe.layout().coordinate == Coordinate::angle ? without_turns(found - wanted) : found - wanted;
    findings.expect("place", std::abs(off) <= tolerance,
                    [&] { return fmt::format("a body placed at {} has the coordinate {}", wanted, found); });
  }
}

void check_offset(const JointProbe& probe, Findings& findings) {
  const double play = probe.layout().clearance;
  if (!(play > 0.0)) return;
  for (const double load : {0.0, 1.0, 50.0}) {
    double reaction[6] = {0.6 * load, -0.8 * load, 0.0, 0.0, 0.0, 1e-3 * load};
    const InitialOffset offset = probe.initial_offset(reaction);
    const double size = std::hypot(offset.position[0], offset.position[1], offset.position[2]);
    const double speed = std::hypot(offset.velocity[0], offset.velocity[1], offset.velocity[2]);
    bool turns = std::isfinite(offset.turn) && std::isfinite(offset.turn_rate);
    for (int i = 0; i < 3; ++i) turns = turns && std::isfinite(offset.tilt[i]) && std::isfinite(offset.tilt_rate[i]);
    findings.expect("initial-offset", std::isfinite(size) && std::isfinite(speed) && turns, [&] {
      return fmt::format("for a load of {} N the start is {} m and {} rad away and moves with {} m/s and {} rad/s",
                         load, size, offset.turn, speed, offset.turn_rate);
    });
  }
}

bool same_names(Span<const Channel> a, Span<const Channel> b) {
  return std::ranges::equal(a, b, [](const Channel& x, const Channel& y) {
    return std::string_view(x.name) == y.name && std::string_view(x.unit) == y.unit;
  });
}
bool same_layout(const JointLayout& a, const JointLayout& b) {
  const auto numbers = [](const JointLayout& l) {
    return std::tuple(l.coordinate, l.constraint_rows, l.internal_variables, l.history, l.forces != 0,
                      l.analytic_derivatives != 0, l.pin != 0, l.planar_coordinate != 0, l.clearance, l.time_scale,
                      l.play_shape, l.contact_reach, l.free_turns != 0);
  };
  return numbers(a) == numbers(b) && std::ranges::equal(a.play_bounds, b.play_bounds) &&
         std::ranges::equal(a.planar_rows, b.planar_rows) && same_names(a.channels, b.channels) &&
         std::ranges::equal(a.channel_roles, b.channel_roles) && std::ranges::equal(a.event_roles, b.event_roles) &&
         std::ranges::equal(a.events, b.events, [](const Event& x, const Event& y) {
           return std::string_view(x.name) == y.name && x.crossing == y.crossing && x.locate == y.locate &&
                  same_names(x.fields, y.fields);
         });
}

}  // namespace

Findings check_joint(const JointSubject& subject, const Conditions& conditions) {
  Findings findings(conditions.found);
  RandomNumbers random(conditions.seed);
  const JointProbe probe(subject.joint, subject.space, conditions, findings);
  const JointProbe again(subject.joint, subject.space, conditions, findings);
  const JointProbe twin(subject.twin, subject.space, conditions, findings);
  const bool steady = same_layout(probe.layout(), again.layout()) && same_layout(probe.layout(), twin.layout());
  findings.expect("declares-sanely", steady, [] { return std::string("declare() answers differently each time"); });
  findings.expect("pin", !probe.layout().pin || subject.space != Space::planar || probe.layout().constraint_rows == 2,
                  [&] { return fmt::format("it declares {} constraint rows", probe.layout().constraint_rows); });
  if (!findings.held()) return findings;  // a layout that is wrong makes every other answer meaningless
  std::vector<ContactPose> poses = contact_poses(probe, random);
  std::vector<JointMoment> moments = moments_of(probe, random);
  add_contacts(probe, poses, random, moments);
  if (!subject.thorough) {
    thin(moments, random);
    if (poses.size() > 1) poses.resize(1);
  }
  check_rows(probe, moments, random, findings);
  check_forces(probe, subject.passive, moments, findings);
  check_cycle(probe, subject, random, findings);
  check_memory(probe, twin, moments, random, findings);
  check_rest(probe, moments, random, findings);
  check_bounds(probe, random, findings);
  check_time(probe, moments, random, findings);
  check_roles(probe, moments, findings);
  check_contacts(probe, poses, random, findings);
  check_impacts(probe, poses, random, findings);
  check_place(probe, random, findings);
  check_offset(probe, findings);
  return findings;
}

}  // namespace freeplay
