// InverseDynamics: what drivers must do to move the ideal mechanism as given.
#pragma once

#include <vector>

#include "analysis/posture.h"

namespace freeplay {

struct Efforts {
  std::vector<double> input;  ///< on the driven coordinates, by input [N m or N]
  /// By joint, on its second body at the joint, world axes: force [N] and moment [N m].
  std::vector<std::array<double, 6>> wrench;
};

/// Efforts of drivers in M a + Phi_q^T lambda = f with rows of joints, of drivers that stay and of the inputs. Where
/// drivers are redundant their efforts have least norm among themselves, then the joints' reactions. `preload` times
/// the unit null vector of the drivers' efforts (its largest component positive) is added: inner tension that moves
/// nothing (Mueller 2005). Loads are gravity, applied forces and forces of springs and dampers; joints with clearance
/// act as their ideal twins.
class InverseDynamics {
 public:
  explicit InverseDynamics(PostureSolver& solver) : solver_(solver) {}

  enum class Found { yes, unbalanced, no_preload, many_preloads };
  /// For the mechanism at `posture` with speeds `v` and accelerations `a`. `unbalanced`: at a singular posture the
  /// inputs cannot hold the load. `no_preload`, `many_preloads`: the null space has dimension 0, or more than 1.
  Found solve(double t, const Posture& posture, const std::vector<double>& v, const std::vector<double>& a,
              double preload, Efforts& out);

 private:
  PostureSolver& solver_;
};

}  // namespace freeplay
