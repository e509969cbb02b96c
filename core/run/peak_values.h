// PeakValues: the numbers of a result row whose largest values tables and summaries show.
#pragma once

#include <span>
#include <vector>

#include "base/index.h"
#include "model/channel.h"

namespace freeplay {

/// Magnitudes that follow from a row, in one list: speeds of bodies [m/s]; of every joint force [N], torque [N m],
/// normal force [N], penetration [m] and eccentricity [m] (zero where it has no such channel); efforts of drivers [N or
/// N m]; position and angle errors of paths [m, rad]; force [N] and torque [N m] of entries of `forces`.
class PeakValues {
 public:
  PeakValues(const Model& model, const Channels& channels);

  std::size_t size() const { return forces_ + 2 * force_columns_.size(); }
  void of(std::span<const double> row, std::span<double> out) const;

  std::size_t speed(int body) const { return at(body); }
  std::size_t force(int joint) const { return joints_ + 5 * at(joint); }
  std::size_t torque(int joint) const { return force(joint) + 4; }
  std::size_t normal_force(int joint) const { return force(joint) + 1; }
  std::size_t penetration(int joint) const { return force(joint) + 2; }
  std::size_t eccentricity(int joint) const { return force(joint) + 3; }
  std::size_t effort(int driver) const { return drivers_ + at(driver); }
  std::size_t position_error(int path) const { return paths_ + 2 * at(path); }
  std::size_t angle_error(int path) const { return position_error(path) + 1; }
  /// `index` into Model::force_elements.
  std::size_t applied_force(int index) const { return forces_ + 2 * at(index); }
  std::size_t applied_torque(int index) const { return applied_force(index) + 1; }

 private:
  /// Length of the vector from a column on, in the plane of two numbers.
  double length(std::span<const double> row, int column) const;
  /// Length of the moment of the wrench that begins at a column.
  double moment(std::span<const double> row, int wrench) const;

  const Channels& channels_;
  bool planar_;
  std::size_t joints_, drivers_, paths_, forces_;  ///< where they begin
  std::vector<int> force_columns_;                 ///< first of the wrench of each entry of `forces`
};

}  // namespace freeplay
