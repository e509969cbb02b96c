// System: the equations of motion of a model.
//
//   M a + Phi_q^T lambda = f(t, q, v, z),   Phi(q, t) = 0,   Phi_q v = nu,   Phi_q a = gamma
//
// Phi_q is nc x nv: the derivative along tangent increments of q. The force of the constraints on the bodies is
// -Phi_q^T lambda. Driven bodies may be left out of the unknowns: their motion is a function of time, nu and gamma hold
// what their motion does to the rows, and the loads of the rows that hold them follow from everything else.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "component/joint_ref.h"
#include "linear/sparse_matrix.h"
#include "system/body_coordinates.h"
#include "system/declared_rows.h"
#include "system/evaluation_context.h"
#include "system/layout.h"
#include "system/motion.h"
#include "system/planar_kinematics.h"
#include "system/spatial_kinematics.h"
#include "system/state.h"

namespace freeplay {

/// Where the equations are evaluated: values of the unknowns. Views only.
struct Point {
  double t = 0.0;
  std::span<const double> q, v, z, h;
};
inline Point point(const State& state) { return {state.t(), state.q(), state.v(), state.z(), state.h()}; }

/// Which terms of the equations are wanted.
enum Term : unsigned {
  term_position = 1,      ///< phi and Phi_q
  term_velocity = 2,      ///< nu (with phi)
  term_acceleration = 4,  ///< gamma (with phi)
  term_force = 8,         ///< f
  term_derivative = 16,   ///< derivatives of f (with f)
  term_coordinate = 32,   ///< coordinates of all joints
  term_event = 64,        ///< what JointRef::events() and on_event() read
  term_turn = 256,        ///< coordinates of joints whose turns are counted
};

/// Element that failed, and why.
struct Fault {
  enum class Kind { none, plugin, motion } kind = Kind::none;
  int joint = -1;      ///< index into Model::joints
  MotionFault motion;  ///< kind motion
  Message message{};   ///< kind plugin

  /// A joint failed because an expression of the model file, which it evaluates, has no value.
  bool of_expression() const {
    const std::string_view id = message.id;
    return kind == Kind::plugin && (id == "bad-expression" || id == "bad-number");
  }
};

/// Rows of one element in the columns of one body: `rows` x body_velocities() numbers from `offset` of
/// Evaluation::jacobian.
struct JacobianBlock {
  int row = 0, rows = 0, body = 0, offset = 0;
};

/// Derivatives of the generalised forces of one joint: 6 x 6 numbers each in the plane, 12 x 12 in space, rows and
/// columns [body a, body b].
struct ForceBlock {
  int joint = 0;
  BodyId a = ground, b = ground;
  int internal = 0;         ///< internal variables of the joint, nz
  int internal_offset = 0;  ///< of its part of Evaluation::internal_derivatives
};

/// Row-major pieces of a joint's part of Evaluation::internal_derivatives, in the order they stand there.
struct InternalDerivatives {
  std::span<double> force_z;  ///< 2 w x nz, w velocities of a body: generalised forces by z
  std::span<double> rate_q;   ///< nz x 2 w: z' by increments of the bodies
  std::span<double> rate_v;   ///< nz x 2 w: z' by their velocities
  std::span<double> rate_z;   ///< nz x nz

  InternalDerivatives(const ForceBlock& block, int body_velocities, std::span<double> all);
};

/// What the time loop reads of a joint, in one place.
struct JointRecord {
  JointRef joint;
  const JointLayout* layout = nullptr;
  int index = 0;                   ///< into Model::joints
  int marker_a = 0, marker_b = 0;  ///< into Evaluation::markers
  BodyId body_a = ground, body_b = ground;
  bool stands_off = false;           ///< its second marker is Evaluation::shifted
  bool declares_coordinate = false;  ///< it is never asked for it
  unsigned coordinate_terms = 0;     ///< terms that need its coordinate
  int block_a = -1, block_b = -1;    ///< of its rows, into System::jacobian_blocks(); -1 on ground
  int row_space = 0;                 ///< its part of Evaluation::row_space
  Slice rows, internal, history;
  int turn = -1;  ///< Layout::turn
};

struct Evaluation;
class KeptEvaluation;

/// What the equations of motion are solved for.
enum class Unknowns { all_bodies, free_bodies };

class System {
 public:
  explicit System(const Model& model, Variant variant = Variant::released, Unknowns unknowns = Unknowns::all_bodies);

