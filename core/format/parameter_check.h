// ParameterCheck: a block of the model file against a component's parameter table.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "component/instances.h"
#include "component/registry.h"
#include "format/map_reader.h"
#include "format/motion_parameters.h"

namespace freeplay {

struct Draft;

/// A number in a file with a table.
struct FieldPlace {
  Location location;
  int length;  ///< in characters
};

/// What the file says about a component.
struct CheckedParameters {
  std::optional<ParameterBlock> block;         ///< nothing when something in it was in error
  std::map<std::string, CheckedValue> places;  ///< values and blocks that are written, by their path in the table
  std::map<std::string, FieldPlace> fields;    ///< the same for numbers that a file beside the model has
};

/// Reads the keys of `entry` that the table of `component` names and makes them known to it; the caller finishes the
/// entry. Maps within it are finished here. Files that they name become inputs of the model. With `motion` some may
/// depend on the motion.
CheckedParameters check_parameters(const Component& component, MapReader& entry, Draft& draft,
                                   MotionParameters* motion = nullptr);

/// The type `word` of this kind, or null after `unknown-type` at `value`, which may suggest one of `others` too.
const Component* find_type(const Registry& registry, ComponentKind kind, const CheckedValue& value,
                           const std::vector<std::string>& others = {});

/// The type that an unknown word probably means, so that the keys beside it can be judged; null when there is none.
const Component* meant_type(const Registry& registry, ComponentKind kind, const CheckedValue& value,
                            const std::vector<std::string>& others = {});

/// Reports a constructor's complaint at the place in `entry` that it names. Throws Error{plugin} when the constructor
/// failed for another reason.
void report_fault(const CreationFault& fault, const CheckedParameters& parameters, const CheckedValue& entry);

}  // namespace freeplay
