// A puck in a ring: the mass that is dropped on a surface, as a pin joint with play.
#pragma once

#include "run_model.h"

namespace freeplay::test {

/// Ring of 5 mm bearing radius and 0.1 mm clearance, steel: K = 7.50621044644181e10 N/m^1.5.
struct Puck {
  double mass = 0.2, inertia = 1e-4;
  std::string ring = "bearing_radius: 5 mm, radial_clearance: 0.1 mm, material: {E: 207 GPa, nu: 0.3}";
  std::string contact = "hertz";
  std::string more = "";                        ///< of the block `clearance`, after a comma
  double x = 0.0, y = 0.0, vx = 0.0, vy = 0.0;  ///< eccentricity and its rate at the start
  std::string sections = "";                    ///< gravity, forces
  double end = 1e-3, step = 1e-7;
  std::string integrator = "bathe";

  std::string text() const {
    return "freeplay: 1\n" + sections + "bodies: {puck: {mass: " + number(mass) + ", inertia: " + number(inertia) +
           "}}\njoints:\n  ring:\n    type: revolute\n    between: [ground, puck]\n    clearance: {" + ring +
           ", contact: " + contact + more + ", initial: {eccentricity: [" + number(x) + ", " + number(y) +
           "], velocity: [" + number(vx) + ", " + number(vy) + "]}}\nsimulation: {end: " + number(end) +
           ", step: " + number(step) + ", integrator: " + integrator + ", output: {interval: " + number(end) + "}}\n";
  }
  ModelRun run() const { return ModelRun(text()); }
};

/// Fields of the events of a joint with play.
enum Field : std::size_t { speed, tangential_speed, direction, duration, max_force, max_penetration, steps };

/// Contacts from begin to end, in order of time.
struct Contact {
  Event begin, end;
};
inline std::vector<Contact> contacts(const ModelRun& run) {
  std::vector<Contact> all;
  for (const Event& event : run.events()) {
    if (event.kind == "contact_begin") all.push_back({event, {}});
    if (event.kind == "contact_end" && !all.empty()) all.back().end = event;
  }
  return all;
}

}  // namespace freeplay::test
