#include "run/likely_cause.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/index.h"
#include "component/contact_stiffness.h"
#include "model/force_element.h"
#include "run/drive_kinks.h"

namespace freeplay {
namespace {

// What no machine has.
constexpr double most_gyration = 3.0;       // radius of gyration, by the size of the body
constexpr double most_density = 1e5;        // mass by the cube of the model's size [kg/m^3]: four times osmium's
constexpr double most_near_gyration = 1e6;  // mass by the largest body with this radius of gyration [kg/m^3]
constexpr double softest = 1e6;             // E* [Pa]: of rubber
constexpr double soft = 3e8;                // E* [Pa]: below plastics
constexpr double stiffest = 1.5e12;         // E* [Pa]: above diamond's
constexpr double most_lengths = 100.0;      // size of a body, by the median of all
constexpr double most_gravity = 1e3;        // [m/s^2]
constexpr double fastest_turn = 1e5;        // of a driver [rad/s]: a million turns a minute
constexpr double fastest = 200.0;           // of what a driver moves [m/s]: rims burst at twice as much
constexpr double suddenly = 10.0;           // speed, by the mean one of the run: a jump
constexpr double most_acceleration = 3e4;   // of all masses together, by one load [m/s^2]
constexpr double most_of_element = 3e5;     // the same by a spring or damper, which may follow from what went wrong
constexpr double most_of_clearance = 0.2;   // way of one surface in another in a step, by the clearance
constexpr double shortly_before = 0.01;     // of the run
constexpr double least_jump = 1.0;          // of the speed that a driver gives [m/s]: metals yield in such blows

/// The candidate that is farthest beyond its limit.
class Suspects {
 public:
  /// `excess`: value by limit. `text()` is only called for the worst so far.
  template <class Text>
  void add(double excess, Text&& text) {
    if (!(excess > worst_)) return;
    worst_ = excess;
    sentence_ = text();
  }
  const std::string& sentence() const { return sentence_; }

 private:
  double worst_ = 1.0;
  std::string sentence_;
};

double largest_inertia(const Body& body, Space space) {
  const auto& inertia = body.inertia;
  return space == Space::planar ? inertia[8] : std::max({inertia[0], inertia[4], inertia[8]});
}

/// Of all bodies that have any, sorted.
std::vector<double> sizes_of(const Model& model) {
  std::vector<double> sizes;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (const double size = extent(model, b); size > 0.0) sizes.push_back(size);
  }
  std::ranges::sort(sizes);
  return sizes;
}

void suspect_bodies(const System& system, Suspects& suspects) {
  const Model& model = system.model();
  const std::vector<double> sizes = sizes_of(model);
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>((sizes.size() - (sizes.empty() ? 0 : 1)) / 2);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[at(b)];
    const double own = extent(model, b), size = own > 0.0 ? own : system.size();
    const double inertia = largest_inertia(body, model.space), gyration = std::sqrt(inertia / body.mass);
    // A wheel may be far larger than the way to its crank pin, but hardly than the whole machine.
    suspects.add(gyration / std::max(most_gyration * size, system.size()), [&] {
      return fmt::format(
          "inertia of '{}' is {:.4g} kg m^2 for a mass of {:.4g} kg: its radius of gyration would be "
          "{:.2g} m",
          body.name, inertia, body.mass, gyration);
    });
    const double depth = std::max(2.0 * size, 4.0 * gyration);
    suspects.add(body.mass / (most_near_gyration * 2.0 * M_PI * gyration * gyration * depth), [&] {
      return fmt::format("mass of '{}' is {:.4g} kg at a radius of gyration of {:.2g} m: denser than any metal",
                         body.name, body.mass, gyration);
    });
    const double whole = system.size();
    suspects.add(body.mass / (most_density * whole * whole * whole), [&] {
      return fmt::format("mass of '{}' is {:.4g} kg in a mechanism of {:.2g} m: it would be denser than any metal",
                         body.name, body.mass, whole);
    });
    if (sizes.size() < 2) continue;
    suspects.add(own / (most_lengths * *middle), [&] {
      return fmt::format("'{}' measures {:.4g} m, while bodies of this model measure {:.2g} m", body.name, own,
                         *middle);
    });
  }
}