  const Model& model() const { return model_; }
  const Layout& layout() const { return layout_; }
  Variant variant() const { return variant_; }
  Motions& motions() { return *motions_; }
  const Motions& motions() const { return *motions_; }
  /// Drivers move as those of another system of the same model do.
  void share_motions(const System& other) { motions_ = other.motions_; }
  /// Start values of drivers of speeds and offsets of gears are those of another system of the same model.
  void take_start_of(const System& other);
  /// Driven bodies go on from where they stand in `start`, a state of `whole`, which has all bodies of the same model
  /// for its unknowns; motions and offsets of gears are its own. `own` gets the unknowns.
  void begin_at(const System& whole, const State& start, State& own);
  /// Offset of a gear that keeps the one it finds at the start [rad or m].
  void set_gear_offset(int gear, double offset) { gear_offsets_[static_cast<std::size_t>(gear)] = offset; }
  int body_coordinates() const { return layout_.body_coordinates(); }
  int body_velocities() const { return layout_.body_velocities(); }
  /// Poses and twists of bodies in q and v.
  const BodyCoordinates& coordinates() const { return coordinates_; }
  /// Diagonal of M: mass, mass, inertia of every free body; in space mass three times and the principal inertias.
  std::span<const double> mass() const { return std::span(mass_).first(static_cast<std::size_t>(layout_.nv())); }
  /// Where the body of a marker stands among the unknowns (Layout::place); `ground` for driven bodies, too.
  BodyId unknown_of(int marker) const { return unknown(marker_places_[static_cast<std::size_t>(marker)]); }
  /// Angle of a marker [rad], for the coordinates of all bodies as in Evaluation::q.
  double marker_angle(int marker, std::span<const double> q) const;
  /// Angles of joints are differences of those of bodies, which do not jump: in the plane, where joints declare them.
  bool angles_follow_bodies() const;
  /// Largest distance that matters: unit of position tolerances [m].
  double size() const { return size_; }

  /// Closed variant: the second marker of a joint with play stands off by this, world axes.
  void set_offset(int joint, const InitialOffset& offset) { offsets_[static_cast<std::size_t>(joint)] = offset; }
  const JointRef& joint(int index) const { return records_[static_cast<std::size_t>(index)].joint; }
  const JointLayout& joint_layout(int index) const { return *records_[static_cast<std::size_t>(index)].layout; }

  /// Fills the wanted terms; false with `Evaluation::fault` when an element fails. Does not allocate.
  bool evaluate(const Point& point, unsigned terms, Evaluation& out) const;
  /// The same where `known` may hold the terms at this very point already, but for coordinates of joints: the two
  /// then change places.
  bool evaluate(const Point& point, unsigned terms, KeptEvaluation& known, KeptEvaluation& out) const;

  /// Of an evaluation at a point the coordinates of all joints.
  bool complete(const Point& point, Evaluation& e) const;
  /// Whether rows of joints may have a nu of their own, besides what driven bodies move in them.
  bool rows_move() const { return !with_rows_.empty(); }
  /// Of an evaluation that has phi the wanted ones of nu (term_velocity) and gamma (term_acceleration).
  void complete_rates(unsigned terms, Evaluation& e) const;

