#include "contract/joint_contract.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "freeplay/eigen.h"

namespace freeplay {
namespace {

// Angles in any turn: what is left after the nearest whole turn.
double without_turns(double angle) { return angle - 2.0 * M_PI * std::round(angle / (2.0 * M_PI)); }

/// Moments at which a joint is asked: anywhere, near where it places a body, or around the end of its play; and in each
/// of the states that its history can be in after a step has begun and after an event.
std::vector<JointMoment> moments_of(const JointProbe& probe, RandomNumbers& random) {
  std::vector<JointMoment> moments;
  const double play = probe.layout().clearance;
  const auto add = [&](const MarkerPair& markers) {
    const double t = random.between(0.1, 1.0);
    const JointMoment fresh = probe.start(markers, t);
    moments.push_back(fresh);
    // History from elsewhere, with a step begun from there.
    const JointMoment other = probe.start(
        play > 0.0 ? distant_pair(probe.space(), 0.99 * play, random) : random_pair(probe.space(), random), t);
    JointMoment begun = fresh;
    begun.h = other.h;
    const double dt = 1e-4;
    probe.begin_step(other, random_twelve(probe.space(), random, 10.0), dt, begun);
    if (probe.layout().history > 0) moments.push_back(begun);
    for (int event = 0; event < static_cast<int>(probe.layout().events.size); ++event) {
      JointMoment told = fresh;
      probe.on_event(event, told);
      moments.push_back(told);
    }
  };
  // A joint with play is no model of anything where its parts have left each other's reach.
  for (int i = 0; i < 6 && !(play > 0.0); ++i) add(random_pair(probe.space(), random));
  Pose pose{};
  for (int i = 0; i < 4; ++i) {
    if (probe.place(random.between(-1.0, 1.0), pose)) add(placed_pair(probe.space(), pose, random));
  }
  if (play > 0.0) {
    for (const double beyond : {-0.4, 0.001, 0.004, 0.013, 0.05}) {
      for (int i = 0; i < 3; ++i) add(distant_pair(probe.space(), play * (1.0 + beyond), random));
    }
  }
  return moments;
}

void check_place(const JointProbe& probe, RandomNumbers& random, Findings& findings) {
  for (const double wanted : {0.0, 0.3, -0.8, 2.5}) {
    Pose pose{};
    if (!probe.place(wanted, pose)) continue;
    const JointMoment placed = probe.start(placed_pair(probe.space(), pose, random), 0.0);
    const RowValues rows = probe.rows(placed);
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
    double reaction[3] = {0.6 * load, -0.8 * load, 0.0};
    const InitialOffset offset = probe.initial_offset(reaction);
    const double size = std::hypot(offset.position[0], offset.position[1], offset.position[2]);
    const double speed = std::hypot(offset.velocity[0], offset.velocity[1], offset.velocity[2]);
    findings.expect("initial-offset", std::isfinite(size) && std::isfinite(speed), [&] {
      return fmt::format("for a load of {} N the start is {} m away and moves with {} m/s", load, size, speed);
    });
  }
}

}  // namespace

Findings check_joint(const JointSubject& subject, const Conditions& conditions) {
  Findings findings(conditions.found);
  RandomNumbers random(conditions.seed);
  const JointProbe probe(subject.joint, subject.space, conditions, findings);
  const JointProbe twin(subject.twin, subject.space, conditions, findings);
  if (!findings.held()) return findings;  // a layout that is wrong makes every other answer meaningless
  const std::vector<JointMoment> moments = moments_of(probe, random);
  check_rows(probe, moments, random, findings);
  check_forces(probe, subject.passive, moments, findings);
  check_cycle(probe, subject.passive, random, findings);
  check_memory(probe, twin, moments, random, findings);
  check_place(probe, random, findings);
  check_offset(probe, findings);
  return findings;
}

}  // namespace freeplay
