// SampleLayout: what a joint type declares, seen without a model.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "component/instances.h"
#include "component/registry.h"

namespace freeplay {

/// A joint made from the first sample of parameters that its constructor accepts, and its layout; what a joint declares
/// may depend on its parameters.
struct SampleJoint {
  Instances instances;  ///< owns the joint
  JointRef joint;
  JointLayout layout;
};

/// For a space that the type serves; nothing if it refuses all samples. `type` is a joint of the registry.
std::optional<SampleJoint> sample_joint(const Component& type, const Registry& registry, Space space);
/// For the plane, or for space where it works there only.
std::optional<SampleJoint> sample_joint(const Component& type, const Registry& registry);

/// Names of the joint types that may stand under `forces`: those that have neither rows nor an ideal twin.
std::vector<std::string> force_types(const Registry& registry);

}  // namespace freeplay
