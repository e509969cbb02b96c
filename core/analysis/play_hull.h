// PlayHull: play between flat bounds, as JointLayout::play_bounds has them.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "freeplay/joint.h"

namespace freeplay {

/// All y with |facets y| <= 1, which is the convex hull of the vertices and of their opposites. The largest |y_k| is 1.
struct PlayHull {
  Eigen::MatrixXd facets;    ///< bounds x numbers of y
  Eigen::MatrixXd vertices;  ///< numbers of y x half of the vertices: the others are their opposites

  /// Largest w.y.
  double support(const Eigen::VectorXd& w) const { return (vertices.transpose() * w).cwiseAbs().maxCoeff(); }
  /// By what y must be divided to lie on the boundary.
  double gauge(const Eigen::VectorXd& y) const { return (facets * y).cwiseAbs().maxCoeff(); }
};

/// The displacements that the bounds leave, `size` sum y_k twist_k: shift [m/m] and rotation vector [rad/m] in the axes
/// of the first marker. Of what no bound holds they have nothing.
struct BoundedPlay {
  std::vector<std::array<double, 6>> twist;
  PlayHull hull;
};

/// `size`: a length that the twists are counted by [m].
BoundedPlay bounded_play(Span<const double> play_bounds, double size);

}  // namespace freeplay