std::string words_of(const ContactStiffness& given, const JointElement& joint, bool soft, const char* what) {
  return fmt::format("{} of joint '{}' is {:.3g} {}: {}; {}{}", given.name, joint.name, given.value, given.unit, what,
                     soft ? "is it meant in N/mm" : "check its unit", soft ? given.unit.substr(3) : "");
}

void suspect_materials(const System& system, Suspects& suspects) {
  const Model& model = system.model();
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointElement& joint = model.joints[at(j)];
    const JointLayout& layout = system.joints().layout(j);
    const double modulus = layout.contact_modulus;
    const auto text = [&](const char* what) {
      return fmt::format("E and nu of joint '{}' make an E* of {:.3g} Pa: {}", joint.name, modulus, what);
    };
    suspects.add(softest / modulus, [&] { return text("softer than rubber; is a prefix such as GPa missing"); });
    suspects.add(modulus / stiffest, [&] { return text("stiffer than diamond; is a unit given twice"); });
    if (!joint.parameters || !(joint.has_play || joint.is_force)) continue;
    const auto given = given_stiffness(*joint.parameters, layout, system.size());
    if (!given) continue;
    suspects.add(softest / given->modulus, [&] { return words_of(*given, joint, true, "softer than rubber"); });
    suspects.add(given->modulus / stiffest, [&] { return words_of(*given, joint, false, "stiffer than diamond"); });
  }
}

/// Largest speed of a driver where the run stands and, as a step may have met it, a little later; and its mean one.
struct Pace {
  double rate = 0.0, time = 0.0, mean = 0.0;
};

Pace pace_of(const System& system, std::size_t driver, const Wreck& wreck) {
  const Settings& settings = system.model().settings;
  std::vector<TimeValue> motion(system.model().drivers.size());
  MotionFault fault;
  const auto look = [&](double t) { return system.motions().evaluate(t, {motion.data(), motion.size()}, fault); };
  Pace pace;
  const double step = wreck.dt > 0.0 ? wreck.dt : 1e-3 * (settings.end - settings.start);
  const double kink = DriveKinks(system.model()).next(wreck.t, wreck.t + step);
  for (const double t : {wreck.t, wreck.t + 1e-6 * step, wreck.t + 1e-3 * step, wreck.t + step, kink + 1e-9 * step}) {
    if (!(t <= wreck.t + step) || !look(t)) continue;
    const double rate = std::abs(motion[driver].rate);
    if (rate > pace.rate) pace.rate = rate, pace.time = wreck.t;
  }
  constexpr int looks = 200;
  double sum = 0.0;
  for (int i = 0; i <= looks; ++i) {
    if (!look(settings.start + (settings.end - settings.start) * i / looks)) return pace;
    sum += std::abs(motion[driver].rate);
  }
  pace.mean = sum / looks;
  return pace;
}

/// Of a link that a driver turns: one that is too long says nothing of speeds.
double arm_of(const System& system) {
  const std::vector<double> sizes = sizes_of(system.model());
  return sizes.empty() ? system.size() : sizes[(sizes.size() - 1) / 2];
}

