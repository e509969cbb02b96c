// GivenPoses: how far bodies stand from the poses that the file gives them.
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "system/system.h"

namespace freeplay {

/// Distances are those of body frames: shifts over the size of the model, and turns [rad], whole turns left out. Only
/// what the file gives counts: a pose may be a position alone, or an angle alone.
class GivenPoses {
 public:
  /// A body farther away than this is said to be: [rad], and of the size of the model.
  static constexpr double far_turn = 10.0 * std::numbers::pi / 180.0, far_part = 0.1;

  explicit GivenPoses(const System& system);

  bool any() const { return rows_ > 0; }
  /// What each given component misses at `q`: shift x, y (z) over the size, turn [rad] (in space about x, y, z).
  Eigen::VectorXd misses(std::span<const double> q) const;
  /// Its derivative along increments of q; that of large turns in space to first order.
  Eigen::MatrixXd derivative(std::span<const double> q) const;
  /// Shift [m] and turn [rad] of one body from its given pose; 0 for what the file does not give.
  double shift(BodyId id, std::span<const double> q) const;
  double turn(BodyId id, std::span<const double> q) const;
  /// `q` with every body at what the file gives of its pose; what it does not give stays.
  void put_as_given(std::span<double> q) const;

 private:
  bool gives_turn(const Body& body) const { return body.angle.has_value() || body.rotation.has_value(); }
  std::array<double, 3> turn_vector(BodyId id, std::span<const double> q) const;

  const System& system_;
  const Model& model_;
  bool planar_;
  Eigen::Index rows_ = 0;
};

}  // namespace freeplay
