// Layout: the map from elements of a model to slices of the state.
#pragma once

#include <span>
#include <vector>

#include "model/model.h"
#include "system/driven_bodies.h"

namespace freeplay {

struct Slice {
  int offset = 0, size = 0;
};

/// Which joints run: as the model says, or with every clearance closed by its ideal twin.
enum class Variant { released, closed };

/// Rows stand in the order joints, then prescribing drivers. Driven bodies stand after all others and are no part of
/// the unknowns, and the rows that hold them after all other rows. Fixed when the System is built.
class Layout {
 public:
  Layout(const Model& model, Variant variant, std::span<const planar::DrivenBody> driven = {});

  /// Of the unknowns.
  int nq() const { return nq_; }
  int nv() const { return nv_; }
  int nc() const { return nc_; }
  /// Rows that hold driven bodies included.
  int all_rows() const { return all_rows_; }
  /// Bodies that are unknowns; further places are those of driven bodies.
  int free_bodies() const { return free_bodies_; }
  /// Where the coordinates and velocities of a body stand, counted in bodies; that of ground is `ground`.
  int place(BodyId body) const { return body == ground ? ground : places_[static_cast<std::size_t>(body)]; }
  /// That place if it is one of the unknowns, else `ground`.
  BodyId unknown(BodyId place) const { return place < free_bodies_ ? place : ground; }
  BodyId body_at(int place) const { return bodies_[static_cast<std::size_t>(place)]; }
  /// Of one body: 3 and 3 in the plane, 7 and 6 in space.
  int body_coordinates() const { return body_coordinates_; }
  int body_velocities() const { return body_velocities_; }
  int nz() const { return nz_; }
  int nh() const { return nh_; }
  /// Of the rows before nc(), those of joints stand before this one and those of drivers from it on.
  int first_driver_row() const { return first_driver_row_; }
  Slice rows(int joint) const { return joints_[static_cast<std::size_t>(joint)].rows; }
  Slice internal(int joint) const { return joints_[static_cast<std::size_t>(joint)].internal; }
  Slice history(int joint) const { return joints_[static_cast<std::size_t>(joint)].history; }
  /// Where h keeps the last accepted joint coordinate; -1 for a joint without an angle.
  int turn(int joint) const { return joints_[static_cast<std::size_t>(joint)].turn; }
  /// Where h keeps on which side the switches of formulas of the motion are (StateFormula::Input::sides).
  Slice switches() const { return switches_; }
  /// Efforts of drivers that are inputs stand at the end of h, two numbers each in declaration order: whether it was
  /// set, and what it is [N, N m].
  static constexpr std::size_t numbers_of_input = 2;
  /// Row of a prescribing driver; -1 for one that applies an effort.
  int driver_row(int driver) const { return drivers_[static_cast<std::size_t>(driver)]; }

 private:
  struct JointSlices {
    Slice rows, internal, history;
    int turn = -1;
  };
  int body_coordinates_ = 0, body_velocities_ = 0;
  int nq_ = 0, nv_ = 0, nc_ = 0, nz_ = 0, nh_ = 0, first_driver_row_ = 0, all_rows_ = 0, free_bodies_ = 0;
  std::vector<int> places_;     // by body
  std::vector<BodyId> bodies_;  // by place
  std::vector<JointSlices> joints_;
  std::vector<int> drivers_;
  Slice switches_;  // after all other history
};

}  // namespace freeplay