  /// out += Phi_q^T lambda and out = Phi_q v.
  void add_transposed(const Evaluation& e, std::span<const double> lambda, std::span<double> out) const;
  void multiply(const Evaluation& e, std::span<const double> v, std::span<double> out) const;
  /// Phi_q by its entries; `out` only grows the first time.
  void jacobian_entries(const Evaluation& e, std::vector<SparseEntry>& out) const;

  std::span<const JacobianBlock> jacobian_blocks() const { return unknown_blocks_; }
  /// What a row has in the columns of one body: from `offset` of Evaluation::jacobian, for v from `velocity` on.
  struct RowPiece {
    int offset, velocity;
  };
  std::span<const RowPiece> row_pieces(std::size_t row) const {
    return std::span(row_pieces_).subspan(row_starts_[row], row_starts_[row + 1] - row_starts_[row]);
  }
  std::span<const ForceBlock> force_blocks() const { return force_blocks_; }

  /// What joint `index` sees at an evaluated point; valid while `e` and the point's arrays are.
  JointInput input(int index, const Point& point, const Evaluation& e) const;
  /// Row and bias of a joint's coordinate in the columns of its two bodies (2 body_velocities() numbers); the
  /// coordinate is evaluated.
  void coordinate_row(int index, const Evaluation& e, double* row, double& bias) const;
  /// A row g of a marker's twist (6 numbers) in the columns of its body: body_velocities() numbers; and g J' v.
  void marker_row(int marker, const double* g, const Evaluation& e, double* row) const;
  double marker_row_product(int marker, const double* g, const Evaluation& e) const;
  /// Adds the generalised force of a wrench (6 numbers) at a marker that is on a body.
  void add_wrench(int marker, const double* wrench, const Evaluation& e, std::span<double> force) const;
  /// Wrench (6 numbers) on the second body at its marker: constraint and applied parts together. Of a gear: what it
  /// exerts on the second body of its second joint at that joint.
  void reaction(int index, const Evaluation& e, std::span<const double> lambda, double* wrench) const;
  /// Adds the loads of driven bodies after the multipliers of the unknowns: `lambda` has Layout::all_rows() numbers.
  /// `e` holds all forces.
  void recover_loads(Evaluation& e, std::span<double> lambda) const;
  /// Their part of Phi_q: before it, reaction() says nothing of joints that hold driven bodies.
  void fill_driven_jacobian(Evaluation& e) const;
  /// The same for impulses: rows of free bodies have given `impulse`, and driven bodies changed their velocities (3
  /// numbers each) by `change`.
  void recover_impulses(Evaluation& e, std::span<const double> change, std::span<double> impulse) const;
  /// Power of the rows of joints between free and driven bodies on the driven ones, with the opposite sign [W].
  double power_from_driven(const Evaluation& e, std::span<const double> lambda) const;
  /// The row that holds a driven body last: that of its driver, if it has one.
  int row_of_driven(std::size_t driven) const { return driven_[driven].rows[2]; }
  /// Accelerations of a joint's two markers.
  void marker_accelerations(int index, const Evaluation& e, std::span<const double> a, MarkerAccelerations& out) const;

  /// For the coordinates and velocities of all bodies, as in Evaluation::q and Evaluation::v.
  double kinetic_energy(std::span<const double> v) const;
  double gravity_potential(std::span<const double> q) const;

