#include "format/doubtful_gear.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "format/doubtful_body.h"
#include "format/doubtful_number.h"
#include "format/motion_course.h"

namespace freeplay {
namespace {

constexpr std::size_t most_gears = 1000;  // that are looked at
constexpr double one_stage = 100.0;       // ratio of a pair of wheels: a worm slows down by so much
constexpr double turns_through = 2.0;     // to and fro after such a pair
constexpr double most_slowing = 5000.0;   // geared motors of several stages come to a thousand or two
constexpr double most_speeding = 300.0;   // of a pair behind a motor: gears of wind turbines come to a hundred in all

/// What a driver makes of the coordinate of a joint.
struct Travel {
  double range = 0.0, fastest = 0.0;
  bool returns = false;
  int through = -1;    // the gear that it comes by, index into Model::gears
  double ratio = 1.0;  // by which that gear multiplies it
};

class GearDoubts {
 public:
  explicit GearDoubts(const Draft& draft) : draft_(draft), model_(draft.model) {}

  void run() {
    find_travels();
    find_motors();
    const int gears = static_cast<int>(std::min(model_.gears.size(), most_gears));
    for (int g = 0; g < gears; ++g) judge(g);
  }

 private:
  const JointElement& joint(int j) const { return model_.joints[static_cast<std::size_t>(j)]; }
  bool turns(int j) const { return joint(j).ideal_layout().coordinate == Coordinate::angle; }

  /// Of driven joints, and of what is geared to them.
  void find_travels() {
    for (const Driver& driver : model_.drivers) {
      if (!prescribes(driver.kind) || driver.kinematics >= 0) continue;
      const Course course = course_of(driver, model_.settings);
      if (course.known) travels_[driver.joint] = {course.high - course.low, course.fastest, course.returns};
    }
    for (bool more = !travels_.empty() && model_.gears.size() <= most_gears; more;) {
      more = false;
      for (int g = 0; g < static_cast<int>(model_.gears.size()); ++g) {
        const Gear& gear = model_.gears[static_cast<std::size_t>(g)];
        more =
            pass(g, gear.first, gear.second, gear.ratio) || pass(g, gear.second, gear.first, 1.0 / gear.ratio) || more;
      }
    }
  }

  bool pass(int gear, int from, int to, double ratio) {
    const auto known = travels_.find(from);
    if (known == travels_.end() || travels_.contains(to)) return false;
    const double by = std::abs(ratio);
    travels_[to] = {by * known->second.range, by * known->second.fastest, known->second.returns, gear, by};
    return true;
  }

  /// Joints that a motor by torque turns, directly or through gears.
  void find_motors() {
    for (const Driver& driver : model_.drivers) {
      if (!prescribes(driver.kind)) moved_.insert(driver.joint);
    }
    for (bool more = !moved_.empty() && model_.gears.size() <= most_gears; more;) {
      more = false;
      for (int g = 0; g < static_cast<int>(model_.gears.size()); ++g) {
        const Gear& gear = model_.gears[static_cast<std::size_t>(g)];
        const bool first = moved_.contains(gear.first), second = moved_.contains(gear.second);
        if (first == second) continue;
        const double by = std::abs(first ? gear.ratio : 1.0 / gear.ratio);
        if (by > most_speeding && turns(gear.first) && turns(gear.second)) sped_up_[g] = by;
        moved_.insert(first ? gear.second : gear.first);
        more = true;
      }
    }
  }

  void judge(int g) {
    const Gear& gear = model_.gears[static_cast<std::size_t>(g)];
    const auto entry = entry_of(draft_, "joints", joint(gear.joint).name);
    if (!entry || !entry->node().is_map()) return;
    const auto ratio = MapReader(*entry, "gear").find("ratio");
    // Instances of a template share the text: the first of them is enough.
    if (!ratio || !judged_.insert(&ratio->node()).second) return;
    if (turns(gear.first) != turns(gear.second) && judge_radius(g, *ratio)) return;
    for (const int to : {gear.first, gear.second}) {
      const auto travel = travels_.find(to);
      if (travel == travels_.end() || travel->second.through != g) continue;
      if (judge_speed(to, travel->second, *ratio)) return;
    }
    const auto speeding = sped_up_.find(g);
    if (speeding == sped_up_.end()) return judge_slowing(gear, *ratio);
    ratio->warn("doubtful-value",
                fmt::format("'{}' makes '{}' and '{}' turn by 1 to {:.4g}, and the motor is on the slow side: one pair "
                            "of wheels changes speeds by up to ten; is the ratio meant the other way round?",
                            ratio->path(), joint(gear.first).name, joint(gear.second).name, speeding->second));
  }

