// FeasibleSet: where the platform can go while the play of every joint and the error of every input stay in bounds.
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace freeplay {

/// One play (a disc, 2 columns) or one input (a segment, 1 column) and how far it goes.
struct Generator {
  Eigen::MatrixXd columns;  ///< rows x 2 or rows x 1
  double size = 0.0;        ///< radius [m], or half length [rad or m]
};

/// Largest values over a set of platform displacements dX = (dx, dy [m], dangle [rad]).
struct WorstCase {
  double position = 0.0;                    ///< of |(dx, dy)|
  double dx = 0.0, dy = 0.0, dangle = 0.0;  ///< of |dx|, |dy|, |dangle|
  Eigen::Vector3d worst{0.0, 0.0, 0.0};     ///< dX of the largest position error; minus it is as bad
  Eigen::VectorXd multipliers;              ///< mu with A^T mu = (worst direction, 0), optimal there
};

/// All dX with A dX = sum of columns_k delta_k, |delta_k| <= size_k, for A (rows x 3) of rank 3. Its support function
/// is, by convex duality,
///   h(n) = max n.dX = min { sum size_k |columns_k^T mu| : A^T mu = n }
/// The bound is exact: with three rows mu is unique; where every generator acts on one row only the set is the polytope
/// |A_i dX| <= D_i and its vertices are tried; else h is minimised by Newton's method (to 1e-11 of it, from above) and
/// its largest value found by branch and bound over directions.
WorstCase exact_worst_case(const Eigen::MatrixXd& a, const std::vector<Generator>& generators);

/// The same where every row errs as it likes and A dX = d is solved by least squares, dX = A^+ d: never below the exact
/// bound, equal to it for three rows. `pseudo_inverse`: A^+, 3 x rows.
WorstCase least_squares_worst_case(const Eigen::MatrixXd& pseudo_inverse, const std::vector<Generator>& generators);

/// The farthest point of a centrally symmetric convex set in the plane from its support function; `support(n, p)`
/// returns h(n) for a unit vector n and sets p to a point where it is attained (roughly will do). Branch and bound over
/// directions with h's convexity: no direction is left where h could exceed the result by 1e-10 of it. Returns the
/// distance and sets `direction`.
double farthest(const std::function<double(const Eigen::Vector2d&, Eigen::Vector2d&)>& support,
                Eigen::Vector2d& direction);

}  // namespace freeplay
