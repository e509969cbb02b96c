// Inertia: masses and weights of the bodies, in the order of their places (Layout::place).
#pragma once

#include <span>
#include <vector>

#include "system/body_coordinates.h"
#include "system/layout.h"

namespace freeplay {

class Inertia {
 public:
  Inertia(const Model& model, const Layout& layout, const BodyCoordinates& coordinates);

  /// Diagonal of M: mass, mass, inertia of every free body; in space mass three times and the principal inertias.
  std::span<const double> mass() const { return std::span(mass_).first(unknowns_); }
  /// The same of driven bodies.
  std::span<const double> driven_mass() const { return std::span(mass_).subspan(unknowns_); }
  /// Generalised forces of gravity on all bodies.
  std::span<const double> weight() const { return weight_; }

  /// For the velocities and coordinates of all bodies, as in MarkerValues::v and MarkerValues::q.
  double kinetic_energy(std::span<const double> v) const;
  double gravity_potential(std::span<const double> q) const;

  /// In space: adds the moments -w x (I w) of turning bodies; `by_w`, unless it is empty, becomes their derivatives by
  /// w, 3 x 3 numbers by body.
  void add_gyroscopic(std::span<const double> v, std::span<double> force, std::span<double> by_w) const;

 private:
  std::size_t unknowns_, coordinates_, velocities_;
  std::vector<double> mass_, weight_;
};

}  // namespace freeplay