 private:
  int bodies() const { return static_cast<int>(model_.bodies.size()); }
  BodyId unknown(BodyId place) const { return place < layout_.free_bodies() ? place : ground; }
  void add_driven(const planar::DrivenBody& body);
  void place_driven(const Point& point, Evaluation& e) const;
  /// `moved`: rates that end with those of driven bodies.
  void move_rows_with_driven(std::span<const double> moved, std::span<double> right, const Evaluation& e) const;
  void fill_rates(unsigned terms, Evaluation& e) const;
  void solve_for_loads(Evaluation& e, std::span<double> force, std::span<double> lambda) const;
  void sort_markers();
  void sort_rows();
  /// `kept`: what `e` still holds; where it is any, bodies have not moved, and no more markers count than before.
  bool fill(const Point& point, unsigned terms, unsigned kept, Evaluation& e) const;
  template <class Bodies>
  bool fill_in(const Point& point, unsigned terms, unsigned kept, Evaluation& e) const;
  template <class Bodies>
  void place_markers(const Point& point, bool still, Evaluation& e) const;
  bool evaluate_coordinates(const Point& point, unsigned terms, Evaluation& e) const;
  static constexpr const char* beside = "it wrote beside the numbers that it was given to fill";
  [[gnu::cold]] static bool refuse(int joint, const char* why, Evaluation& e);
  [[gnu::cold]] static bool blame(int joint, Evaluation& e);
  static bool markers_are_finite(const JointRecord& record, const Evaluation& e);
  template <class Bodies>
  bool evaluate_rows(const Point& point, Evaluation& e) const;
  template <class Bodies>
  void write_coordinate_row(int index, const Evaluation& e, double* row, double& bias) const;
  template <class Bodies>
  void evaluate_gear_rows(Evaluation& e) const;
  struct DriverRow;
  template <class Bodies>
  double fill_driver_row(const DriverRow& row, Evaluation& e) const;
  template <class Bodies>
  void evaluate_driver_rows(Evaluation& e) const;
  template <class Bodies>
  bool evaluate_forces(const Point& point, bool derivatives, Evaluation& e) const;
  template <class Bodies>
  [[gnu::noinline]] bool take_forces(std::size_t block, const JointForces& out, bool derivatives, Evaluation& e) const;
  template <class Bodies>
  bool evaluate_applied(const Point& point, Evaluation& e) const;
  void add_gyroscopic(const Point& point, bool derivatives, Evaluation& e) const;
  JointInput input(const JointRecord& record, const Point& point, const Evaluation& e) const;
  template <class Bodies>
  void map_derivatives(int joint, std::size_t block, const double* marker_space, int width, Evaluation& e) const;
  template <class Bodies>
  void map_internal(int joint, std::size_t block, const double* marker_space, int width, Evaluation& e) const;
  template <class Bodies>
  const auto& mounts_of() const {
    if constexpr (Bodies::velocities == planar::velocities) {
      return mounts_;
    } else {
      return spatial_mounts_;
    }
  }
  template <class Body>
  auto by_space(Body&& body) const;
  BodyId body_a(int joint) const { return records_[static_cast<std::size_t>(joint)].body_a; }
  BodyId body_b(int joint) const { return records_[static_cast<std::size_t>(joint)].body_b; }

