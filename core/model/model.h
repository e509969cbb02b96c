// Model: the checked mechanism, immutable after build_model().
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/expression.h"
#include "component/instances.h"
#include "model/frame_path.h"
#include "model/grid_values.h"
#include "model/motion_formula.h"
#include "model/time_table.h"

namespace freeplay {

using Vector3 = std::array<double, 3>;
/// World (or body) from frame axes, row-major.
using Rotation = std::array<double, 9>;
inline constexpr Rotation no_rotation{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};

/// Index of a body in Model::bodies, or `ground`.
using BodyId = int;
inline constexpr BodyId ground = -1;

struct Body {
  std::string name;
  Location location;                 ///< of the entry
  double mass = 0.0;                 ///< [kg]
  std::array<double, 9> inertia{};   ///< about the centre of mass, body axes [kg m^2]; planar: the last entry
  Vector3 com{};                     ///< centre of mass in the body frame [m]
  Vector3 gravity{};                 ///< acceleration of free fall [m/s^2]
  std::optional<Vector3> position;   ///< starting guess of the body frame [m]
  std::optional<double> angle;       ///< planar starting guess [rad]
  std::optional<Rotation> rotation;  ///< spatial starting guess of the body frame
  Vector3 velocity{};                ///< starting guess for the body frame's origin [m/s]
  Vector3 angular_velocity{};        ///< [rad/s]; planar: z
  bool velocity_given = false, angular_velocity_given = false;  ///< each of the two, in the file
  Location pose_location{}, velocity_location{};                ///< of their keys; empty where they are not given
};

/// Point with axes fixed on a body ("frame" in model files).
struct Marker {
  BodyId body = ground;
  std::string name;                 ///< BODY/FRAME
  Vector3 position{};               ///< in the body frame [m]
  double angle = 0.0;               ///< planar [rad]
  Rotation rotation = no_rotation;  ///< spatial: body from marker axes
};

/// A value of `initial` that assembly holds exactly.
struct StartValue {
  double value = 0.0;
  Location location;  ///< of its key
};

/// Where a formula is written; `verbatim`: characters of it are places there.
struct FormulaPlace {
  Location begin;
  bool verbatim = false;
};

/// What a joint with play becomes without it.
struct IdealTwin {
  const Component* component = nullptr;
  JointRef joint;
  JointLayout layout;
};

/// A joint or a force between two markers; a gear has rows but no markers of its own.
struct JointElement {
  std::string name;
  Location location;                     ///< of the entry
  const Component* component = nullptr;  ///< the type that runs
  JointRef joint;
  JointLayout layout;
  int marker_a = 0, marker_b = 0;                    ///< indices into Model::markers
  std::shared_ptr<const ParameterBlock> parameters;  ///< the parameters of the type that is written; null for a gear
  MotionFormulas by_motion;               ///< of all its parameters that may depend on the motion, where one does
  std::vector<FormulaPlace> places;       ///< of these
  std::vector<Expression> in_time;        ///< parts of them that depend on time alone
  std::shared_ptr<const IdealTwin> twin;  ///< of a joint with play; all others are their own
  bool has_play = false;
  bool is_force = false;        ///< an entry of `forces`
  int gear = -1;                ///< index into Model::gears
  std::optional<Vector3> axis;  ///< as given, made a unit vector; the markers are turned already
  std::optional<StartValue> start_coordinate, start_speed;