void suspect_motion(const System& system, const Wreck& wreck, Suspects& suspects) {
  const Model& model = system.model();
  const double arm = arm_of(system);
  for (std::size_t d = 0; d < model.drivers.size(); ++d) {
    const Driver& driver = model.drivers[d];
    if (!prescribes(driver.kind)) continue;
    const bool turns = system.joints().layout(driver.joint).coordinate == Coordinate::angle;
    const Pace pace = pace_of(system, d, wreck);
    const double speed = turns ? pace.rate * arm : pace.rate;
    const std::string words = turns ? fmt::format("turns with {:.3g} rad/s, that is {:.2g} turns a minute", pace.rate,
                                                  pace.rate * 30.0 / M_PI)
                                    : fmt::format("moves with {:.3g} m/s", pace.rate);
    suspects.add(std::max(speed / fastest, turns ? pace.rate / fastest_turn : 0.0), [&] {
      // Beside the edge of what a path may reach inputs turn ever faster, but jump nowhere.
      const bool follows = driver.kinematics >= 0, jumps = !follows && pace.rate > suddenly * pace.mean;
      return fmt::format(
          "driver '{}' {}{}{}", driver.name,
          follows ? fmt::format("on the path of '{}' ", model.kinematics[at(driver.kinematics)].name) : "",
          jumps ? fmt::format("jumps at t = {:.6g} s: there it ", pace.time) : "", words);
    });
  }
  const Vector3& g = model.gravity;
  const double gravity = std::hypot(g[0], g[1], g[2]);
  suspects.add(gravity / most_gravity, [&] { return fmt::format("gravity is {:.3g} m/s^2", gravity); });
}

/// What acts, as the acceleration that it would give to all masses together.
void suspect_loads(const System& system, const Evaluation& e, const Wreck& wreck, Suspects& suspects) {
  const Model& model = system.model();
  double mass = 0.0, inertia = 0.0;
  for (const Body& body : model.bodies) mass += body.mass, inertia += largest_inertia(body, model.space);
  const double size = system.size();
  if (!(mass > 0.0)) return;
  const auto by_force = [&](double force) { return force / mass; };
  const auto by_torque = [&](double torque) { return torque * size / (inertia + mass * size * size); };
  const auto amount = [](const double* v) { return std::hypot(v[0], v[1], v[2]); };
  const auto against = [&] { return fmt::format("on {:.3g} kg in a mechanism of {:.2g} m", mass, size); };
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    const double *force = &e.applied[6 * f], *torque = force + 3;
    suspects.add(by_force(amount(force)) / most_acceleration, [&] {
      return fmt::format("force '{}' is {:.3g} N {}", model.forces[f].name, amount(force), against());
    });
    suspects.add(by_torque(amount(torque)) / most_acceleration, [&] {
      return fmt::format("torque '{}' is {:.3g} N m {}", model.forces[f].name, amount(torque), against());
    });
  }
  for (std::size_t d = 0; d < model.drivers.size(); ++d) {
    const Driver& driver = model.drivers[d];
    if (prescribes(driver.kind)) continue;
    const bool turns = system.joints().layout(driver.joint).coordinate == Coordinate::angle;
    const double effort = std::abs(e.motion[d].value);
    suspects.add((turns ? by_torque(effort) : by_force(effort)) / most_acceleration, [&] {
      return fmt::format("driver '{}' gives {:.3g} {} {}", driver.name, effort, turns ? "N m" : "N", against());
    });
  }
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointElement& element = model.joints[at(j)];
    if (!is_force_element(element)) continue;
    const double *wrench = &e.wrench[12 * at(j) + 6], torque = amount(wrench + 3);
    const double first = at(j) < wreck.first_forces.size() ? wreck.first_forces[at(j)] : 0.0;
    const double force = std::max(amount(wrench), first);
    const bool pulls = by_force(force) >= by_torque(torque);
    suspects.add(std::max(by_force(force), by_torque(torque)) / most_of_element, [&] {
      return fmt::format("'{}' acts with {:.3g} {} {}: check its numbers and their units", element.name,
                         pulls ? force : torque, pulls ? "N" : "N m", against());
    });
  }
}

