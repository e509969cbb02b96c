// ClearanceError: how far play and errors of the inputs can move a platform from its pose, to first order.
#pragma once

#include <optional>
#include <vector>

#include "analysis/feasible_set.h"
#include "analysis/velocity_map.h"

namespace freeplay {

/// Worst case at one pose. The plays are bounded as Play says, each input errs by at most
/// IdealMechanism::input_error(); Innocenti 2002. Which joint causes how much of the worst position error: its
/// sensitivity times its play; these shares add up to the error.
struct ClearanceError {
  WorstCase exact;          ///< over displacements that rigid bodies allow
  WorstCase least_squares;  ///< every leg errs by itself, A dX = d solved by least squares
  /// Derivative of the exact position error by the radius of each play [m/m], then by the error of each input
  /// [m/rad or m/m], valid while the same links are stretched.
  std::vector<double> sensitivity;
};

/// `map` keeps all changes of the pose. Empty where A has not their rank (smallest singular value below
/// `singular_limit` with turns times L): the platform moves while its inputs are held, and errors have no bound.
std::optional<ClearanceError> clearance_error(const IdealMechanism& mechanism, const VelocityMap& map);

/// Generators of the right side of A dX = ..., plays first, then inputs; those of size 0 too.
std::vector<Generator> generators_of(const IdealMechanism& mechanism, const VelocityMap& map);

/// A^+ (changes x rows) with residuals in the rows' own scale; empty where A has not the rank of its columns. `length`:
/// L [m].
std::optional<Eigen::MatrixXd> pseudo_inverse(const VelocityMap& map, double length);

}  // namespace freeplay
