#include "run/sleeping_joints.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "component/joint_roles.h"

namespace freeplay {
namespace {

constexpr double rounding_off = 1e-9;  // margin for rounding, as a part of the promised distance
constexpr double no_cubic = 1e-3;      // margin for motion that is no cubic, as a part of it
// A cubic whose remaining distance is at least so many steps long, at the speeds of its ends, stays within it.
constexpr double steps_left = 2.0, steps_to_begin = 4.0;

}  // namespace

SleepingJoints::SleepingJoints(const Joints& joints, const Forces& forces, EvaluationContext& context)
    : joints_(joints), context_(context) {
  const std::span<const ForceBlock> blocks = forces.blocks();
  for (int f = 0; f < static_cast<int>(blocks.size()); ++f) {
    const int j = blocks[at(f)].joint;
    if (blocks[at(f)].internal != 0) continue;
    context.sleeps.resize(std::max(context.sleeps.size(), at(j) + 1));
    candidates_.push_back({j, f, joints[j].marker_a, joints[j].marker_b});
    const JointLayout& layout = joints.layout(j);
    Sleep& sleep = context.sleeps[at(j)];
    if (layout.space == Space::planar && layout.clearance > 0.0 && plays_between_walls(layout)) {
      sleep.kind = Sleep::Kind::walls;
      sleep.reach = layout.contact_reach;
    } else if (layout.space == Space::spatial && layout.free_turns != 0) {
      sleep.kind = Sleep::Kind::turns;
    }
  }
}

void SleepingJoints::look(Candidate& candidate, const Evaluation& e) const {
  const Sleep& sleep = context_.sleeps[at(candidate.joint)];
  const MarkerKinematics &a = e.markers[at(candidate.marker_a)], &b = e.markers[at(candidate.marker_b)];
  candidate.room = sleep.radius - sleep.way(a, b);
  candidate.speed = sleep.speed(a, b);
}

bool SleepingJoints::begin(double dt, const Point& start, const Evaluation& e, Fault& fault) {
  for (Candidate& candidate : candidates_) {
    Sleep& sleep = context_.sleeps[at(candidate.joint)];
    sleep.left = false;
    const double way = steps_to_begin * dt;
    if (sleep.now && !all_awake_ && candidate.room > way * candidate.speed) continue;
    sleep.now = false;
    sleep.radius = 0.0;
    if (all_awake_ || e.acts[at(candidate.block)] != 0) continue;
    double distance = 0.0;
    const JointRecord& joint = joints_[candidate.joint];
    if (!joint.joint.free_distance(Joints::input(joint, start, e), distance, fault.message))
      return fault.blame(candidate.joint);
    if (!(distance > 0.0)) continue;
    if (sleep.kind == Sleep::Kind::turns) {
      std::ranges::fill(sleep.levers, 0.0);
      if (!joint.joint.free_levers(Joints::input(joint, start, e), sleep.levers, fault.message))
        return fault.blame(candidate.joint);
    }
    const bool is_cubic = sleep.kind == Sleep::Kind::round;
    sleep.radius = (1.0 - (is_cubic ? rounding_off : no_cubic)) * distance;
    sleep.place(e.markers[at(candidate.marker_a)], e.markers[at(candidate.marker_b)], sleep.from);
    if (std::isinf(dt)) continue;
    look(candidate, e);
    sleep.now = candidate.room > way * candidate.speed;
  }
  all_awake_ = false;
  return true;
}

bool SleepingJoints::stayed() {
  for (const Candidate& candidate : candidates_) {
    const Sleep& sleep = context_.sleeps[at(candidate.joint)];
    if (sleep.now && sleep.left) all_awake_ = true;
  }
  return !all_awake_;
}

bool SleepingJoints::held(double dt, const Evaluation& e) {
  for (Candidate& candidate : candidates_) {
    const Sleep& sleep = context_.sleeps[at(candidate.joint)];
    if (!sleep.now) continue;
    look(candidate, e);
    if (sleep.left || !(candidate.room > steps_left * dt * candidate.speed)) all_awake_ = true;
  }
  return !all_awake_;
}

}  // namespace freeplay
