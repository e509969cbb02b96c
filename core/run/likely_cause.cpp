#include "run/likely_cause.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/index.h"

namespace freeplay {
namespace {

// What no machine has.
constexpr double most_gyration = 3.0;      // radius of gyration, by the size of the body
constexpr double most_density = 1e5;       // mass by the cube of the model's size [kg/m^3]: four times osmium's
constexpr double softest = 1e5;            // E* [Pa]: a tenth of soft rubber's
constexpr double stiffest = 1.5e12;        // E* [Pa]: above diamond's
constexpr double most_lengths = 100.0;     // size of a body, by the median of all
constexpr double most_gravity = 1e3;       // [m/s^2]
constexpr double fastest_turn = 1e5;       // of a driver [rad/s]: a million turns a minute
constexpr double fastest_slide = 1e3;      // of a driver [m/s]
constexpr double most_of_clearance = 0.2;  // way of one surface in another in a step, by the clearance

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

void suspect_bodies(const System& system, Suspects& suspects) {
  const Model& model = system.model();
  std::vector<double> sizes;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (const double size = extent(model, b); size > 0.0) sizes.push_back(size);
  }
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>((sizes.size() - (sizes.empty() ? 0 : 1)) / 2);
  if (!sizes.empty()) std::ranges::nth_element(sizes, middle);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[at(b)];
    const double own = extent(model, b), size = own > 0.0 ? own : system.size();
    const double inertia = largest_inertia(body, model.space), gyration = std::sqrt(inertia / body.mass);
    suspects.add(gyration / (most_gyration * size), [&] {
      return fmt::format(
          "inertia of '{}' is {:.4g} kg m^2 for a mass of {:.4g} kg: its radius of gyration would be "
          "{:.2g} m",
          body.name, inertia, body.mass, gyration);
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

void suspect_materials(const System& system, Suspects& suspects) {
  const Model& model = system.model();
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const double modulus = system.joint_layout(j).contact_modulus;
    const auto text = [&](const char* what) {
      return fmt::format("E and nu of joint '{}' make an E* of {:.3g} Pa: {}", model.joints[at(j)].name, modulus, what);
    };
    suspects.add(softest / modulus, [&] { return text("softer than rubber; is a prefix such as GPa missing"); });
    suspects.add(modulus / stiffest, [&] { return text("stiffer than diamond; is a unit given twice"); });
  }
}

void suspect_motion(const System& system, const Evaluation& e, Suspects& suspects) {
  const Model& model = system.model();
  for (std::size_t d = 0; d < model.drivers.size(); ++d) {
    const Driver& driver = model.drivers[d];
    if (!prescribes(driver.kind)) continue;
    const bool turns = system.joint_layout(driver.joint).coordinate == Coordinate::angle;
    const double rate = std::abs(e.motion[d].rate);
    suspects.add(rate / (turns ? fastest_turn : fastest_slide), [&] {
      return turns ? fmt::format("driver '{}' turns with {:.3g} rad/s, that is {:.2g} turns a minute", driver.name,
                                 rate, rate * 30.0 / M_PI)
                   : fmt::format("driver '{}' moves with {:.3g} m/s", driver.name, rate);
    });
  }
  const Vector3& g = model.gravity;
  const double gravity = std::hypot(g[0], g[1], g[2]);
  suspects.add(gravity / most_gravity, [&] { return fmt::format("gravity is {:.3g} m/s^2", gravity); });
}

void suspect_step(const System& system, const Evaluation& e, double dt, int joint, Suspects& suspects) {
  if (joint < 0 || !(system.joint_layout(joint).clearance > 0.0)) return;
  const JointElement& element = system.model().joints[at(joint)];
  const MarkerKinematics &a = e.markers[at(element.marker_a)], &b = e.markers[at(element.marker_b)];
  const double speed =
      std::hypot(b.velocity[0] - a.velocity[0], b.velocity[1] - a.velocity[1], b.velocity[2] - a.velocity[2]);
  const double clearance = system.joint_layout(joint).clearance;
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

std::string likely_cause(const System& system, const Evaluation& e, double dt, int joint) {
  Suspects suspects;
  suspect_bodies(system, suspects);
  suspect_materials(system, suspects);
  suspect_motion(system, e, suspects);
  // Where the model is sound, or seems to be.
  if (suspects.sentence().empty()) suspect_step(system, e, dt, joint, suspects);
  return suspects.sentence();
}

}  // namespace freeplay
