// ElementRates: how fast the velocities of bodies move the ends of an element of force.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "system/system.h"

namespace freeplay {

/// At one position of a system, whose evaluation has markers and coordinates. Rates are rows, a column for each
/// velocity of the system; elements are entries of Model::joints that act by forces.
class ElementRates {
 public:
  static constexpr double one_place = 1e-9;  ///< ends nearer than this have no line between them [m]

  ElementRates(const System& system, const Evaluation& e) : system_(system), model_(system.model()), e_(e) {}

  /// From the first end to the second [m].
  Eigen::Vector3d apart(const JointElement& element) const;
  /// The same, of length 1.
  std::optional<Eigen::Vector3d> line(const JointElement& element) const;
  /// At which the second end goes ahead of the first along a direction, and both turn about z: by so much of each.
  Eigen::MatrixXd of_ends(const JointElement& element, const Eigen::Vector3d& along, double turn_a,
                          double turn_b) const;
  /// Of what the element acts along: its coordinate, or the distance of its ends.
  std::optional<Eigen::MatrixXd> of(int joint) const;

 private:
  /// In the columns of all velocities, from those of the two bodies.
  Eigen::MatrixXd spread(const JointElement& element, const double* row) const;

  const System& system_;
  const Model& model_;
  const Evaluation& e_;
};

}  // namespace freeplay