  const Component* ideal_component() const { return twin ? twin->component : component; }
  const JointRef& ideal() const { return twin ? twin->joint : joint; }
  const JointLayout& ideal_layout() const { return twin ? twin->layout : layout; }
};

/// coordinate(second) = ratio coordinate(first) + offset.
struct Gear {
  int joint = 0;                 ///< index into Model::joints of the gear itself
  int first = 0, second = 0;     ///< joints that it couples
  double ratio = 1.0;            ///< plain, m/rad or rad/m
  std::optional<double> offset;  ///< [rad or m]; empty: what the assembled start has
};

enum class DriverKind { angle, position, velocity, torque, force };
inline bool prescribes(DriverKind kind) { return kind != DriverKind::torque && kind != DriverKind::force; }

/// One driven joint.
struct Driver {
  std::string name;
  Location location;
  int joint = 0;
  DriverKind kind = DriverKind::angle;
  Expression value;                 ///< of time; unused when `table`, `kinematics` or `by_motion` is set
  std::string text;                 ///< of the expression, as written
  std::vector<Expression> in_time;  ///< parts of a value by the motion that depend on time alone
  MotionFormulas by_motion;         ///< an effort that depends on the motion
  std::shared_ptr<const TimeTable> table;
  TableSource table_source;
  int kinematics = -1;  ///< index into Model::kinematics: motion by inverse kinematics
  int elbow = 1;        ///< working mode of the leg, 1 or -1
  bool elbow_given = false;
  bool input = false;  ///< an effort that the caller of a run may set: until then it is `value`, which is a constant
};

/// The frame of an inverse-kinematics entry and its path. Its drivers are neighbours in Model::drivers.
struct InverseKinematics {
  std::string name;
  Location location, frame_location, path_location;
  int marker = 0;
  FramePath path;
  int first_driver = 0, driver_count = 0;
};

enum class ForceKind { force, torque };

/// Force or torque given as functions of time, or of time and the motion.
struct AppliedForce {
  std::string name;
  Location location;
  ForceKind kind = ForceKind::force;
  int marker = 0;                   ///< torque: the marker `com` of the body
  bool frame_axes = false;          ///< force: components in the marker's axes instead of world axes
  std::vector<Expression> value;    ///< force: 2 or 3 [N]; torque: 1 or 3 [N m]
  std::vector<std::string> text;    ///< of each expression, as written
  std::vector<Expression> in_time;  ///< what of them depends on time alone: all of them, or parts
  MotionFormulas by_motion;         ///< the same values where one depends on the motion; else empty
};

/// An entry of `forces` that gives bodies a gravity of their own (Body::gravity has it).
struct OwnGravity {
  std::string name;
  std::vector<BodyId> bodies;  ///< as written, each once
  Vector3 value{};             ///< [m/s^2]
  std::size_t place = 0;       ///< how many of Model::force_elements are declared before
};

/// An entry of `forces` that reports results: an applied force, or a joint without rows.
struct ForceElement {
  int applied = -1;  ///< index into Model::forces
  int joint = -1;    ///< index into Model::joints
};

/// A file that the model was read from besides its own.
struct InputFile {
  std::string name;  ///< without folder, unique
  std::string text;  ///< byte for byte
};

/// Ends a run, successfully.
struct StopCondition {
  std::string channel;
  double limit = 0.0;  ///< SI
  Quantity quantity;   ///< the same with what is known of its dimension, which must be that of the channel
  Location quantity_location;
  bool above = true;
  double after = 0.0;  ///< [s]
  Location location;
};

/// A result column that is a formula of others.
struct OutputColumn {
  std::string name;      ///< in full, output.NAME
  std::string text;      ///< as written
  std::string unit;      ///< SI
  Expression formula{};  ///< variables: indices into `channels`
  std::vector<std::string> channels{};
};

enum class ResultFormat { csv, hdf5, both };
inline constexpr const char* result_formats[] = {"csv", "hdf5", "both"};

struct Settings {
  double start = 0.0, end = 1.0;  ///< [s]
  double step = 1e-4;             ///< fixed, or the first of an adaptive run [s]
  bool adaptive = false;
  double tolerance = 1e-6;  ///< local error, relative to the smallest clearance or else to the model's size
  double smallest_step = 1e-7, largest_step = 1e-3;  ///< adaptive runs [s]
  double per_contact = 20.0;                         ///< steps that an impact should take
  double accuracy = 0.0;                             ///< chooses all of these [m per s]; 0: not given
  Location accuracy_location{};                      ///< of what the file says of it; empty when the file does not
  ParameterBlock integrator_parameters;
  IntegratorRef integrator;
  double interval = 0.0;                   ///< of output rows [s]
  int rows_in_contact = 0;                 ///< besides these, along an impact; 0: no rows inside of contacts
  double discard = 0.0;                    ///< left out of statistics, from the start [s]
  std::vector<std::string> channels{"*"};  ///< patterns of result columns
  std::vector<int> frames;                 ///< markers to report
  std::vector<OutputColumn> columns;
  ResultFormat format = ResultFormat::both;
  bool format_given = false;  ///< by the file or an option
  std::vector<StopCondition> stop;
  double assembly_tolerance = 1e-10;  ///< [m, rad]
  int assembly_iterations = 50;
};

/// The section `analysis`; what it does not say is empty.
struct AnalysisSection {
  /// Ends of the way of a joint [rad or m].
  struct Ends {
    int joint = 0;
    double lowest = 0.0, highest = 0.0;
  };
  std::optional<Location> frame_location, joints_location, elbow_location, path_location;
  int marker = 0;                                 ///< the platform, if frame_location is given
  std::vector<int> joints;                        ///< the inputs, if joints_location is given
  std::vector<int> elbow;                         ///< one for all inputs, or one each, if elbow_location is given
  FramePath path;                                 ///< if path_location is given
  std::optional<GridValues> time;                 ///< [s]
  std::array<std::optional<GridValues>, 6> grid;  ///< by number of a pose: x, y [m], angle; in space as PoseForm says
  std::optional<Location> grid_location;          ///< of the key
  std::vector<Ends> limits;
  std::vector<std::pair<int, double>> clearance;  ///< joint and radius [m], in place of the joint's own
  double input = 0.0;                             ///< error of each input [rad or m]
  Location input_location;
  bool input_is_length = false;  ///< written with a unit of length: for slides only
};

struct Model {
  std::string file, text, name;  ///< path as given, text byte for byte, name for reports
  Space space = Space::planar;
  Vector3 gravity{};
  std::vector<Body> bodies;
  std::vector<Marker> markers;
  std::vector<Marker> frames;  ///< all that are declared, sorted by name; `markers` are those that something stands on
  std::vector<JointElement> joints;  ///< joints and gears as declared, then forces between markers
  std::vector<Gear> gears;
  std::vector<Driver> drivers;
  std::vector<InverseKinematics> kinematics;
  std::vector<AppliedForce> forces;
  std::vector<ForceElement> force_elements;  ///< in declaration order
  std::vector<OwnGravity> own_gravities;
  std::vector<InputFile> inputs;
  Settings settings;
  AnalysisSection analysis;
  std::vector<std::pair<std::string, std::string>> overrides;  ///< --set, name and text
  std::vector<std::pair<std::string, Quantity>> parameters{};  ///< of the top level, with the values that they have
  std::vector<std::string> ideal;                              ///< joints whose clearance --ideal closes, full names
  Instances instances;                                         ///< keeps joints and laws alive

  int clearance_joints() const {
    int count = 0;
    for (const JointElement& joint : joints) count += joint.has_play ? 1 : 0;
    return count;
  }
};

/// Calls `each` with the formulas of all forces, drivers and joints that depend on the motion, in the order in which h
/// keeps the sides of their switches.
template <class Each>
void for_each_motion_formulas(const Model& model, Each&& each) {
  for (const AppliedForce& force : model.forces) {
    if (!force.by_motion.empty()) each(force.by_motion);
  }
  for (const Driver& driver : model.drivers) {
    if (!driver.by_motion.empty()) each(driver.by_motion);
  }
  for (const JointElement& joint : model.joints) {
    if (!joint.by_motion.empty()) each(joint.by_motion);
  }
}

}  // namespace freeplay
