// VelocityMap: A dX = B dtheta + C delta, what ties the platform to its inputs and to the play of its joints.
#pragma once

#include <span>
#include <vector>

#include <Eigen/LU>
#include <Eigen/QR>

#include "analysis/ideal_mechanism.h"
#include "analysis/platform_frame.h"

namespace freeplay {

/// To first order, for small changes from a posture:
///   A dX = B dtheta + C delta
/// dX: the kept changes of the platform's frame (PoseForm), shifts [m] and turns [rad]. dtheta: by input [rad or m].
/// delta: the numbers of each Play [m]; in the plane journal centre minus bearing centre, world axes. All other
/// coordinates are eliminated part by part by left null vectors of their columns of the constraint Jacobian, so a row
/// belongs to one part. Kept x and y: (and z) rows are scaled to unit length of their part in these; for a leg, A holds
/// the direction u of its passive link, from the input towards the platform, and its moment about the frame (Gosselin
/// and Angeles 1990). Not all of these kept: unit length in the kept changes, turns times L. A single kept component:
/// rows of A and B together are orthonormal, an angle times L, inputs times the length of their crank; singular values
/// of A and B then do not depend on the choice of rows. Where a part has as many rows as inputs, more than one, each
/// row belongs to one input (of a single kept component it does not); where it has another number, its rows are
/// orthonormal in the shifts and L times the turns. Rows that only play can violate (redundant joints) have A = B = 0
/// and stand after the others of their part.
struct VelocityMap {
  Eigen::MatrixXd a;         ///< rows x kept components
  Eigen::MatrixXd b;         ///< rows x inputs
  Eigen::MatrixXd c;         ///< rows x IdealMechanism::play_numbers()
  std::vector<int> part;     ///< by row: place in IdealMechanism::parts(), -1 where parts hang together
  double inverse_min = 0.0;  ///< smallest singular value of B of any part over crank lengths
  std::vector<char> turns;   ///< by column of A: nonzero for a turn

  /// A with the columns of turns divided by `length`.
  Eigen::MatrixXd scaled_outputs(double length) const;
};

/// Fills maps again and again. Not thread-safe: one for each thread.
class VelocityMapper {
 public:
  /// `kept`: changes of the pose that dX holds. What is not kept is eliminated as well.
  VelocityMapper(const IdealMechanism& mechanism, const Components& kept);

  /// `e`: the mechanism's system evaluated at a posture (term_position | term_coordinate). `folded`: the posture is
  /// known to the root of the rounding only (PostureSolver::folded), so ranks are counted more coarsely.
  void map(const Evaluation& e, VelocityMap& out, bool folded = false);

 private:
  struct Fill {
    int block;       // of ConstraintJacobian::blocks(), -1: an input
    int from, rows;  // rows of the block
    int row;         // first row in the group
    int body;
  };
  struct Group {
    std::vector<int> parts, inputs, plays;
    std::vector<Fill> fills;
    std::vector<int> play_rows;     // by play: first row of its joint in the group
    std::vector<int> play_columns;  // by play: first column after those of the inputs
    int rows = 0, columns = 0, play_numbers = 0;
    Eigen::MatrixXd passive, right;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
    Eigen::VectorXd work;
  };

  void make_group(std::vector<int> parts);
  void eliminate(Group& group, const Evaluation& e);
  void put_play(Group& group, std::size_t p, const Evaluation& e);
  Eigen::Index take(Group& group, const Evaluation& e, Eigen::Index first, VelocityMap& out);
  Eigen::Index separate(const Group& group, Eigen::Ref<Eigen::MatrixXd> rows) const;
  double output_size(const Eigen::Ref<const Eigen::RowVectorXd>& row) const;
  Eigen::Vector3d shift_of(const Eigen::Ref<const Eigen::RowVectorXd>& row) const;
  void scale_turns(Eigen::Ref<Eigen::MatrixXd> outputs) const;
  void scale_single(const Group& group, const Evaluation& e, Eigen::Ref<Eigen::MatrixXd> row) const;
  void scale_several(const Group& group, Eigen::Ref<Eigen::MatrixXd> rows) const;
  double towards_platform(const Group& group, const Evaluation& e, const Eigen::Vector3d& shift) const;
  double smallest_input(const Group& group, const Eigen::Ref<const Eigen::MatrixXd>& rows) const;
  void put(Group& group, int row, int body, const double* g, const Evaluation& e);

  const IdealMechanism& mechanism_;
  const System& system_;
  PlatformFrame frame_;
  // Of each component its place among the kept ones, or -1 - its place among the eliminated.
  std::array<int, most_components> place_{};
  std::vector<char> turns_;  // VelocityMap::turns
  bool all_shifts_ = false;  // are kept
  int kept_ = 0, eliminated_ = 0;
  double rank_limit_ = 0.0, row_limit_ = 0.0;  // below which pivots and rows of the map in hand are none
  std::vector<Group> groups_;
  std::vector<int> column_;  // by body: first column in its group
};

}  // namespace freeplay
