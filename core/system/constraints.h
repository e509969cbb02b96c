// Constraints: the rows of joints, gears and drivers.
//
//   Phi(q, t) = 0,   Phi_q v = nu,   Phi_q a = gamma
//
// Rows stand in the order of Layout. Those that hold driven bodies are satisfied by the places of these, and only have
// entries of Phi_q, which the loads in them need.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "system/declared_rows.h"
#include "system/jacobian.h"
#include "system/joints.h"
#include "system/motion.h"

namespace freeplay {

class Constraints;

/// Rows at one point.
struct ConstraintValues {
  explicit ConstraintValues(const Constraints& constraints);

  std::vector<double> phi, nu, gamma;
  std::vector<double> jacobian;   ///< entries of Phi_q, see ConstraintJacobian
  std::vector<double> row_space;  ///< work space: of every joint that makes its rows, see Constraints::JointRows
};

/// Row of a driver, and where it has entries of Phi_q: -1 on ground.
struct DriverRow {
  int driver, row, joint, offset_a, offset_b;
  bool constant;      ///< the row is the same always, as of an angle that is declared
  bool modulo_turns;  ///< Motions::modulo_turns
};

class Constraints {
 public:
  Constraints(const Model& model, const Layout& layout, const Markers& markers, const Joints& joints,
              const Motions& motions);

  const ConstraintJacobian& jacobian() const { return jacobian_; }
  /// Offset of a gear that keeps the one it finds at the start [rad or m].
  void set_gear_offset(int gear, double offset) { gear_offsets_[static_cast<std::size_t>(gear)] = offset; }
  void take_gear_offsets(const Constraints& other) { gear_offsets_ = other.gear_offsets_; }

  /// Whether rows of joints may have a nu of their own, besides what driven bodies move in them.
  bool rows_move() const { return !made_.empty(); }
  /// Whether joints declare all rows, and nu depends on nothing but time and coordinates.
  bool all_declared() const { return made_.empty() && gears_.empty() && driver_rows_.empty(); }

  /// phi and Phi_q where markers and coordinates are, with the wanted ones of nu (term_velocity) and gamma
  /// (term_acceleration). `still`: coordinates are those of `e` as it is. False with Evaluation::fault when a joint
  /// fails.
  bool evaluate(const Point& point, unsigned terms, bool still, Evaluation& e) const;
  /// The wanted ones of nu and gamma alone, after evaluate().
  void fill_rates(unsigned terms, Evaluation& e) const;

  /// Wrench (6 numbers) on the second body of a joint at its marker: constraint and applied parts together. Of a gear:
  /// what it exerts on the second body of its second joint at that joint.
  void reaction(int index, const Evaluation& e, std::span<const double> lambda, double* wrench) const;

  /// Where the rows of a joint, and of the drivers of driven bodies, have their entries.
  int offset(int joint, bool second) const {
    const JointRows& own = rows_[static_cast<std::size_t>(joint)];
    return second ? own.offset_b : own.offset_a;
  }
  std::span<const DriverRow> driven_driver_rows() const { return driven_driver_rows_; }
  /// Phi_q of the rows that hold driven bodies: before it, reaction() says nothing of joints that do.
  void fill_driven(Evaluation& e) const;

 private:
  friend struct ConstraintValues;
  /// Rows of a joint: offsets of their entries in the columns of its bodies, and its part of the work space: the row in
  /// marker space (12 numbers each), phi, nu and gamma, with guard marks after each.
  struct JointRows {
    Slice rows;
    int offset_a = -1, offset_b = -1, space = 0;
  };
  struct GearRow {
    int row, joints[2];
    double ratio;
    int offsets[4];  // of the bodies of its first and of its second joint
  };
  void add_joint(const JointRecord& joint);
  void add_gear(const Gear& gear);
  void add_driver(int driver, bool modulo_turns);
  /// Rows that are made one by one.
  [[gnu::noinline]] bool evaluate_others(const Point& point, Evaluation& e) const;
  template <class Bodies>
  bool make_rows(const Point& point, Evaluation& e) const;
  void evaluate_gear(const GearRow& gear, double offset, Evaluation& e) const;
  void evaluate_driver(const DriverRow& driver, Evaluation& e) const;
  /// Its part of Phi_q. Returns its bias.
  double fill_driver_row(const DriverRow& driver, Evaluation& e) const;

  const Model& model_;
  const Layout& layout_;
  const Markers& markers_;
  const Joints& joints_;
  ConstraintJacobian jacobian_;
  std::vector<JointRows> rows_;    // by joint
  std::vector<int> made_;          // joints that make their rows themselves
  std::vector<double> blank_;      // what the work space holds before joints fill it
  planar::DeclaredRows declared_;  // of joints that do not
  planar::DeclaredRows driven_;    // those that hold driven bodies
  std::vector<GearRow> gears_;
  std::vector<double> gear_offsets_;
  std::vector<DriverRow> driver_rows_, driven_driver_rows_;
};

}  // namespace freeplay