/// A speed of a driver that jumped shortly before, as at a point of a straight table or path.
void suspect_jump(const System& system, const Wreck& wreck, Suspects& suspects) {
  const Model& model = system.model();
  const double span = model.settings.end - model.settings.start, beside = 1e-9 * span;
  std::vector<TimeValue> before(model.drivers.size()), after(before);
  MotionFault fault;
  DriveKinks kinks(model);
  for (double kink = wreck.t - shortly_before * span; (kink = kinks.next(kink, wreck.t)) <= wreck.t;) {
    if (!system.motions().evaluate(kink - beside, {before.data(), before.size()}, fault) ||
        !system.motions().evaluate(kink + beside, {after.data(), after.size()}, fault)) {
      continue;
    }
    for (std::size_t d = 0; d < model.drivers.size(); ++d) {
      const Driver& driver = model.drivers[d];
      if (!prescribes(driver.kind)) continue;
      const bool turns = system.joints().layout(driver.joint).coordinate == Coordinate::angle;
      suspects.add(std::abs(after[d].rate - before[d].rate) * (turns ? arm_of(system) : 1.0) / least_jump, [&] {
        return fmt::format("driver '{}'{} jumps at t = {:.6g} s: its speed from {:.4g} to {:.4g} {}", driver.name,
                           driver.kinematics < 0
                               ? std::string()
                               : fmt::format(" on the path of '{}'", model.kinematics[at(driver.kinematics)].name),
                           kink, before[d].rate, after[d].rate, turns ? "rad/s" : "m/s");
      });
    }
  }
}

// Rubber does bear a load, but not that of a machine of metal.
void suspect_soft_joint(const System& system, const Wreck& wreck, Suspects& suspects) {
  if (wreck.joint < 0) return;
  const JointElement& joint = system.model().joints[at(wreck.joint)];
  const JointLayout& layout = system.joints().layout(wreck.joint);
  const double modulus = layout.contact_modulus;
  suspects.add(soft / modulus, [&] {
    return fmt::format("E and nu of joint '{}' make an E* of {:.3g} Pa, as of rubber: are they meant in GPa",
                       joint.name, modulus);
  });
  if (!joint.parameters) return;
  const auto given = given_stiffness(*joint.parameters, layout, system.size());
  if (given) suspects.add(soft / given->modulus, [&] { return words_of(*given, joint, true, "as of rubber"); });
}

// Steps of one size alone can be too long.
void suspect_step(const System& system, const Evaluation& e, const Wreck& wreck, Suspects& suspects) {
  if (wreck.joint < 0 || !(system.joints().layout(wreck.joint).clearance > 0.0)) return;
  const JointElement& element = system.model().joints[at(wreck.joint)];
  const MarkerKinematics &a = e.markers[at(element.marker_a)], &b = e.markers[at(element.marker_b)];
  const double speed =
      std::hypot(b.velocity[0] - a.velocity[0], b.velocity[1] - a.velocity[1], b.velocity[2] - a.velocity[2]);
  const double clearance = system.joints().layout(wreck.joint).clearance, dt = wreck.dt;
  suspects.add(speed * dt / (most_of_clearance * clearance), [&] {
    return fmt::format(
        "in a step of {:.2g} s the surfaces of joint '{}' move by {:.2g} m, {:.2g} times the clearance: "
        "the step is too long",
        dt, element.name, speed * dt, speed * dt / clearance);
  });
}

}  // namespace

double extent(const Model& model, BodyId body) {
  const Vector3& com = model.bodies[at(body)].com;
  Vector3 low, high;
  for (std::size_t i = 0; i < 3; ++i) low[i] = std::min(0.0, com[i]), high[i] = std::max(0.0, com[i]);
  for (const Marker& frame : model.frames) {
    if (frame.body != body) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], frame.position[i]);
      high[i] = std::max(high[i], frame.position[i]);
    }
  }
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

std::string likely_cause(const System& system, const Evaluation& e, const Wreck& wreck) {
  Suspects suspects;
  suspect_bodies(system, suspects);
  suspect_materials(system, suspects);
  suspect_motion(system, wreck, suspects);
  suspect_loads(system, e, wreck, suspects);
  if (suspects.sentence().empty() && !wreck.worker.empty()) return wreck.worker;
  // Where the model is sound, or seems to be.
  if (suspects.sentence().empty()) suspect_jump(system, wreck, suspects);
  if (suspects.sentence().empty()) suspect_step(system, e, wreck, suspects);
  if (suspects.sentence().empty()) suspect_soft_joint(system, wreck, suspects);
  return suspects.sentence();
}

}  // namespace freeplay
