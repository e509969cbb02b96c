#include "results/load_judgement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/index.h"
#include "model/force_element.h"
#include "model/whole_mass.h"

namespace freeplay {
namespace {

// As most_of_load: springs, dampers and friction answer motions, impacts among them.
constexpr double most_of_element = 3e5;   // [m/s^2]
constexpr double steel_density = 7800.0;  // [kg/m^3]
constexpr double steel_yields = 2.5e8;    // [Pa], structural steel; loose joints of sound models come to a quarter
constexpr double counts_as_part = 1e-3;   // of all masses: lighter bodies only stand between joints
constexpr double noteworthy = 0.01;       // of the limit of a load that may be the cause
constexpr double fastest_slide = 100.0;   // [m/s], on ground: catapults of ships
constexpr double fastest_body = 200.0;    // [m/s]
// At the radius of gyration, or of all masses: rings of steel burst at 400, carbon fibre reaches it.
constexpr double fastest_turning = 1000.0;  // [m/s]

class LoadJudge {
 public:
  explicit LoadJudge(const RunRecord& record)
      : record_(record), model_(record.model), size_(record.extremes.size), all_(whole_mass(record.model)) {}

  void add_to(Verdict& verdict) {
    if (!(all_.mass > 0.0) || !(size_ > 0.0)) return;
    look_at_forces();
    look_at_drivers();
    if (worst_.excess > 1.0) {
      verdict.add({.id = "load-size",
                   .level = Trust::doubtful,
                   .message = words_of_load() + ": check its numbers and their units",
                   .element = worst_.element,
                   .value = worst_.excess * worst_.limit,
                   .limit = worst_.limit});
    } else {
      look_at_joints(verdict);  // which only pass on what others press with
    }
    look_at_speeds(verdict);
  }

 private:
  struct Load {
    double excess = 0.0;  // acceleration by its limit
    double limit = 0.0, amount = 0.0;
    const char* unit = "N";
    std::string element{};
  };

  /// Over the whole run, whatever `discard` says; 0 where nothing was seen.
  double largest(std::size_t peak) const {
    const LargestValues& seen = record_.statistics.largest();
    return std::max({record_.statistics.any() ? seen.in_window()[peak] : 0.0, seen.before()[peak], 0.0});
  }

  void look_at(double force, double torque, double limit, const std::string& element) {
    const double by_force = all_.by_force(force), by_torque = all_.by_torque(torque, size_);
    if (by_force > limit * worst_.excess) worst_ = {by_force / limit, limit, force, "N", element};
    if (by_torque > limit * worst_.excess) worst_ = {by_torque / limit, limit, torque, "N m", element};
  }

  /// Blows are judged by how deep and how fast the surfaces meet, as those in a play.
  bool is_contact(const ForceElement& force) const {
    return force.joint >= 0 && has_contact_statistics(record_.channels.joints[at(force.joint)]);
  }

  void look_at_forces() {
    const PeakValues& peaks = record_.statistics.largest().places();
    for (int f = 0; f < static_cast<int>(model_.force_elements.size()); ++f) {
      if (is_contact(model_.force_elements[at(f)])) continue;
      const bool applied = model_.force_elements[at(f)].applied >= 0;
      look_at(largest(peaks.applied_force(f)), largest(peaks.applied_torque(f)),
              applied ? most_of_load : most_of_element, fmt::format("force '{}'", force_words(model_, f).name));
    }
  }

  void look_at_drivers() {
    for (std::size_t d = 0; d < model_.drivers.size(); ++d) {
      const Driver& driver = model_.drivers[d];
      if (prescribes(driver.kind)) continue;
      const double effort = largest(record_.statistics.largest().places().effort(static_cast<int>(d)));
      const bool turns = driver.kind == DriverKind::torque;
      look_at(turns ? 0.0 : effort, turns ? effort : 0.0, most_of_load, fmt::format("driver '{}'", driver.name));
    }
  }

  std::string words_of_load() const {
    return fmt::format("{} of {:.3g} {} on {:.3g} kg{}", worst_.element, worst_.amount, worst_.unit, all_.mass,
                       model_length(model_) > 0.0 ? fmt::format(" in a mechanism of {:.2g} m", size_) : "");
  }

