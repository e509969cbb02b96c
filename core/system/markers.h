// Markers: where the markers of a model stand and how they move, for poses and twists of the bodies that they ride on.
#pragma once

#include <span>
#include <vector>

#include "system/by_space.h"
#include "system/layout.h"
#include "system/point.h"

namespace freeplay {

class BodyCoordinates;
class Markers;

/// A marker at rest in the axes of the world.
inline MarkerKinematics still_marker() {
  MarkerKinematics still{};
  still.rotation[0] = still.rotation[4] = still.rotation[8] = 1.0;
  return still;
}

/// Bodies and their markers at one point.
struct MarkerValues {
  explicit MarkerValues(const Markers& all);

  std::vector<double> q, v;  ///< of all bodies, those of the unknowns first
  std::vector<MarkerKinematics> markers;
  std::vector<planar::Arm> arms;           ///< by marker, in the plane
  std::vector<spatial::Arm> spatial_arms;  ///< by marker, in space
  std::vector<planar::Turn> turns;         ///< by body, in the plane
  std::vector<spatial::Turn> spatial_turns;

  /// Those of the space that `Bodies` are in.
  template <class Bodies>
  const auto& arms_of() const {
    if constexpr (Bodies::velocities == planar::velocities) {
      return arms;
    } else {
      return spatial_arms;
    }
  }
};

class Markers {
 public:
  Markers(const Model& model, const Layout& layout, const BodyCoordinates& coordinates);

  /// Where the body of a marker stands (Layout::place); and among the unknowns, `ground` for driven bodies, too.
  BodyId place(int marker) const { return places_[static_cast<std::size_t>(marker)]; }
  BodyId unknown(int marker) const { return layout_.unknown(place(marker)); }
  /// How they are mounted on their bodies; planar models.
  std::span<const planar::Mount> mounts() const { return mounts_; }
  /// Angle of a marker [rad], for the coordinates of all bodies as in MarkerValues::q; planar models.
  double angle(int marker, std::span<const double> q) const;

  /// Moves the bodies that are unknowns, and their markers, to a point. `still`: the coordinates are those of `values`,
  /// and only velocities change.
  void move(const Point& point, bool still, MarkerValues& values) const;
  /// Moves the markers of one planar body to where `values` has it, `turn` being of its angle.
  void move_with(BodyId place, const planar::Turn& turn, MarkerValues& values) const;

  /// A row g of a marker's twist (6 numbers) in the columns of its body: body_velocities() numbers; and g J' v.
  void row(int marker, const double* g, const MarkerValues& values, double* row) const;
  double row_product(int marker, const double* g, const MarkerValues& values) const;
  /// A row in the columns of the body as a row of the marker's twist.
  void twist_row(int marker, const double* row, const MarkerValues& values, double* twist) const;
  /// Adds the generalised force of a wrench (6 numbers) at a marker that is on a body.
  void apply(int marker, const double* wrench, const MarkerValues& values, std::span<double> force) const;

 private:
  void move_in_plane(const Point& point, bool still, MarkerValues& values) const;
  void move_in_space(const Point& point, MarkerValues& values) const;
  friend struct MarkerValues;

  struct Range {
    int first = 0, end = 0;
  };
  const Model& model_;
  const Layout& layout_;
  std::vector<BodyId> places_;
  std::vector<planar::Mount> mounts_;
  std::vector<spatial::Mount> spatial_mounts_;
  std::vector<int> moving_;     // not on ground: body after body
  std::vector<Range> of_body_;  // in moving_, by place
};

}  // namespace freeplay
