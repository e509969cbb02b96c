// Layout: the map from elements of a model to slices of the state.
#pragma once

#include <vector>

#include "model/model.h"

namespace freeplay {

struct Slice {
  int offset = 0, size = 0;
};

/// Which joints run: as the model says, or with every clearance closed by its ideal twin.
enum class Variant { released, closed };

/// Rows stand in the order joints, then prescribing drivers. Fixed when the System is built.
class Layout {
 public:
  Layout(const Model& model, Variant variant);

  int nq() const { return nq_; }
  int nv() const { return nv_; }
  int nc() const { return nc_; }
  /// Of one body: 3 and 3 in the plane, 7 and 6 in space.
  int body_coordinates() const { return body_coordinates_; }
  int body_velocities() const { return body_velocities_; }
  int nz() const { return nz_; }
  int nh() const { return nh_; }
  /// Rows of joints stand before this one, rows of drivers from it on.
  int first_driver_row() const { return first_driver_row_; }
  Slice rows(int joint) const { return joints_[static_cast<std::size_t>(joint)].rows; }
  Slice internal(int joint) const { return joints_[static_cast<std::size_t>(joint)].internal; }
  Slice history(int joint) const { return joints_[static_cast<std::size_t>(joint)].history; }
  /// Where h keeps the last accepted joint coordinate; -1 for a joint without an angle.
  int turn(int joint) const { return joints_[static_cast<std::size_t>(joint)].turn; }
  /// Row of a prescribing driver; -1 for one that applies an effort.
  int driver_row(int driver) const { return drivers_[static_cast<std::size_t>(driver)]; }

 private:
  struct JointSlices {
    Slice rows, internal, history;
    int turn = -1;
  };
  int body_coordinates_ = 0, body_velocities_ = 0;
  int nq_ = 0, nv_ = 0, nc_ = 0, nz_ = 0, nh_ = 0, first_driver_row_ = 0;
  std::vector<JointSlices> joints_;
  std::vector<int> drivers_;
};

}  // namespace freeplay
