// ClosedPlay: random walks over the plays with which a redundant mechanism closes.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/play_hull.h"
#include "analysis/play_law.h"

namespace freeplay {

/// An interval (1 number), a disc (2) or a ball (3) of size 1 among the plays, or a polytope.
struct PlayRoom {
  Eigen::Index place, size;
  const PlayHull* hull = nullptr;
};

/// Plays y in their rooms with closure y = 0, distributed as independent plays are, given that they close. Both walks
/// leave that law as it is: over discs a random chord (hit and run; Smith 1984), on which a normal law is drawn by
/// slices (Neal 2003); on rims a step along the tangent, put back on the manifold, accepted by Metropolis' rule with
/// its way back (Zappa, Holmes-Cerfon and Goodman 2018); on rims of discs only, not of balls or polytopes.
class ClosedPlay {
 public:
  /// Columns of `across` and of `along` are orthonormal, one row for each number of the rooms: y closes where
  /// across^T y = 0, and is then a sum of columns of `along`.
  ClosedPlay(const Eigen::MatrixXd& across, Eigen::MatrixXd along, std::vector<PlayRoom> rooms, const PlayLaw& law,
             RandomDraws& random);
  /// False where no play with every pin on its rim was found to close.
  bool exists() const { return exists_; }
  /// The plays after one more step.
  const Eigen::VectorXd& next();

 private:
  struct Rim {
    Eigen::VectorXd place;   // angle of each disc, value of each interval
    Eigen::MatrixXd normal;  // columns: gradients of the closure by place
    Eigen::MatrixXd basis;   // orthonormal, of the normals
    double volume = 0.0;     // of the parallelepiped of the normals
  };
  void walk_over_discs();
  void walk_on_rims();
  bool find_rims();
  bool look(Rim& rim) const;
  Eigen::MatrixXd normal_at(const Eigen::VectorXd& place) const;
  bool put_back(const Eigen::MatrixXd* normal, Eigen::VectorXd& place) const;
  bool inside(const Eigen::VectorXd& place) const;
  Eigen::VectorXd plays_at(const Eigen::VectorXd& place) const;

  Eigen::MatrixXd closure_, along_;
  std::vector<PlayRoom> rooms_;
  PlayLaw law_;
  RandomDraws& random_;
  Eigen::VectorXd plays_;
  Rim rim_;
  bool exists_ = true;
};

}  // namespace freeplay
