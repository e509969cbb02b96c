#include "run/energy_growth.h"

#include <algorithm>
#include <cmath>

#include "model/force_element.h"

namespace freeplay {
namespace {
constexpr double suspicious =
    2.0;                         // energy of motion and of joints, by the largest before: work is looked at from there
constexpr double digits = 1e-9;  // of potential energies that their differences keep, at least
constexpr double transmission = 10.0;  // speed of bodies, by that of drivers: a mechanism may come to it in a step
constexpr double unexplained = 2.0;    // growth of energy, by all work that powers at both ends could have done
constexpr double no_energy = 1e-200;   // [J]: squares of the speeds that make it lose their digits
}  // namespace

// Of motion and of what joints store: without gravity's, which has no zero. What a spring stores has none either where
// it is loaded at its free length: the size counts its amount.
EnergyGrowth::Energy EnergyGrowth::energy_of(const Evaluation& e) const {
  Energy out;
  out.value = out.size = run_.system.inertia().kinetic_energy(e.v);
  for (const double potential : e.potential) {
    out.value += potential;
    out.size += std::abs(potential);
  }
  return out;
}

// Largest energy that a step may gain: the kinetic energy of all masses at ten times the speed of the fastest driver at
// either end of the step, and the rounding of potential energies and of the work of loads, which is all that is left in
// a short step from rest. An accuracy of L leaves speeds of L per second open.
double EnergyGrowth::energy_of_drives() const {
  double squared = run_.settings.accuracy * run_.settings.accuracy, mass = 0.0,
         lifted = std::abs(run_.system.inertia().gravity_potential(run_.e_accepted->q));
  for (std::size_t d = 0; d < run_.model.drivers.size(); ++d) {
    const bool rotates = run_.system.joints().layout(run_.model.drivers[d].joint).coordinate == Coordinate::angle;
    if (!prescribes(run_.model.drivers[d].kind)) {
      const double effort =
          std::max(std::abs(run_.e_accepted->motion[d].value), std::abs(run_.e_trial->motion[d].value));
      lifted += rotates ? effort : effort * run_.system.size();
      continue;
    }
    const double rate = std::max(std::abs(run_.e_accepted->motion[d].rate), std::abs(run_.e_trial->motion[d].rate));
    const double speed = rotates ? rate * run_.system.size() : rate;
    squared = std::max(squared, speed * speed);
  }
  const auto amount = [](const double* v) { return std::hypot(v[0], v[1], v[2]); };
  const auto along_size = [&](const double* wrench) {
    return amount(wrench) * run_.system.size() + amount(wrench + 3);
  };
  for (std::size_t f = 0; f < run_.model.forces.size(); ++f) {
    lifted += std::max(along_size(&run_.e_accepted->applied[6 * f]), along_size(&run_.e_trial->applied[6 * f]));
  }
  for (std::size_t j = 0; j < run_.model.joints.size(); ++j) {
    if (is_force_element(run_.model.joints[j])) lifted += along_size(&run_.e_accepted->wrench[12 * j + 6]);
  }
  for (const Body& body : run_.model.bodies) {
    mass += body.mass;
    lifted += body.mass * std::hypot(body.gravity[0], body.gravity[1], body.gravity[2]) * run_.system.size();
  }
  return 0.5 * mass * squared * transmission * transmission + digits * lifted;
}

// Whether energy has grown in the step that was just made far beyond the work of drivers, forces and gravity. Implicit
// methods do this in steps that overshoot a contact; a shorter one does not. Only a step that passes twice the
// largest energy that was explained so far is looked at. A jump of a driver's speed does work in no time and is left
// alone.
bool EnergyGrowth::too_large() {
  const Energy after = energy_of(run_.e_trial);
  if (after.size <= std::max(suspicious * explained_energy_, no_energy)) return false;
  const double dt = run_.trial.t() - run_.accepted.t();
  if (run_.kinks.next(run_.accepted.t(), run_.trial.t()) <= run_.trial.t()) return false;
  const double before = energy_of(run_.e_accepted).value,
               high = run_.system.inertia().gravity_potential(run_.e_accepted->q);
  const double fallen = high - run_.system.inertia().gravity_potential(run_.e_trial->q), drives = energy_of_drives();
  const double work = std::abs(fallen) + dt * run_.energy.largest_power(run_.e_accepted, run_.accepted.lambda(),
                                                                        run_.e_trial, run_.trial.lambda());
  gained_ = after.value - before;
  if (gained_ > unexplained * work + explained_energy_ + drives) return true;
  // What steps before have gained, each a little.
  gained_ = before + high + run_.energy.lost_less_given(run_.e_accepted);
  if (gained_ > 0.5 * after.size && gained_ > explained_energy_ + drives) return true;
  explained_energy_ = after.size;
  return false;
}

}  // namespace freeplay
