#include "system/inertia.h"

#include "base/index.h"
#include "system/spatial_kinematics.h"

namespace freeplay {

Inertia::Inertia(const Model& model, const Layout& layout, const BodyCoordinates& coordinates)
    : unknowns_(at(layout.nv())),
      coordinates_(at(layout.body_coordinates())),
      velocities_(at(layout.body_velocities())) {
  for (int place = 0; place < static_cast<int>(model.bodies.size()); ++place) {
    const Body& body = model.bodies[at(layout.body_at(place))];
    const double m = body.mass;
    if (model.space == Space::planar) {
      mass_.insert(mass_.end(), {m, m, body.inertia[8]});
      weight_.insert(weight_.end(), {m * body.gravity[0], m * body.gravity[1], 0.0});
      continue;
    }
    const spatial::Vector& moments = coordinates.principal_moments(layout.body_at(place));
    mass_.insert(mass_.end(), {m, m, m, moments[0], moments[1], moments[2]});
    weight_.insert(weight_.end(), {m * body.gravity[0], m * body.gravity[1], m * body.gravity[2], 0.0, 0.0, 0.0});
  }
}

double Inertia::kinetic_energy(std::span<const double> v) const {
  double energy = 0.0;
  for (std::size_t i = 0; i < mass_.size(); ++i) energy += 0.5 * mass_[i] * v[i] * v[i];
  return energy;
}

double Inertia::gravity_potential(std::span<const double> q) const {
  double energy = 0.0;
  for (std::size_t b = 0; b < mass_.size() / velocities_; ++b) {
    // Weight acts on positions, which come first in both.
    for (std::size_t i = 0; i < 3; ++i) energy -= weight_[velocities_ * b + i] * q[coordinates_ * b + i];
  }
  return energy;
}

void Inertia::add_gyroscopic(std::span<const double> v, std::span<double> force, std::span<double> by_w) const {
  for (std::size_t b = 0; b < mass_.size() / 6; ++b) {
    const spatial::Vector w = spatial::vector(&v[6 * b + 3]), inertia = spatial::vector(&mass_[6 * b + 3]);
    const spatial::Vector spin = inertia.cwiseProduct(w);
    Eigen::Map<spatial::Vector>(&force[6 * b + 3]) -= w.cross(spin);
    if (by_w.empty()) continue;
    double* to = &by_w[9 * b];  // row-major
    for (int c = 0; c < 3; ++c) {
      const spatial::Vector unit = spatial::Vector::Unit(c);
      const spatial::Vector column = -(unit.cross(spin) + inertia[c] * w.cross(unit));
      for (int r = 0; r < 3; ++r) to[3 * r + c] = column[r];
    }
  }
}

}  // namespace freeplay
