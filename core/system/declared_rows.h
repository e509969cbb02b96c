// DeclaredRows: rows and coordinates that planar joints declare (JointLayout::planar_rows, planar_coordinate), made for
// all joints at once.
#pragma once

#include <span>
#include <vector>

#include "freeplay/joint.h"
#include "system/planar_kinematics.h"

namespace freeplay {
struct Evaluation;
struct Point;
}  // namespace freeplay

namespace freeplay::planar {

class DeclaredRows {
 public:
  /// Markers (into Evaluation::markers) and bodies of a joint.
  struct Ends {
    int marker_a = 0, marker_b = 0;
    BodyId body_a = ground, body_b = ground;
  };
  /// `row`: its first. `block_a`, `block_b`: where its rows in the columns of its bodies begin in Evaluation::jacobian,
  /// three numbers each; -1 on ground.
  void add_rows(Span<const PlanarRow> rows, const Ends& ends, int row, int block_a, int block_b);
  /// `terms`: evaluations in which it is wanted. `turn`: into h, the angle whose nearest turn it takes; -1 for that of
  /// zero.
  void add_coordinate(Coordinate kind, const Ends& ends, int joint, unsigned terms, int turn);

  /// Numbers that no motion changes.
  void write_constants(Evaluation& e) const;
  /// phi and Phi_q where `e` has bodies and arms; `mounts` by marker.
  void fill_rows(std::span<const Mount> mounts, Evaluation& e) const;
  void fill_nu(Evaluation& e) const;
  void fill_gamma(std::span<const Mount> mounts, Evaluation& e) const;
  /// Of Phi_q the part that motions change.
  void fill_jacobian(std::span<const Mount> mounts, Evaluation& e) const;
  void fill_coordinates(const Point& point, std::span<const Mount> mounts, unsigned terms, Evaluation& e) const;

 private:
  struct RowPair {
    int marker_a, marker_b, row, block_a, block_b;
  };
  struct Row {
    Ends ends;
    int row, block_a, block_b;
  };
  struct JointCoordinate {
    Ends ends;
    int joint, turn;
    unsigned terms;
  };
  struct Slide;
  static void fill(const RowPair& pair, Evaluation& e);
  static void fill(const Row& row, const Slide& slide, Evaluation& e);
  std::vector<RowPair> origins_;
  std::vector<Row> across_, turns_;
  std::vector<JointCoordinate> angles_, positions_;
  unsigned terms_ = 0;  // evaluations in which any of them is wanted
};

}  // namespace freeplay::planar