  void judge_slowing(const Gear& gear, const CheckedValue& written) const {
    const bool slows = std::abs(gear.ratio) < 1.0;
    const double by = slows ? 1.0 / std::abs(gear.ratio) : std::abs(gear.ratio);
    if (by <= most_slowing || !turns(gear.first) || !turns(gear.second)) return;
    const int slow = slows ? gear.second : gear.first, fast = slows ? gear.first : gear.second;
    written.warn("doubtful-value",
                 fmt::format("'{}' makes '{}' turn by 1 to {:.4g} of '{}', more than gears of several "
                             "stages have: check the ratio",
                             written.path(), joint(slow).name, by, joint(fast).name));
  }

  /// Way of a slide by the angle that it is geared to, as a radius.
  bool judge_radius(int g, const CheckedValue& written) const {
    const Gear& gear = model_.gears[static_cast<std::size_t>(g)];
    const double radius = std::abs(turns(gear.first) ? gear.ratio : 1.0 / gear.ratio), scale = draft_.length_scale;
    const int slide = turns(gear.first) ? gear.second : gear.first;
    const auto travel = travels_.find(slide);
    const bool far = travel != travels_.end() && travel->second.through == g && travel->second.returns &&
                     travel->second.range > bare_limit::length * scale;
    if (!(scale > 0.0) || (radius <= bare_limit::bearing * scale && !far) || names_a_unit(written)) return false;
    written.warn(
        "doubtful-length",
        fmt::format("'{}' moves '{}' by {:.4g} m in each radian{} where the lengths of the mechanism are about "
                    "{:.3g} m: write the unit after the number, as in 'mm/rad'",
                    written.path(), joint(slide).name, radius,
                    far ? fmt::format(", {:.4g} m in all,", travel->second.range) : "", scale));
    return true;
  }

  bool judge_speed(int to, const Travel& travel, const CheckedValue& written) const {
    const bool turn = turns(to), bare = !names_a_unit(written);
    const std::string becomes = fmt::format("'{}' makes '{}' {} with {:.4g} {}", written.path(), joint(to).name,
                                            turn ? "turn" : "move", travel.fastest, turn ? "rad/s" : "m/s");
    if (travel.fastest > (turn ? fastest_motion::turn : fastest_motion::slide)) {
      written.warn("doubtful-speed", becomes + ", faster than any machine: check the ratio and its unit");
      return true;
    }
    if (!turn) {
      if (!bare || travel.fastest <= bare_limit::slide_speed) return false;
      written.warn("doubtful-speed", becomes + ": write the unit after the ratio, as in 'mm/rad'");
      return true;
    }
    const bool far = travel.returns && travel.range > turns_through * bare_limit::angle;
    if (travel.ratio <= one_stage || (travel.fastest <= bare_limit::angular_speed && !far)) return false;
    written.warn("doubtful-value", fmt::format("{}, {:.4g} times as fast as before: one pair of wheels changes speeds "
                                               "by up to ten; check the ratio",
                                               becomes, travel.ratio));
    return true;
  }

  const Draft& draft_;
  const Model& model_;
  std::map<int, Travel> travels_;  // by joint
  std::set<int> moved_;            // joints, by motors
  std::map<int, double> sped_up_;  // by gear, index into Model::gears: so many times
  std::set<const Node*> judged_;
};

}  // namespace

void doubt_gears(const Draft& draft) { GearDoubts(draft).run(); }

}  // namespace freeplay
