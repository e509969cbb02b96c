// System: the equations of motion of a model.
//
//   M a + Phi_q^T lambda = f(t, q, v, z),   Phi(q, t) = 0,   Phi_q v = nu,   Phi_q a = gamma
//
// Phi_q is nc x nv: the derivative along tangent increments of q. The force of the constraints on the bodies is
// -Phi_q^T lambda. Driven bodies may be left out of the unknowns: their motion is a function of time, nu and gamma hold
// what their motion does to the rows, and the loads of the rows that hold them follow from everything else.
#pragma once

#include <memory>
#include <optional>

#include "system/body_coordinates.h"
#include "system/evaluation.h"
#include "system/layout.h"
#include "system/motion.h"
#include "system/state.h"

namespace freeplay {

/// What the equations of motion are solved for.
enum class Unknowns { all_bodies, free_bodies };

/// The parts of the equations, and the order in which they are evaluated. Its model must outlive it. Constant once the
/// start is known: any number of threads may evaluate it, each into an Evaluation of its own.
class System {
 public:
  explicit System(const Model& model, Variant variant = Variant::released, Unknowns unknowns = Unknowns::all_bodies);
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  const Model& model() const { return model_; }
  Variant variant() const { return variant_; }
  /// Largest distance that matters: unit of position tolerances [m].
  double size() const { return size_; }

  /// What stands where: q, v, lambda, z, h.
  const Layout& layout() const { return layout_; }
  /// Poses and twists of bodies in q and v.
  const BodyCoordinates& coordinates() const { return coordinates_; }
  const Inertia& inertia() const { return inertia_; }
  const Markers& markers() const { return markers_; }
  const Joints& joints() const { return joints_; }
  const Constraints& constraints() const { return constraints_; }
  /// Phi_q, by the entries in ConstraintValues::jacobian.
  const ConstraintJacobian& jacobian() const { return constraints_.jacobian(); }
  const DrivenMotion& driven() const { return driven_; }
  const Forces& forces() const { return forces_; }
  Motions& motions() { return *motions_; }
  const Motions& motions() const { return *motions_; }

  // What the start of a run decides.
  /// Drivers move as those of another system of the same model do.
  void share_motions(const System& other) { motions_ = other.motions_; }
  /// Start values of drivers of speeds and offsets of gears are those of another system of the same model.
  void take_start_of(const System& other);
  /// Driven bodies go on from where they stand in `start`, a state of `whole`, which has all bodies of the same model
  /// for its unknowns; motions and offsets of gears are its own. `own` gets the unknowns.
  void begin_at(const System& whole, const State& start, State& own);
  /// Offset of a gear that keeps the one it finds at the start [rad or m].
  void set_gear_offset(int gear, double offset) { constraints_.set_gear_offset(gear, offset); }
  /// Closed variant: the second marker of a joint with play stands off by this, world axes.
  void set_offset(int joint, const InitialOffset& offset) { joints_.set_offset(joint, offset); }

  /// Fills the wanted terms; false with `Evaluation::fault` when an element fails. Does not allocate.
  bool evaluate(const Point& point, unsigned terms, Evaluation& e) const;
  /// The same where `known` may hold the terms at this very point already, but for coordinates of joints: the two
  /// then change places.
  bool evaluate(const Point& point, unsigned terms, KeptEvaluation& known, KeptEvaluation& out) const;
  /// Of an evaluation that has phi the wanted ones of nu (term_velocity) and gamma (term_acceleration).
  void complete_rates(unsigned terms, Evaluation& e) const;

 private:
  /// `kept`: what `e` still holds; where it is any, bodies have not moved, and no more markers count than before.
  bool fill(const Point& point, unsigned terms, unsigned kept, Evaluation& e) const;

  const Model& model_;
  Variant variant_;
  double size_;
  std::shared_ptr<Motions> motions_;
  BodyCoordinates coordinates_;
  std::vector<planar::DrivenBody> driven_bodies_;
  // Each stands on those before it.
  Layout layout_;
  Inertia inertia_;
  Markers markers_;
  Joints joints_;
  Constraints constraints_;
  DrivenMotion driven_;
  Forces forces_;
};

}  // namespace freeplay
