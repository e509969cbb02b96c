// DeclaredRows: rows that planar joints declare (JointLayout::planar_rows), made for all joints at once.
#pragma once

#include <span>
#include <vector>

#include "freeplay/joint.h"
#include "system/joint_ends.h"
#include "system/markers.h"

namespace freeplay {
struct ConstraintValues;
}  // namespace freeplay

namespace freeplay::planar {

struct SlideLine;

class DeclaredRows {
 public:
  /// `row`: its first. `offset_a`, `offset_b`: where its rows in the columns of its bodies begin in
  /// ConstraintValues::jacobian, three numbers each; -1 on ground.
  void add(Span<const PlanarRow> rows, const JointEnds& ends, int row, int offset_a, int offset_b);

  /// Numbers that no motion changes.
  void write_constants(ConstraintValues& rows) const;
  /// phi and Phi_q where bodies and arms are; `mounts` by marker.
  void fill(std::span<const Mount> mounts, const MarkerValues& bodies, ConstraintValues& rows) const;
  void fill_nu(ConstraintValues& rows) const;
  void fill_gamma(std::span<const Mount> mounts, const MarkerValues& bodies, ConstraintValues& rows) const;
  /// Of Phi_q the part that motions change.
  void fill_jacobian(std::span<const Mount> mounts, const MarkerValues& bodies, ConstraintValues& rows) const;

 private:
  struct RowPair {
    int marker_a, marker_b, row, offset_a, offset_b;
  };
  struct Row {
    JointEnds ends;
    int row, offset_a, offset_b;
  };
  static void fill(const RowPair& pair, const MarkerValues& bodies, ConstraintValues& rows);
  static void fill(const Row& row, const SlideLine& slide, ConstraintValues& rows);
  std::vector<RowPair> origins_;
  std::vector<Row> across_, turns_;
};

}  // namespace freeplay::planar