  const Model& model_;
  Variant variant_;
  Layout layout_;
  std::shared_ptr<Motions> motions_;
  std::vector<double> mass_, weight_;
  std::vector<planar::Mount> mounts_;
  std::vector<spatial::Mount> spatial_mounts_;
  BodyCoordinates coordinates_;
  std::vector<InitialOffset> offsets_;
  std::vector<JointRecord> records_;              // by joint
  std::vector<int> with_coordinate_, with_rows_;  // joints that are asked; gears have no rows of their own here
  planar::DeclaredRows declared_;                 // of joints that are not
  std::vector<int> moving_markers_;               // not on ground: body after body
  struct MarkersOfBody {
    int first = 0, end = 0;
  };
  std::vector<MarkersOfBody> markers_of_body_;  // in moving_markers_
  std::vector<JacobianBlock> blocks_;
  std::vector<JacobianBlock> unknown_blocks_;  // of these: rows and bodies that are unknowns
  std::vector<RowPiece> row_pieces_;           // row by row
  std::vector<std::size_t> row_starts_;        // in row_pieces_
  std::vector<double> row_blank_;              // what Evaluation::row_space holds before joints fill it
  /// Row of a driver: where it stands, and whether it is the same always, as of an angle that is declared.
  struct DriverRow {
    int driver, row, joint, block_a, block_b;
    bool constant;
  };
  std::vector<DriverRow> driver_rows_;
  std::vector<int> effort_drivers_;    // which apply a force or a torque
  std::vector<BodyId> marker_places_;  // Layout::place of each marker's body
  /// How a driven body is held: one marker of its own at one of its parent.
  struct Driven {
    BodyId place = ground, parent = ground;
    int joint = -1, driver = -1, own_marker = 0, parent_marker = 0;
    double sign = 1.0;   // of the coordinate: 1 for the joint's second body
    double angle = 0.0;  // of the body beyond its parent's and the coordinate [rad]
    bool slides = false, modulo_turns = false;
    int turn_row = 2;  // of a pin or a weld, in `rows`; the others are of its x and y
    int turn = -1;     // into h
    int rows[3] = {};
    int blocks[3] = {};                   // of these rows in its own columns, into Evaluation::jacobian
    int parent_blocks[3] = {-1, -1, -1};  // and in those of its parent, where that is driven, too
  };
  bool has_slides_ = false;           // among them
  std::vector<Driven> driven_;        // in the order of their places
  planar::DeclaredRows driven_rows_;  // that hold them
  std::vector<DriverRow> driven_driver_rows_;
  /// A row of unknowns in the columns of a driven body.
  struct Coupling {
    int row, offset;
    BodyId place;
  };
  std::vector<Coupling> couplings_;
  std::vector<std::array<int, 4>> gear_blocks_;  // by gear: of the bodies of its first and of its second joint
  std::vector<double> gear_offsets_;
  std::vector<ForceBlock> force_blocks_;
  double size_ = 1.0;
  friend struct Evaluation;
};

/// Results and work space of System::evaluate. Sized once. `context` must outlive it; null: outside of a run, where
/// every joint is awake.
struct Evaluation {
  explicit Evaluation(const System& system, EvaluationContext* context = nullptr);

  EvaluationContext* context = nullptr;
  Profile* profile() const { return context == nullptr ? nullptr : context->profile; }
  std::vector<MarkerKinematics> markers;
  std::vector<planar::Arm> arms;           ///< by marker, in the plane
  std::vector<spatial::Arm> spatial_arms;  ///< by marker, in space
  std::vector<double> q, v;                ///< of all bodies, those of the unknowns first
  std::vector<double> driven_a;            ///< accelerations of driven bodies
  std::vector<double> driven_load;         ///< work space: on driven bodies
  std::vector<double> phi, nu, gamma, jacobian;
  std::vector<double> force;                        ///< on all bodies
  std::vector<double> force_q, force_v;             ///< of force blocks
  std::vector<double> gyroscopic_v;                 ///< in space, 3 x 3 by body: its gyroscopic moment by its w
  std::vector<double> internal_derivatives;         ///< of force blocks with internal variables
  std::vector<double> coordinate, coordinate_rate;  ///< by joint
  std::vector<CoordinateRow> coordinate_rows;       ///< by joint, in marker space
  std::vector<TimeValue> motion;                    ///< by driver
  MotionWork motion_work;
  std::vector<double> potential;       ///< stored energy by joint [J]
  std::vector<double> potential_rate;  ///< its time derivative [W]; NaN where the joint gives none
  std::vector<double> wrench;          ///< by joint: 6 numbers on a, 6 on b, at the markers
  std::vector<double> internal_rate;   ///< z'
  std::vector<double> applied;         ///< by applied force: wrench in world axes at its marker
  std::vector<unsigned char> acts;     ///< by force block: whether its wrenches are not all zero
  std::uint64_t acting = 0;            ///< the same of all blocks together
  Fault fault;