  /// What a joint passes on, by the cross-section of a cube of steel with the mass of its lighter body: bars have less.
  void look_at_joints(Verdict& verdict) const {
    double most = steel_yields, most_force = 0.0;
    int joint = -1;
    BodyId on = ground;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& element = model_.joints[at(j)];
      if (is_force_element(element) || element.gear >= 0) continue;
      const double force = largest(record_.statistics.largest().places().force(j));
      for (const int marker : {element.marker_a, element.marker_b}) {
        const BodyId body = model_.markers[at(marker)].body;
        if (body == ground || model_.bodies[at(body)].mass < counts_as_part * all_.mass) continue;
        const double side = std::cbrt(model_.bodies[at(body)].mass / steel_density), stress = force / (side * side);
        if (stress > most) most = stress, most_force = force, joint = j, on = body;
      }
    }
    if (joint < 0) return;
    const std::string name = fmt::format("joint '{}'", model_.joints[at(joint)].name);
    const Body& body = model_.bodies[at(on)];
    verdict.add({.id = "load-size",
                 .level = Trust::doubtful,
                 .message = fmt::format("{} passes {:.3g} N on to '{}' of {:.3g} kg: {:.2g} Pa in a cube of steel of "
                                        "that mass, which yields at {:.2g} Pa; check {}",
                                        name, most_force, body.name, body.mass, most, steel_yields, source_of_load()),
                 .element = name,
                 .value = most,
                 .limit = steel_yields});
  }

  /// The largest load, or the prescribed motion that takes the largest effort.
  std::string source_of_load() const {
    if (worst_.excess > noteworthy) return words_of_load() + " and the masses";
    double most = 0.0;
    std::string text = "masses and loads";
    for (std::size_t d = 0; d < model_.drivers.size(); ++d) {
      const Driver& driver = model_.drivers[d];
      const bool turns = model_.joints[at(driver.joint)].layout.coordinate == Coordinate::angle;
      const double effort = largest(record_.statistics.largest().places().effort(static_cast<int>(d)));
      const double amount = turns ? all_.by_torque(effort, size_) : all_.by_force(effort);
      if (!prescribes(driver.kind) || !(amount > most)) continue;
      most = amount;
      text = fmt::format("the motion of driver '{}', the masses, and the lengths that it moves", driver.name);
    }
    return text;
  }

  bool slides_on_ground(BodyId body) const {
    return std::ranges::any_of(model_.joints, [&](const JointElement& joint) {
      const BodyId a = model_.markers[at(joint.marker_a)].body, b = model_.markers[at(joint.marker_b)].body;
      return joint.layout.coordinate == Coordinate::position &&
             ((a == ground && b == body) || (b == ground && a == body));
    });
  }

  void look_at_speeds(Verdict& verdict) const {
    const auto judged = [](const TrustReason& reason) { return reason.id == "body-speed"; };
    if (!is_on_ground(model_) || std::ranges::any_of(verdict.reasons(), judged)) return;
    TrustReason reason{.id = "body-speed", .level = Trust::doubtful, .message = {}, .value = 0.0};
    for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
      const double speed = largest(record_.statistics.largest().places().speed(b));
      if (speed <= std::min(fastest_slide, fastest_body) || speed <= reason.value) continue;
      const double limit = slides_on_ground(b) ? fastest_slide : fastest_body;
      if (speed <= limit) continue;
      reason.value = speed, reason.limit = limit;
      reason.element = fmt::format("body '{}'", model_.bodies[at(b)].name);
    }
    // What turns on its place is fast without moving.
    const double mean = std::sqrt(2.0 * record_.extremes.kinetic.most / all_.mass);
    const double rim = std::sqrt(record_.extremes.rim_squared);
    if (!reason.element.empty()) {
      reason.message = fmt::format("{} moves with {:.3g} m/s", reason.element, reason.value);
    } else if (rim > fastest_turning) {
      reason.value = rim, reason.limit = fastest_turning;
      reason.element = fmt::format("body '{}'", model_.bodies[at(record_.extremes.fastest_rim)].name);
      reason.message = fmt::format("{} turns with {:.3g} m/s at its radius of gyration", reason.element, rim);
    } else if (mean > fastest_turning) {
      reason.value = mean, reason.limit = fastest_turning;
      reason.message = fmt::format("the energy of motion is that of all masses at {:.3g} m/s", mean);
    } else {
      return;
    }
    reason.message += ", faster than in any machine" + likely_source();
    verdict.add(std::move(reason));
  }

  /// "; driver 'motor' has put 3e9 J into 2 kg" of the motor or force with the largest work, where it is the most of
  /// the motion's energy.
  std::string likely_source() const {
    double most = 0.5 * record_.extremes.kinetic.most;
    std::string text;
    const auto look = [&](double work, const char* kind, const std::string& name) {
      if (!(work > most)) return;
      most = work;
      text = fmt::format("; {} '{}' has put {:.3g} J into {:.3g} kg", kind, name, work, all_.mass);
    };
    for (int f = 0; f < static_cast<int>(model_.force_elements.size()); ++f)
      look(record_.statistics.force(f).work, "force", force_words(model_, f).name);
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d)
      look(record_.statistics.driver(d).work, "driver", model_.drivers[at(d)].name);
    return text;
  }

  const RunRecord& record_;
  const Model& model_;
  double size_;
  WholeMass all_;
  Load worst_{};
};

}  // namespace

void judge_loads(const RunRecord& record, Verdict& verdict) { LoadJudge(record).add_to(verdict); }

}  // namespace freeplay
