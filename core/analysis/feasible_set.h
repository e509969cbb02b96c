// FeasibleSet: where the platform can go while the play of every joint and the error of every input stay in bounds.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "analysis/play_hull.h"
#include "analysis/pose_form.h"

namespace freeplay {

/// One play (a segment, a disc or a ball: 1 to 3 columns, or a polytope) or one input (a segment) and how far it goes.
struct Generator {
  Eigen::MatrixXd columns;         ///< rows x numbers
  double size = 0.0;               ///< radius [m], or half length [rad or m]
  const PlayHull* hull = nullptr;  ///< of a polytope, whose numbers are `size` times those of the hull

  /// Its support function for size 1: largest mu.(columns delta).
  double support(const Eigen::VectorXd& mu) const {
    const Eigen::VectorXd w = columns.transpose() * mu;
    return hull == nullptr ? w.norm() : hull->support(w);
  }
};

/// Largest values over a set of platform displacements dX (PoseForm).
struct WorstCase {
  double position = 0.0;                         ///< of the length of the shift [m]
  double dangle = 0.0;                           ///< of the angle that it turns by [rad]
  std::array<double, most_components> change{};  ///< of |dX_i| [m or rad]
  Eigen::VectorXd worst;                         ///< dX of the largest position error; minus it is as bad
  Eigen::VectorXd multipliers;                   ///< mu with A^T mu = (worst direction, 0), optimal there
};

/// All dX with A dX = sum of columns_k delta_k, |delta_k| <= size_k or in the hull times it, for A with 3 columns
/// (plane) or 6 (space) and their rank. Its support function is, by convex duality,
///   h(n) = max n.dX = min { sum size_k |columns_k^T mu| : A^T mu = n }        of a hull its own support for the norm
/// The bound is exact: with as many rows as columns mu is unique; where in the plane every generator acts on one row
/// only the set is the polytope |A_i dX| <= D_i and its vertices are tried; else h is minimised by Newton's method (to
/// 1e-11 of it, from above). Its largest value is found by branch and bound over directions.
WorstCase exact_worst_case(const Eigen::MatrixXd& a, const std::vector<Generator>& generators);

/// The same where every row errs as it likes and A dX = d is solved by least squares, dX = A^+ d: never below the exact
/// bound, equal to it where A is square. `pseudo_inverse`: A^+.
WorstCase least_squares_worst_case(const Eigen::MatrixXd& pseudo_inverse, const std::vector<Generator>& generators);

/// The farthest point of a centrally symmetric convex set in the plane from its support function; `support(n, p)`
/// returns h(n) for a unit vector n and sets p to a point where it is attained (roughly will do). Branch and bound over
/// directions with h's convexity: no direction is left where h could exceed the result by 1e-10 of it. Returns the
/// distance and sets `direction`.
double farthest(const std::function<double(const Eigen::Vector2d&, Eigen::Vector2d&)>& support,
                Eigen::Vector2d& direction);

/// The same in space, certain to 1e-7. Where a set is so round that this takes too many directions, the bound that is
/// left is returned: too large by 1e-4 at most, never too small.
double farthest(const std::function<double(const Eigen::Vector3d&, Eigen::Vector3d&)>& support,
                Eigen::Vector3d& direction);

}  // namespace freeplay
