// Platforms for tests: models as text, and independent numbers of them (tests/data/platform_numbers.json).
#pragma once

#include <cmath>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "analysis/clearance_error.h"
#include "analysis/posture.h"
#include "analysis/singularity.h"
#include "base/json_text.h"
#include "source_folder.h"
#include "validation/run_model.h"

namespace freeplay::platforms {

inline const Json& numbers() {
  static const Json all =
      Json::parse(test::read_text(std::string(test::source_folder()) + "/tests/data/platform_numbers.json"));
  return all;
}

/// Sizes of a mechanism of the numbers, or others of the same form.
inline Json sizes(const std::string& mechanism) { return numbers()["sizes"][mechanism]; }

struct Play {
  double b = 1e-4, c = 1e-4, backlash = 0.0;
};

/// Legs A_i = l4 e(alpha_i), crank l1, coupler l2, C_i = l3 e(alpha_i) on the platform; `path` is YAML.
inline std::string legs_text(const Json& m, int elbow = 1, const Play& play = {},
                             const std::string& path = "{x: 0, y: 0, angle: 0}",
                             const std::string& gravity = "[0, 0]") {
  std::string bodies =
      fmt::format("  platform: {{mass: {}, inertia: {}}}\n", m["mp"].get<double>(), m["Jp"].get<double>());
  std::string frames, joints, clearance;
  const int legs = m["legs"];
  for (int i = 0; i < legs; ++i) {
    const auto size = [&](const char* key) {
      return m[key].is_array() ? m[key][static_cast<std::size_t>(i)].get<double>() : m[key].get<double>();
    };
    const double a = m["first_angle"].get<double>() + 2.0 * M_PI * i / legs;
    bodies += fmt::format("  crank{}: {{mass: {}, inertia: {}, com: [{}, 0], frames: {{tip: [{}, 0]}}}}\n", i,
                          size("m1"), size("J1"), size("l1") / 2, size("l1"));
    bodies += fmt::format("  coupler{}: {{mass: {}, inertia: {}, com: [{}, 0], frames: {{tip: [{}, 0]}}}}\n", i,
                          size("m2"), size("J2"), size("l2") / 2, size("l2"));
    frames += fmt::format("  ground/A{}: [{:.17g}, {:.17g}]\n  platform/C{}: [{:.17g}, {:.17g}]\n", i,
                          size("l4") * std::cos(a), size("l4") * std::sin(a), i, size("l3") * std::cos(a),
                          size("l3") * std::sin(a));
    joints += fmt::format(
        "  A{0}: {{type: revolute, between: [ground/A{0}, crank{0}]}}\n"
        "  B{0}: {{type: revolute, between: [crank{0}/tip, coupler{0}]}}\n"
        "  C{0}: {{type: revolute, between: [coupler{0}/tip, platform/C{0}]}}\n",
        i);
    clearance += fmt::format("      B{}: {}\n      C{}: {}\n", i, play.b, i, play.c);
  }
  return "freeplay: 1\ngravity: " + gravity + "\nbodies:\n" + bodies + "frames:\n" + frames + "joints:\n" + joints +
         fmt::format(
             "drivers:\n  path:\n    inverse_kinematics: {{frame: platform, path: {}, joints: A*, elbow: {}}}\n", path,
             elbow) +
         fmt::format("analysis:\n  error:\n    input: {}\n    clearance:\n", play.backlash) + clearance;
}

/// A mechanism with its solver.
struct Bench {
  explicit Bench(const std::string& text)
      : model(test::load(text)), mechanism(*model, platform_of(*model)), solver(mechanism) {}

  static Demand at(double x, double y, double angle) {
    Demand demand;
    demand.given = {true, true, true};
    demand.pose = {Jet::constant(x), Jet::constant(y), Jet::constant(angle)};
    return demand;
  }
  Posture reach(const Demand& demand) {
    Posture posture;
    Unreachable why;
    if (!solver.reach(demand, mechanism.closed_form() ? Posture{} : mechanism.start(), posture, why)) {
      throw std::runtime_error(why.text(mechanism));
    }
    return posture;
  }
  VelocityMap map(const Posture& posture, const Components& kept = {true, true, true}) {
    VelocityMapper mapper(mechanism, kept);
    VelocityMap out;
    mapper.map(solver.evaluate(0.0, posture, term_position), out);
    return out;
  }

  std::unique_ptr<Model> model;
  IdealMechanism mechanism;
  PostureSolver solver;
};

inline Demand pose_of(const Json& pose) { return Bench::at(pose[0], pose[1], pose[2]); }

}  // namespace freeplay::platforms
