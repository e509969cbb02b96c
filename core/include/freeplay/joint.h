// Joint: anything that connects two markers by constraint rows, by forces, or by both.
//
// Conventions, stated once: SI units, world axes, matrices row-major. a is the marker on the first body, b the one
// on the second. Forces act on body b, their reactions on body a. Twists are [velocity; angular velocity], wrenches
// [force; moment about the marker's origin], 6 numbers each. In planar models the motion lies in the world xy-plane;
// the host reads columns vx, vy, wz and entries Fx, Fy, Mz.
#pragma once

#include <memory>

#include "freeplay/contact_law.h"
#include "freeplay/friction_law.h"
#include "freeplay/parameter.h"

namespace freeplay {

enum class Space : std::uint32_t { planar = 1, spatial = 2, both = 3 };

/// Pose and twist of a marker.
struct MarkerKinematics {
  double position[3];          ///< [m]
  double rotation[9];          ///< world-from-marker; column k is the marker's axis k
  double velocity[3];          ///< [m/s]
  double angular_velocity[3];  ///< [rad/s]
};

/// Position and orientation of one marker in another.
struct Pose {
  double position[3];  ///< [m]
  double rotation[9];  ///< row-major
};

struct Channel {
  const char* name;
  const char* unit;
};

/// What a channel says of the contact of a joint, whatever its name. The host's statistics, its list of impacts and its
/// verdict go by roles.
enum class ChannelRole : std::uint32_t {
  none,
  penetration,     ///< delta, negative in flight [m]
  normal_force,    ///< F_N, zero in flight [N]
  friction_force,  ///< F_T [N]
  slip_speed,      ///< v_T of the two surfaces against each other [m/s]
  eccentricity_x,  ///< origin of b minus that of a, world axes [m]
  eccentricity_y,
  eccentricity_z,
  in_contact  ///< 1 in contact, 0 in flight
};

/// What an event says of a contact. A joint may have several: the first begin and the first end in declaration order
/// are of the same contact, so are the second ones, and so on.
enum class EventRole : std::uint32_t { none, contact_begin, contact_end };

enum class Crossing : std::uint32_t { rising, falling };

/// A zero crossing at which the joint wants on_event() called: the event function passes zero in the given direction.
/// One that is NaN cannot happen now; one that an event turns from NaN to a number past its zero happens at once, and a
/// rising one whose function is positive when the run starts happens then.
struct Event {
  const char* name;
  Crossing crossing;
  std::uint32_t locate;        ///< nonzero: runs with error control shorten the step to the crossing
  Span<const Channel> fields;  ///< numbers recorded with each occurrence; NaN is recorded as empty
};

/// The one number that says where a joint stands. Drivers, gears and start values work on it.
enum class Coordinate : std::uint32_t { none, angle, position };

/// Rows of a planar joint that the host can make itself. With d = P_b - P_a, h the x axis of marker a, n = h turned by
/// +90 degrees and theta the angles of the markers:
enum class PlanarRow : std::uint32_t {
  origins,  ///< two rows, d_x = 0 and d_y = 0
  across,   ///< n.d = 0
  turn      ///< theta_b - theta_a = 0, up to whole turns
};

/// Where the play of a joint lets the origin of b stand.
enum class PlayShape : std::uint32_t {
  by_coordinate,  ///< between walls where the coordinate is a position, else round
  round,          ///< as far as `clearance` from the origin of a, in a circle across the axis or in a ball
  walls           ///< as far as `clearance` to both sides of the x axis of a, and anywhere along it
};

/// A line on one of the two bodies, for pictures of planar models: as the wall of a slot.
struct BodyLine {
  std::uint32_t on_second;    ///< nonzero: on the second body
  Span<const double> points;  ///< x and y of one point after the other, in the axes of the marker there [m]
};

/// What a joint asks of the model, answered once, before the layout of the state is fixed.
struct JointLayout {
  std::uint32_t size = sizeof(JointLayout);
  Space space = Space::planar;  ///< in: the model's space, planar or spatial
  Coordinate coordinate = Coordinate::none;
  std::int32_t constraint_rows = 0;
  std::int32_t internal_variables = 0;
  std::int32_t history = 0;                ///< numbers that change only when a step is accepted
  std::uint32_t forces = 0;                ///< nonzero: apply() does something
  std::uint32_t analytic_derivatives = 0;  ///< nonzero: apply() fills JointForces::derivatives
  std::uint32_t pin = 0;                   ///< nonzero: planar, origins coincide and only the turn is free
  double clearance = 0.0;                  ///< radius of the massless link that stands for the play [m]; 0 without play
  Span<const Event> events;
  Span<const Channel> channels;
  std::uint32_t rows_without_coordinate = 0;    ///< nonzero: constrain() does not read the coordinate, which saves time
  std::uint32_t forces_without_coordinate = 0;  ///< nonzero: apply() and the calls about steps and events do not either
  /// Planar models: constrain() writes just these rows, in this order. The host may make them itself, for all joints at
  /// once and without asking. Empty: it always asks.
  Span<const PlanarRow> planar_rows;
  /// Planar models, nonzero: coordinate() is theta_b - theta_a or, a position, h.d. The host may make it itself.
  std::uint32_t planar_coordinate = 0;
  // What is known of the two surfaces of a joint with play, by which the host judges results; NaN: not known.
  double smaller_radius = std::numeric_limits<double>::quiet_NaN();   ///< of the two, as of a journal [m]
  double contact_length = std::numeric_limits<double>::quiet_NaN();   ///< along the axis [m]
  double contact_modulus = std::numeric_limits<double>::quiet_NaN();  ///< E*: 1/E* = (1-nu^2)/E of both, added [Pa]
  /// How fine the joint's own dependence on time (JointInput::t) is: the duration of its shortest change [s].
  /// `unbounded`: neither forces nor rows depend on t. 0: not known. Runs with error control look at forces and rows,
  /// as functions of t alone, so closely that no change of that duration is stepped over; where it is not known, none
  /// as long as an output interval. What is shorter is met if next_corner() reports it.
  double time_scale = 0.0;
  /// One for each of `channels`; each role but `none` at most once. Empty: roles follow from the names ex, ey, ez,
  /// delta, fn, ft, vt and contact.
  Span<const ChannelRole> channel_roles;
  /// One for each of `events`. Empty: from names that end in contact_begin and contact_end.
  Span<const EventRole> event_roles;
  std::int32_t kinks = 0;                  ///< numbers that kinks() fills
  std::uint32_t wants_whole_mobility = 0;  ///< nonzero: on_event() gets JointInput::whole_mobility
  PlayShape play_shape = PlayShape::by_coordinate;
  double contact_reach = 0.0;  ///< between walls: most by which a depth changes with the angle of b, as by corners that
                               ///< stand so far from its origin [m]
  Span<const BodyLine> outlines;  ///< drawn in place of a symbol; they live as long as the joint
  /// Play that is no circle, for the error analysis: seven numbers for each bound, gap [m], n (3) and m (3), with
  ///
  ///   |n.d + m.phi| <= gap
  ///
  /// for the shift d and the turn phi (a small rotation vector) by which b stands off from where the ideal twin holds
  /// it, in the axes of a: as each contact has them to first order. All hold together, and what none of them bounds the
  /// twin leaves free, too. They live as long as the joint.
  Span<const double> play_bounds;
  /// Spatial models, nonzero: the way that free_distance() promises is seen from a, and turns count by free_levers().
  std::uint32_t free_turns = 0;
  /// Ends of the way of the coordinate, beyond which the joint pushes back; infinite without ends. Analyses leave out
  /// what lies beyond [rad or m].
  double lowest = -std::numeric_limits<double>::infinity(), highest = std::numeric_limits<double>::infinity();
};

/// Everything a joint may read. All views are valid during the call only.
struct JointInput {
  double t;                     ///< [s]
  const MarkerKinematics* a;    ///< marker on the first body
  const MarkerKinematics* b;    ///< marker on the second body
  double coordinate;            ///< second relative to first [rad or m], angles continuous over turns
  double coordinate_rate;       ///< [rad/s or m/s]
  Span<const double> internal;  ///< this joint's share of z
  Span<const double> history;   ///< this joint's share of h
  // Appended.
  /// Steps that an impact should take, in runs that end their steps at events; 0 in runs that do not. In such runs
  /// `history` alone decides which side of an event a joint is on: an attempt that passes the event is thrown away,
  /// and is repeated up to it.
  double per_contact = 0.0;
  /// on_event(): 3 x 3, acceleration of b relative to a [m/s^2] for a unit force [N] on b and its opposite on a,
  /// constraints included, world axes. In runs that do not end their steps at events, it is that at the end of the
  /// step, and only events that begin a contact get it. Else null.
  const double* mobility = nullptr;
  /// With `mobility`, for joints that want it: 6 x 6, acceleration [m/s^2, rad/s^2] of b against a, both at the origin
  /// of b, for a unit wrench on b there and its opposite on a at the same point. So 1/m of a contact with the wrench w
  /// on b is w.(W w), turning included.
  const double* whole_mobility = nullptr;
  /// commit() and on_event(): where a joint that gives potential_rate adds the energy [J] that it loses as it changes
  /// `history` or `internal` there, because it yields or forgets what it stored: JointForces::potential falls by as
  /// much. The host books it as dissipated. Else null.
  double* dissipated = nullptr;
  /// Values now of the type's parameters that may depend on the motion (Parameter::variables), in the order of its
  /// table, where the model lets one of them depend on it; else empty, and what the constructor read holds. Forces are
  /// linear in each between kinks: by them the host differentiates.
  Span<const double> functions = {};
  /// Of these the one with this index, or else what was read.
  double function(std::size_t index, double read) const { return functions.empty() ? read : functions[index]; }
};

/// Rows of Phi(q,t) = 0. Zeroed by the host.
struct ConstraintRows {
  Span<double> phi;       ///< residual, constraint_rows
  Span<double> jacobian;  ///< G, constraint_rows x 12 with respect to [twist a, twist b]: d(phi)/dt = G V - nu
  Span<double> nu;        ///< -(partial phi / partial t)
  Span<double> gamma;     ///< G dV/dt = gamma for the markers' accelerations
};

/// The joint coordinate s: s' = G V, s'' = G dV/dt + bias. An angle may be given in any turn; the host makes it
/// continuous.
struct CoordinateRow {
  double value;
  double bias;
  double jacobian[12];
};

/// Wrenches that the joint exerts on each body at its marker. Zeroed by the host.
struct JointForces {
  double wrench_a[6], wrench_b[6];  ///< [N, N m]
  double potential;                 ///< stored energy [J]; the host derives the dissipated part
  Span<double> internal_rate;       ///< z'
  /// (12 + nz) x (24 + nz) partial derivatives of [wrench a, wrench b, z'] with respect to
  /// [pose a, pose b, twist a, twist b, z]; a pose changes by a displacement and a rotation vector in world axes.
  /// Empty when not wanted.
  Span<double> derivatives;
  // Appended.
  /// Time derivative of `potential` at this state [W]. With it what is dissipated is known at every instant: minus the
  /// power of the wrenches and this. NaN (as the host leaves it): the host takes differences of `potential` over steps.
  double potential_rate = std::numeric_limits<double>::quiet_NaN();
};

/// Start of a joint with play: where its second marker stands in the first, world axes. A joint writes its outputs and
/// leaves the inputs.
struct InitialOffset {
  double position[3];  ///< [m]
  double velocity[3];  ///< [m/s]
  // Appended.
  /// In: world-from-marker of the first marker, 9 numbers; null: its axes are those of the world.
  const double* rotation = nullptr;
  /// Planar models: angle of b against where the ideal joint holds it, and its rate.
  double turn = 0.0;       ///< [rad]
  double turn_rate = 0.0;  ///< [rad/s]
  /// Spatial models: rotation vector by which b is turned from where the ideal joint holds it, and angular velocity of
  /// b against a beside the motion that the ideal joint leaves free, world axes.
  double tilt[3] = {};       ///< [rad]
  double tilt_rate[3] = {};  ///< [rad/s]
  /// In, with `rotation`: both markers as the ideal joint holds them; null where that is not known yet.
  const MarkerKinematics *a = nullptr, *b = nullptr;
};

/// Marker accelerations [a; alpha] in world axes, 6 numbers each [m/s^2, rad/s^2].
struct MarkerAccelerations {
  double a[6], b[6];
};

/// Base class of every joint and two-marker force. Immutable after construction: whatever changes lives in
/// `internal` or `history`. Override only what the joint has. Any of them may throw.
class Joint {
 public:
  virtual ~Joint() = default;
  virtual void declare(JointLayout& layout) const = 0;
  virtual void coordinate(const JointInput&, CoordinateRow&) const {}
  virtual void constrain(const JointInput&, ConstraintRows&) const {}
  virtual void apply(const JointInput&, JointForces&) const {}
  /// First z and h, at the assembled start. One in which the joint cannot be is refused by BadParameter.
  virtual void initialize(const JointInput&, Span<double> /*internal*/, Span<double> /*history*/) const {}
  /// Before every attempt of a step of length dt, also a repeated one: may prepare `history` of the trial state, which
  /// is thrown away with a rejected attempt.
  virtual void begin_step(const JointInput&, const MarkerAccelerations&, double /*dt*/,
                          Span<double> /*history*/) const {}
  /// Values and time derivatives of the event functions; NaN in `g`: cannot happen now.
  virtual void events(const JointInput&, Span<double> /*g*/, Span<double> /*rate*/) const {}
  /// Event `index` happened at the state of the input (interpolated inside the step in fixed-step runs).
  virtual void on_event(int /*index*/, const JointInput&, Span<double> /*internal*/, Span<double> /*history*/,
                        Span<double> /*fields*/) const {}
  /// After a step was accepted and its events were passed on. `lambda` are the joint's multipliers.
  virtual void commit(const JointInput&, Span<const double> /*lambda*/, Span<double> /*history*/) const {}
  /// Values of the channels, all finite.
  virtual void observe(const JointInput&, Span<const double> /*lambda*/, Span<double> /*channels*/) const {}
  /// Largest sensible step from here [s].
  virtual double step_limit(const JointInput&) const { return unbounded; }
  /// Pose of marker b in marker a for a value of the joint coordinate; false: this type cannot place a body.
  virtual bool place(double /*coordinate*/, Pose& /*b_in_a*/) const { return false; }
  /// A joint with play: its start, given the force [N] and the moment [N m] of the ideal joint on the second body at
  /// its marker (world axes, 6 numbers; hosts of older versions give the 3 of the force).
  virtual void initial_offset(Span<const double> /*reaction*/, InitialOffset&) const {}
  /// A static sentence when the joint or one of its laws is used outside its range here, else null. Asked at accepted
  /// states; the host reports the first answer of each joint.
  virtual const char* warning(const JointInput&) const { return nullptr; }
  /// How far the origin of b may move from here against that of a, in any direction and however else the markers move,
  /// while the joint certainly leaves everything alone [m]: no wrench, no stored energy, z' = 0, no event past its
  /// zero, no warning, and commit() changes nothing that a later call reads. begin_step() may then be left out, too. In
  /// steps of fixed size the host does not ask a joint for anything of that until its markers have used up the
  /// distance, nearly. 0: no promise. Play between walls (PlayShape) counts otherwise, in planar models: how far the
  /// origin of b moves across the x axis of a, seen from a, and JointLayout::contact_reach times the angle by which b
  /// turns against a, added. With JointLayout::free_turns the way is that of the origin of b seen from a, in the axes
  /// of a, and free_levers() times the ways of the tips of the unit axes of b there, added.
  virtual double free_distance(const JointInput&) const { return 0.0; }
  /// Right after free_distance(), with JointLayout::free_turns: how far from the origin of b, along each of its three
  /// axes, what may touch stands [m]. The turn of a round pin about its axis counts nothing if the other two are 0.
  virtual void free_levers(const JointInput&, Span<double> /*levers*/) const {}
  /// The first time after t [s] at which forces or rows, as functions of JointInput::t alone, begin, end, jump or have
  /// a kink: runs with error control end a step there. It depends on nothing but t. `unbounded`: there is none. Corners
  /// of a TimeFunction among the parameters are known to the host.
  virtual double next_corner(double /*t*/) const { return unbounded; }
  /// Joints with several contacts (events of the role contact_begin): three numbers for each, in the order of these
  /// events: F_N [N], F_T [N] and the power that it dissipates [W]. By them impulses and losses are kept apart; a joint
  /// that leaves them as they are shares them among the contacts that are on.
  virtual void contacts(const JointInput&, Span<double> /*numbers*/) const {}
  /// Functions of which each is zero where a force has a kink, as at a speed at which a law changes its formula; NaN:
  /// not now. A step with error control ends there if its error could matter. Where forces begin or end is an event.
  virtual void kinks(const JointInput&, Span<double> /*g*/) const {}
};

namespace abi {
struct JointTable {
  std::uint32_t size;
  void (*destroy)(void*) noexcept;
  Status (*declare)(const void*, JointLayout*, Message*) noexcept;
  Status (*coordinate)(const void*, const JointInput*, CoordinateRow*, Message*) noexcept;
  Status (*constrain)(const void*, const JointInput*, ConstraintRows*, Message*) noexcept;
  Status (*apply)(const void*, const JointInput*, JointForces*, Message*) noexcept;
  Status (*initialize)(const void*, const JointInput*, Span<double>, Span<double>, Message*) noexcept;
  Status (*begin_step)(const void*, const JointInput*, const MarkerAccelerations*, double, Span<double>,
                       Message*) noexcept;
  Status (*events)(const void*, const JointInput*, Span<double>, Span<double>, Message*) noexcept;
  Status (*on_event)(const void*, std::int32_t, const JointInput*, Span<double>, Span<double>, Span<double>,
                     Message*) noexcept;
  Status (*commit)(const void*, const JointInput*, Span<const double>, Span<double>, Message*) noexcept;
  Status (*observe)(const void*, const JointInput*, Span<const double>, Span<double>, Message*) noexcept;
  Status (*step_limit)(const void*, const JointInput*, double*, Message*) noexcept;
  Status (*place)(const void*, double, Pose*, std::int32_t*, Message*) noexcept;
  Status (*initial_offset)(const void*, Span<const double>, InitialOffset*, Message*) noexcept;
  Status (*warning)(const void*, const JointInput*, const char** text, Message*) noexcept;
  Status (*free_distance)(const void*, const JointInput*, double*, Message*) noexcept;
  Status (*next_corner)(const void*, double t, double* corner, Message*) noexcept;
  Status (*contacts)(const void*, const JointInput*, Span<double> numbers, Message*) noexcept;
  Status (*kinks)(const void*, const JointInput*, Span<double> g, Message*) noexcept;
  Status (*free_levers)(const void*, const JointInput*, Span<double> levers, Message*) noexcept;
};

/// Thunks are instantiated inside the plugin, so its exceptions are caught where they are thrown.
template <class J>
inline constexpr JointTable joint_table{
    sizeof(JointTable),
    [](void* s) noexcept { delete static_cast<J*>(s); },
    [](const void* s, JointLayout* layout, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const J*>(s)->declare(*layout); });
    },
    [](const void* s, const JointInput* in, CoordinateRow* row, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const J*>(s)->coordinate(*in, *row); });
    },
    [](const void* s, const JointInput* in, ConstraintRows* rows, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const J*>(s)->constrain(*in, *rows); });
    },
    [](const void* s, const JointInput* in, JointForces* forces, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const J*>(s)->apply(*in, *forces); });
    },
    [](const void* s, const JointInput* in, Span<double> z, Span<double> h, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const J*>(s)->initialize(*in, z, h); });
    },
    [](const void* s, const JointInput* in, const MarkerAccelerations* acc, double dt, Span<double> h,
       Message* m) noexcept { return guarded(m, [&] { static_cast<const J*>(s)->begin_step(*in, *acc, dt, h); }); },
    [](const void* s, const JointInput* in, Span<double> g, Span<double> rate, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const J*>(s)->events(*in, g, rate); });
    },
    [](const void* s, std::int32_t event, const JointInput* in, Span<double> z, Span<double> h, Span<double> fields,
       Message* m) noexcept {
      return guarded(m, [&] { static_cast<const J*>(s)->on_event(event, *in, z, h, fields); });
    },
    [](const void* s, const JointInput* in, Span<const double> l, Span<double> h, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const J*>(s)->commit(*in, l, h); });
    },
    [](const void* s, const JointInput* in, Span<const double> l, Span<double> c, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const J*>(s)->observe(*in, l, c); });
    },
    [](const void* s, const JointInput* in, double* dt, Message* m) noexcept {
      return guarded(m, [&] { *dt = static_cast<const J*>(s)->step_limit(*in); });
    },
    [](const void* s, double coordinate, Pose* pose, std::int32_t* can, Message* m) noexcept {
      return guarded(m, [&] { *can = static_cast<const J*>(s)->place(coordinate, *pose) ? 1 : 0; });
    },
    [](const void* s, Span<const double> reaction, InitialOffset* out, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const J*>(s)->initial_offset(reaction, *out); });
    },
    [](const void* s, const JointInput* in, const char** text, Message* m) noexcept {
      return guarded(m, [&] { *text = static_cast<const J*>(s)->warning(*in); });
    },
    [](const void* s, const JointInput* in, double* distance, Message* m) noexcept {
      return guarded(m, [&] { *distance = static_cast<const J*>(s)->free_distance(*in); });
    },
    [](const void* s, double t, double* corner, Message* m) noexcept {
      return guarded(m, [&] { *corner = static_cast<const J*>(s)->next_corner(t); });
    },
    [](const void* s, const JointInput* in, Span<double> numbers, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const J*>(s)->contacts(*in, numbers); });
    },
    [](const void* s, const JointInput* in, Span<double> g, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const J*>(s)->kinks(*in, g); });
    },
    [](const void* s, const JointInput* in, Span<double> levers, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const J*>(s)->free_levers(*in, levers); });
    }};

template <class J>
Status create_joint(const ParameterTable* table, void** self, Message* m) noexcept {
  return guarded(m, [&] { *self = std::make_unique<J>(Parameters(*table)).release(); });
}
}  // namespace abi
}  // namespace freeplay
