// The plugin entry point: one C function per library, one table of components.
#pragma once

#include <cstring>

#include "freeplay/contact_law.h"
#include "freeplay/friction_law.h"
#include "freeplay/integrator.h"
#include "freeplay/joint.h"

namespace freeplay {

inline constexpr std::uint32_t abi_version = 1;

/// Everything besides abi_version that must agree for the tables to mean the same thing.
inline constexpr const char* abi_fingerprint = "lp64 little ieee754";
static_assert(sizeof(void*) == 8 && sizeof(Span<double>) == 16 && std::numeric_limits<double>::is_iec559);

enum class ComponentKind : std::uint32_t { joint, contact_law, friction_law, integrator };

/// A joint type in models of one space: an abi::JointTable, and the abi::create_joint<T> that belongs to it.
struct JointFace {
  const void* table = nullptr;
  void (*create)() = nullptr;
};
template <class T>
JointFace joint_face() {
  return {&abi::joint_table<T>, reinterpret_cast<void (*)()>(&abi::create_joint<T>)};
}

/// An axis of a joint's markers.
enum class MarkerAxis : std::uint32_t { none = 0, x = 1, z = 3 };

/// One of the joints of a JointChain.
struct JointPart {
  const char* name;  ///< the whole joint's name, a dot and this are its own
  const char* type;  ///< a type with play; what its parameters are called like in the whole type's block it takes over
  double axis[3];    ///< its axis in the frames of both of its ends
};

/// What stands for a joint with play that is two joints about a body of its own, as the cross of a universal joint.
struct JointChain {
  JointPart first, second;  ///< from the first end to the body, and from the body to the second end
  const char* body;         ///< the whole joint's name, a dot and this are the body's
  const char* mass;         ///< the parameter that is its mass [kg]
  const char* inertia;      ///< the parameter, a vector, with its moments about the axes of its frame [kg m^2]
  /// A word of the ideal type, none, first or second: the part whose coordinate the whole joint's name means.
  const char* coordinate;
};

/// What the host knows of a type before it creates an instance; texts are for `freeplay list` and `describe`.
struct Description {
  const char* name;             ///< the word in a model file, kebab-case
  Space space = Space::both;    ///< joints: where the type may be used
  const char* summary = "";     ///< one sentence
  const char* formula = "";     ///< the equations in words and symbols
  const char* validity = "";    ///< where it may be used; "" without a limit
  const char* references = "";  ///< paper or book with equation number; "" when elementary
  Span<const Parameter> parameters = {};
  /// 1: used where the model file names none of this kind; 2: the integrator of runs that name an accuracy instead.
  std::uint32_t preferred = 0;
  // Joints with play. A joint of type `ideal` that has the key `block` is of this type, and `ideal` stands in for it
  // where the play is closed: in assembly, `--ideal` and the analysis.
  const char* ideal = nullptr;
  const char* block = nullptr;
  // Joints: other words for the first and the second of `between`, such as bearing and journal.
  const char* first_end = nullptr;
  const char* second_end = nullptr;
  /// Of a type that the library could bring but does not, as what it stands on was not there when it was built: what it
  /// needs and how to get that. Such a row has neither table nor `create`, and is reported where the type is asked for.
  const char* missing = nullptr;
  /// Joints in spatial models: the marker axis that the key `axis` of the model file stands for. The host turns both
  /// markers so that this axis of theirs is the given one.
  MarkerAxis axis = MarkerAxis::none;
  /// Joints with `space` both: the class for spatial models where it is not the component's own.
  JointFace in_space = {};
  /// Joints with play: the model has these joints instead. The class of the type then only judges the parameters.
  const JointChain* chain = nullptr;
};

/// One row of a plugin's table.
struct Component {
  ComponentKind kind;
  const void* table;  ///< abi::JointTable and so on, by kind
  void (*create)();   ///< abi::create_joint<T> and so on, by kind
  Description description;
};

template <class T>
Component joint(const Description& d) {
  return {ComponentKind::joint, &abi::joint_table<T>, reinterpret_cast<void (*)()>(&abi::create_joint<T>), d};
}
template <class T>
Component contact_law(const Description& d) {
  return {ComponentKind::contact_law, &abi::contact_law_table<T>,
          reinterpret_cast<void (*)()>(&abi::create_contact_law<T>), d};
}
template <class T>
Component friction_law(const Description& d) {
  return {ComponentKind::friction_law, &abi::friction_law_table<T>,
          reinterpret_cast<void (*)()>(&abi::create_friction_law<T>), d};
}
template <class T>
Component integrator(const Description& d) {
  return {ComponentKind::integrator, &abi::integrator_table<T>,
          reinterpret_cast<void (*)()>(&abi::create_integrator<T>), d};
}

inline Component missing_type(ComponentKind kind, const char* name, const char* remedy) {
  return {kind, nullptr, nullptr, {.name = name, .missing = remedy}};
}

/// Sizes of the structs that cross the boundary, in this order. They only ever grow at their end, so that a library
/// built with smaller ones runs in a newer host; the host refuses a library that knows larger ones than itself.
inline constexpr std::uint32_t struct_sizes[] = {
    sizeof(Message),      sizeof(TimeFunction),  sizeof(abi::ParameterTable),   sizeof(ContactPair),
    sizeof(ContactState), sizeof(ContactForce),  sizeof(FrictionState),         sizeof(FrictionForce),
    sizeof(JointLayout),  sizeof(JointInput),    sizeof(ConstraintRows),        sizeof(CoordinateRow),
    sizeof(JointForces),  sizeof(InitialOffset), sizeof(MarkerAccelerations),   sizeof(StateView),
    sizeof(Stage),        sizeof(StageResult),   sizeof(abi::StageSolverTable), sizeof(IntegratorLayout),
    sizeof(Attempt)};
/// Structs that stand in arrays or inside others: their sizes are fixed for an ABI version.
inline constexpr std::uint32_t fixed_sizes[] = {sizeof(Event), sizeof(Channel), sizeof(MarkerKinematics), sizeof(Pose)};

/// Sizes of rows, parameters and the manifest in the first release of this ABI version: no library has smaller ones.
inline constexpr std::uint32_t first_component_size = 128, first_parameter_size = 72, first_manifest_size = 96;
static_assert(sizeof(Component) >= first_component_size && sizeof(Parameter) >= first_parameter_size);

/// Given by the host. A newer host may have a larger struct; fields are only ever appended.
struct Host {
  std::uint32_t size;
  std::uint32_t abi_version;
  const char* fingerprint;
  Span<const std::uint32_t> struct_sizes;
};

/// Filled by the plugin. All pointers are to static storage.
struct Manifest {
  std::uint32_t size;
  std::uint32_t abi_version;
  std::uint32_t component_size, parameter_size;  ///< strides, so that both may grow
  const char* fingerprint;
  const char* compiler;  ///< recorded in results, not compared
  const char* name;
  const char* version;
  Span<const Component> components;
  Span<const std::uint32_t> struct_sizes, fixed_sizes;
};

/// Answers the host. Fails when host and plugin cannot understand each other.
inline Status publish(const Host& host, Manifest& manifest, const char* name, const char* version,
                      Span<const Component> components) noexcept {
  manifest = {sizeof(Manifest), abi_version, sizeof(Component), sizeof(Parameter), abi_fingerprint, __VERSION__, name,
              version,          components,  struct_sizes,      fixed_sizes};
  const bool match = host.abi_version == abi_version && std::strcmp(host.fingerprint, abi_fingerprint) == 0;
  return match ? Status::ok : Status::failed;
}

using PluginEntry = Status (*)(const Host*, Manifest*) noexcept;

}  // namespace freeplay

/// Declares the entry point. A library linked into the executable gets a name of its own,
/// so that built-ins and shared objects pass through the same function type.
#define FREEPLAY_JOIN(a, b) a##b
#if defined(FREEPLAY_STATIC_PLUGIN)
#define FREEPLAY_PLUGIN(library) FREEPLAY_ENTRY(FREEPLAY_JOIN(freeplay_plugin_v1_, library))
#else
#define FREEPLAY_PLUGIN(library) FREEPLAY_ENTRY(freeplay_plugin_v1)
#endif
#define FREEPLAY_ENTRY(symbol)                                                                          \
  extern "C" __attribute__((visibility("default"))) freeplay::Status symbol(const freeplay::Host* host, \
                                                                            freeplay::Manifest* manifest) noexcept
