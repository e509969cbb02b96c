// Forces: generalised forces on the bodies and their derivatives: those of joints, what drivers and the model apply,
// and gravity.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "system/applied_forces.h"
#include "system/force_map.h"
#include "system/inertia.h"
#include "system/joints.h"

namespace freeplay {

class Forces;

/// Derivatives of the generalised forces of one joint: 6 x 6 numbers each in the plane, 12 x 12 in space, rows and
/// columns [body a, body b].
struct ForceBlock {
  int joint = 0;
  BodyId a = ground, b = ground;
  int internal = 0;         ///< internal variables of the joint, nz
  int internal_offset = 0;  ///< of its part of ForceValues::internal_derivatives
};

/// Two bodies by whose increments and velocities forces on either change: unknowns, or `ground`.
struct BodyPair {
  BodyId a = ground, b = ground;
};

/// Of a joint's part of ForceValues::internal_derivatives.
InternalDerivatives internal_derivatives(const ForceBlock& block, int body_velocities, std::span<double> all);

/// Forces at one point.
struct ForceValues {
  ForceValues(const Forces& forces, const Model& model);

  std::vector<double> force;                 ///< generalised, on all bodies
  std::vector<double> force_q, force_v;      ///< of pairs of bodies
  std::vector<double> gyroscopic_v;          ///< in space, 3 x 3 by body: its gyroscopic moment by its w
  std::vector<double> internal_derivatives;  ///< of force blocks with internal variables
  std::vector<double> potential;             ///< stored energy by joint [J]
  std::vector<double> potential_rate;        ///< its time derivative [W]; NaN where the joint gives none
  std::vector<double> wrench;                ///< by joint: 6 numbers on a, 6 on b, at the markers
  std::vector<double> internal_rate;         ///< z'
  std::vector<double> applied;               ///< by applied force: wrench in world axes at its marker
  std::vector<double> functions;             ///< parameters of joints that depend on the motion
  std::vector<double> function_slopes;       ///< by these: derivatives of a wrench, 12 numbers
  std::vector<unsigned char> acts;           ///< by force block: whether its wrenches are not all zero
  std::uint64_t acting = 0;                  ///< the same of all blocks together
  // Work space.
  std::vector<double> rate_space, derivative_space, channel_space;
};

class Forces {
 public:
  /// `size` of the model [m] sizes the steps of joints that are differenced.
  Forces(const Model& model, const Layout& layout, const Markers& markers, const Joints& joints, const Inertia& inertia,
         double size);

  /// Joints with forces.
  std::span<const ForceBlock> blocks() const { return blocks_; }

  /// Pairs of bodies of ForceValues::force_q and force_v: of the blocks, then of applied forces.
  std::span<const BodyPair> pairs() const { return pairs_; }
  const AppliedForces& applied() const { return applied_; }

  /// All forces where markers, coordinates and motions are. False with Evaluation::fault when a joint or an expression
  /// fails.
  bool evaluate(const Point& point, bool derivatives, Evaluation& e) const;

 private:
  friend struct ForceValues;
  template <class Bodies>
  bool evaluate_in(const Point& point, bool derivatives, Evaluation& e) const;
  /// A joint's answer to a request that is zero, besides `out` in the work space.
  [[gnu::always_inline]] bool ask(const JointRecord& joint, const Point& point, bool derivatives, JointForces& out,
                                  Evaluation& e) const;
  /// What the joint of force block f returned.
  template <class Bodies>
  [[gnu::noinline]] bool take(std::size_t f, const JointForces& out, bool derivatives, Evaluation& e) const;

  const Model& model_;
  const Layout& layout_;
  const Joints& joints_;
  const Inertia& inertia_;
  double size_;
  std::vector<ForceBlock> blocks_;
  std::vector<BodyPair> pairs_;
  AppliedForces applied_;
};

}  // namespace freeplay
