// ClosedMechanism: a model with every clearance closed by its ideal twin, and the rows that hold its positions and
// velocities at one time.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "assembly/gear_turns.h"
#include "linear/sparse_matrix.h"
#include "system/path_row.h"
#include "system/system.h"

namespace freeplay {

/// Throws what an element that could not be evaluated says, as Error{input} or Error{plugin}.
[[noreturn]] void throw_fault(const Model& model, const Fault& fault);

class ClosedMechanism {
 public:
  /// A joint whose coordinate [rad or m] or speed is held at a value.
  struct Lead {
    int joint = 0;
    double value = 0.0;
  };

  /// Rows of the closed system, then those of leading joints and of paths, with what they miss.
  struct Rows {
    SparseMatrix matrix;
    Eigen::VectorXd residual;
    std::vector<int> row;   ///< of the closed system, -1 for a leading joint or a path
    std::vector<int> lead;  ///< joint that leads, -1
    std::vector<int> path;  ///< index into `paths`, -1

    double largest() const { return residual.size() == 0 ? 0.0 : residual.lpNorm<Eigen::Infinity>(); }
  };

  /// Drivers move as those of `owner` do. Every row holds; nothing leads.
  explicit ClosedMechanism(const System& owner);

  System system;
  State state;
  Evaluation e;                ///< of the last evaluate()
  std::vector<Lead> leads;     ///< joints whose coordinates are held
  std::vector<char> held_row;  ///< rows of the closed system that hold positions
  std::vector<PathRow> paths;  ///< that hold positions in place of their drivers

  /// Counts angles of gears from the joints that are `counted` already (assembly/gear_turns.h).
  void count_gears(std::vector<bool> counted, bool from_slides);
  /// After that: with as many turns of trains as come nearest to the angles given by joint; NaN where there is none.
  void turn_gears(std::span<const double> given) { gear_turns_->turn_leads(given, state.h()); }
  /// Puts it where `start`, a state of another system of the same model, is; drivers and gears start as there.
  void stand_at(const System& other, const State& start);

  /// Throws throw_fault() when an element fails.
  void evaluate(unsigned terms);

  /// Whole turns of angles are counted from the last evaluate() on.
  void keep_turns();

  /// Positions at the state: Phi of the rows that hold, and what leads and paths miss.
  Rows position_rows();
  /// Velocities at the state: Phi_q v - nu of all rows, then the speeds of `leading` joints.
  Rows speed_rows(const std::vector<Lead>& leading);

  /// Newton with corrections of least norm in m and rad, shortened where the residual would grow, up to the tolerance
  /// of the model's assembly and beyond it while that pays. Returns the rows at the end.
  Rows converge();
  bool holds(const Rows& rows) const { return rows.largest() <= model().settings.assembly_tolerance; }

  const Model& model() const { return system.model(); }
  PathPose path_pose(const PathRow& path) const;

 private:
  Rows assemble(Rows rows, const std::vector<Lead>& leading, bool speeds);
  void add_path(Rows& rows, Eigen::Index i, std::vector<SparseEntry>& entries);
  void add_lead(Rows& rows, Eigen::Index i, double value, bool speeds, std::vector<SparseEntry>& entries);

  std::optional<GearTurns> gear_turns_;
};

}  // namespace freeplay