  /// Prescribed motions are not those of their times any more.
  void forget_motions() { motion_time = other_motion_time = driven_time = std::numeric_limits<double>::quiet_NaN(); }
  /// Whether phi and Phi_q are those of this time and these coordinates.
  bool has_rows_at(const Point& point) const;
  /// Whether these terms were filled at this very point.
  bool is_at(const Point& point, unsigned terms) const;

  /// Those of the space that `Bodies` are in.
  template <class Bodies>
  auto& arms_of() {
    if constexpr (Bodies::velocities == planar::velocities) {
      return arms;
    } else {
      return spatial_arms;
    }
  }
  template <class Bodies>
  const auto& arms_of() const {
    return const_cast<Evaluation*>(this)->arms_of<Bodies>();
  }
  // Work space.
  std::vector<MarkerKinematics> shifted;  ///< by joint: second marker of a closed joint that stands off
  std::vector<double> row_space;          ///< of every joint with rows: G, phi, nu, gamma, with marks after each
  std::vector<double> rate_space, derivative_space;
  std::vector<planar::Turn> turns;
  std::vector<spatial::Turn> spatial_turns;
  double driven_time;  ///< that driven bodies are placed for
  double motion_time;
  /// Of the time before that one: methods come back to the middle of a step.
  std::vector<TimeValue> other_motion;
  double other_motion_time;
  /// Terms that were filled for `time`, for the coordinates and velocities of unknowns above, and for these z and h;
  /// none where the evaluation failed.
  unsigned filled = 0;
  double time = 0.0;
  std::vector<double> z, h;

  /// All that may be read again without being filled before.
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive.doubles(self.markers, self.arms, self.spatial_arms, self.turns, self.spatial_turns, self.shifted);
    archive.doubles(self.coordinate_rows, self.motion, self.other_motion);
    archive(self.q, self.v, self.driven_a, self.phi, self.nu, self.gamma, self.jacobian);
    archive(self.force, self.force_q, self.force_v, self.gyroscopic_v, self.internal_derivatives);
    archive(self.coordinate, self.coordinate_rate, self.potential, self.potential_rate, self.wrench);
    archive(self.internal_rate, self.applied, self.acts, self.acting);
    archive(self.driven_time, self.motion_time, self.other_motion_time, self.filled, self.time, self.z, self.h);
  }
};

/// An Evaluation that changes places with another one by its address.
class KeptEvaluation {
 public:
  explicit KeptEvaluation(const System& system, EvaluationContext* context = nullptr)
      : evaluation_(std::make_unique<Evaluation>(system, context)) {}
  operator Evaluation&() { return *evaluation_; }
  operator const Evaluation&() const { return *evaluation_; }
  Evaluation* operator->() { return evaluation_.get(); }
  const Evaluation* operator->() const { return evaluation_.get(); }
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(*self.evaluation_);
  }
  friend void swap(KeptEvaluation& a, KeptEvaluation& b) noexcept { a.evaluation_.swap(b.evaluation_); }

 private:
  std::unique_ptr<Evaluation> evaluation_;
};

/// Calls `body` with the bodies of the model's space, planar::Bodies{} or spatial::Bodies{}.
template <class Body>
auto System::by_space(Body&& body) const {
  return model_.space == Space::planar ? body(planar::Bodies{}) : body(spatial::Bodies{});
}

inline JointInput System::input(const JointRecord& record, const Point& point, const Evaluation& e) const {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  return {point.t,
          &e.markers[at(record.marker_a)],
          record.stands_off ? &e.shifted[at(record.index)] : &e.markers[at(record.marker_b)],
          e.coordinate[at(record.index)],
          e.coordinate_rate[at(record.index)],
          {point.z.data() + record.internal.offset, at(record.internal.size)},
          {point.h.data() + record.history.offset, at(record.history.size)},
          e.context == nullptr ? 0.0 : e.context->per_contact};
}

inline JointInput System::input(int index, const Point& point, const Evaluation& e) const {
  return input(records_[static_cast<std::size_t>(index)], point, e);
}

}  // namespace freeplay
