// Simulation: steps that end with energy that nothing has put in.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "run/likely_cause.h"
#include "run/simulation_impl.h"

namespace freeplay {
namespace {
constexpr double suspicious =
    2.0;  // energy of motion and of joints, by the largest before: work is looked at from there
constexpr double singular = 1e-4;      // regularity
constexpr double digits = 1e-9;        // of potential energies that their differences keep, at least
constexpr double transmission = 10.0;  // speed of bodies, by that of drivers: a mechanism may come to it in a step
constexpr double unexplained = 2.0;    // growth of energy, by all work that powers at both ends could have done
}  // namespace

// Of motion and of what joints store: without gravity's, which has no zero.
double Simulation::Impl::energy_of(const Evaluation& e) const {
  double sum = system.kinetic_energy(e.v);
  for (const double potential : e.potential) sum += potential;
  return sum;
}

// Of all masses, moved ten times as fast as the fastest prescribing driver at either end of the step, and what
// potential energies of weights and work of loads are rounded to: of a short step from rest, or from links in line with
// what pushes them, nothing else is left.
double Simulation::Impl::energy_of_drives() const {
  double squared = 0.0, mass = 0.0, lifted = std::abs(system.gravity_potential(e_accepted->q));
  for (std::size_t d = 0; d < model.drivers.size(); ++d) {
    const bool rotates = system.joint_layout(model.drivers[d].joint).coordinate == Coordinate::angle;
    if (!prescribes(model.drivers[d].kind)) {
      const double effort = std::max(std::abs(e_accepted->motion[d].value), std::abs(e_trial->motion[d].value));
      lifted += rotates ? effort : effort * system.size();
      continue;
    }
    const double rate = std::max(std::abs(e_accepted->motion[d].rate), std::abs(e_trial->motion[d].rate));
    const double speed = rotates ? rate * system.size() : rate;
    squared = std::max(squared, speed * speed);
  }
  const auto amount = [](const double* v) { return std::hypot(v[0], v[1], v[2]); };
  const auto along_size = [&](const double* wrench) { return amount(wrench) * system.size() + amount(wrench + 3); };
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    lifted += std::max(along_size(&e_accepted->applied[6 * f]), along_size(&e_trial->applied[6 * f]));
  }
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    if (model.joints[j].is_force) lifted += along_size(&e_accepted->wrench[12 * j + 6]);
  }
  for (const Body& body : model.bodies) {
    mass += body.mass;
    lifted += body.mass * std::hypot(body.gravity[0], body.gravity[1], body.gravity[2]) * system.size();
  }
  return 0.5 * mass * squared * transmission * transmission + digits * lifted;
}

// Whether energy has grown in the step that was just made far beyond the work of drivers, forces and gravity. Implicit
// methods do this in steps that overshoot a contact; a shorter one does not. Only a step that passes twice the
// largest energy that was explained so far is looked at. A jump of a driver's speed does work in no time and is left
// alone.
bool Simulation::Impl::gains_energy() {
  const double after = energy_of(e_trial);
  if (after <= suspicious * explained_energy) return false;
  const double dt = trial.t() - accepted.t();
  if (kinks.next(accepted.t(), trial.t()) <= trial.t()) return false;
  const double before = energy_of(e_accepted), high = system.gravity_potential(e_accepted->q);
  const double fallen = high - system.gravity_potential(e_trial->q), drives = energy_of_drives();
  const double work =
      std::abs(fallen) + dt * energy.largest_power(e_accepted, accepted.lambda(), e_trial, trial.lambda());
  gained = after - before;
  if (gained > unexplained * work + explained_energy + drives) return true;
  // What steps before have gained, each a little.
  gained = before + high + energy.lost_less_given(e_accepted);
  if (gained > 0.5 * after && gained > explained_energy + drives) return true;
  explained_energy = after;
  return false;
}

// Contacts are overshot by steps; constraints alone come to this where the mechanism cannot go on.
std::string Simulation::Impl::why_energy_grows(double dt) {
  if (model.clearance_joints() == 0) {
    return adaptive && solver.regularity() < singular ? why_singular() : why_not_converged(dt);
  }
  std::string text = fmt::format(
      "t = {:.9g} s: energy would grow by {:.3g} J in a step of {:.3g} s, more than everything that acts could put in",
      accepted.t(), gained, dt);
  const int joint = hardest_joint(ground);
  if (joint >= 0) text += fmt::format("; joint '{}' pulls hardest", model.joints[static_cast<std::size_t>(joint)].name);
  const std::string cause = likely_cause(system, e_accepted, {accepted.t(), adaptive ? 0.0 : dt, joint, first_forces});
  return text + (cause.empty() ? std::string(advice::accuracy) : "; likely cause: " + cause);
}

/// Numbers of the program's own types that are not finite any more come of the model or of the step.
std::string Simulation::Impl::why_beyond_bounds(double t, int joint) const {
  std::string text = fmt::format("t = {:.9g} s: forces and speeds grow beyond all bounds", t);
  const int hardest = joint >= 0 ? joint : hardest_joint(ground);
  if (hardest >= 0) text += fmt::format(", first in joint '{}'", model.joints[static_cast<std::size_t>(hardest)].name);
  const std::string cause =
      likely_cause(system, e_accepted, {t, adaptive ? 0.0 : settings.step, hardest, first_forces});
  return text + (cause.empty() ? std::string(advice::accuracy) : "; likely cause: " + cause);
}

bool Simulation::Impl::all_built_in() const {
  return std::ranges::all_of(model.instances.libraries(),
                             [](const RegisteredLibrary& library) { return library.path == "built-in"; });
}

}  // namespace freeplay
