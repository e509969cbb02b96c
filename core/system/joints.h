// Joints: the joints of the equations of motion, what they are between, and what they see at a point.
#pragma once

#include <span>
#include <vector>

#include "component/joint_ref.h"
#include "system/declared_coordinates.h"
#include "system/joint_ends.h"
#include "system/layout.h"
#include "system/markers.h"

namespace freeplay {

struct Evaluation;

/// A joint as the equations have it: its type, or its ideal twin in the closed variant.
struct JointRecord : JointEnds {
  JointRef joint;
  const JointLayout* layout = nullptr;
  int index = 0;                     ///< into Model::joints
  bool stands_off = false;           ///< its second marker is JointValues::shifted
  bool declares_coordinate = false;  ///< it is never asked for it
  unsigned coordinate_terms = 0;     ///< terms that need its coordinate
  Slice internal, history;
  Slice functions;  ///< of ForceValues::functions
  int turn = -1;    ///< Layout::turn

  /// The row of its coordinate is the same always.
  bool declares_angle() const { return declares_coordinate && layout->coordinate == Coordinate::angle; }
};

/// What joints see at one point besides their markers, by joint.
struct JointValues {
  explicit JointValues(std::size_t joints);

  std::vector<double> coordinate, coordinate_rate;
  std::vector<CoordinateRow> coordinate_rows;  ///< in marker space
  std::vector<MarkerKinematics> shifted;       ///< second marker of a closed joint that stands off
};

class Joints {
 public:
  Joints(const Model& model, Variant variant, const Layout& layout, const Markers& markers);

  /// Parameters of all joints that depend on the motion.
  std::size_t functions() const { return functions_; }
  int count() const { return static_cast<int>(records_.size()); }
  const JointRecord& operator[](int index) const { return records_[static_cast<std::size_t>(index)]; }
  const JointRef& handle(int index) const { return (*this)[index].joint; }
  const JointLayout& layout(int index) const { return *(*this)[index].layout; }
  Variant variant() const { return variant_; }

  /// Closed variant: the second marker of a joint with play stands off by this, world axes.
  void set_offset(int joint, const InitialOffset& offset) { offsets_[static_cast<std::size_t>(joint)] = offset; }
  const InitialOffset& offset(int joint) const { return offsets_[static_cast<std::size_t>(joint)]; }

  /// What a joint sees at an evaluated point; valid while `e` and the point's arrays are.
  JointInput input(int index, const Point& point, const Evaluation& e) const { return input((*this)[index], point, e); }
  static JointInput input(const JointRecord& record, const Point& point, const Evaluation& e);

  /// Numbers that no motion changes.
  void write_constants(JointValues& values) const { declared_.write_constants(values); }
  /// Of a joint that stands off by a tilt: rows that its twin made for the second marker as that stands for it become
  /// those of the marker itself; `jacobian` has 12 numbers for each. With E the turn by the tilt, which goes with the
  /// first body, the twin sees w_a + E^T (w_b - tilt_rate - w_a).
  void untilt(int joint, Span<double> jacobian) const;
  /// Closed variant, once markers have moved: second markers that stand off.
  void shift(Evaluation& e) const {
    if (variant_ == Variant::closed) shift_all(e);
  }
  /// Coordinates that these terms need, once markers have moved. False with `Evaluation::fault` when a joint fails.
  bool evaluate_coordinates(const Point& point, unsigned terms, Evaluation& e) const;
  /// Row and bias of a joint's coordinate in the columns of its two bodies (2 body_velocities() numbers); the
  /// coordinate is evaluated.
  void coordinate_row(int index, const Evaluation& e, double* row, double& bias) const;
  /// Accelerations of a joint's two markers for those of the unknowns.
  void accelerations(int index, const Evaluation& e, std::span<const double> a, MarkerAccelerations& out) const;
  /// Angles of joints are differences of those of bodies, which do not jump: in the plane, where joints declare them.
  bool angles_follow_bodies() const;

 private:
  void shift_all(Evaluation& e) const;
  /// Of joints that do not declare their coordinates.
  bool ask_for_coordinates(const Point& point, unsigned terms, Evaluation& e) const;

  const Model& model_;
  Variant variant_;
  const Layout& layout_;
  const Markers& markers_;
  std::size_t functions_ = 0;
  std::vector<JointRecord> records_;  // by joint
  std::vector<InitialOffset> offsets_;
  std::vector<int> asked_;                // for their coordinates
  planar::DeclaredCoordinates declared_;  // of joints that are not
};

}  // namespace freeplay
