#include "contract/sample_layout.h"

#include "contract/sample_parameters.h"

namespace freeplay {

std::optional<SampleJoint> sample_joint(const Component& type, const Registry& registry) {
  return sample_joint(type, registry, type.description.space == Space::spatial ? Space::spatial : Space::planar);
}

std::optional<SampleJoint> sample_joint(const Component& type, const Registry& registry, Space space) {
  const ParameterSamples samples = sample_parameters(type, registry, {}, space);
  if (samples.accepted.empty()) return std::nullopt;
  SampleJoint sample;
  CreationFault fault;
  Message message;
  sample.joint = sample.instances.create_joint(*samples.accepted.front().block, space, fault);
  sample.layout.space = space;
  if (!sample.joint || !sample.joint.declare(sample.layout, message)) return std::nullopt;
  return sample;
}

std::vector<std::string> force_types(const Registry& registry) {
  std::vector<std::string> names;
  for (const RegisteredComponent& entry : registry.components()) {
    const Component& type = *entry.component;
    if (type.kind != ComponentKind::joint || type.description.ideal != nullptr) continue;
    const std::optional<SampleJoint> sample = sample_joint(type, registry);
    if (sample && sample->layout.constraint_rows == 0) names.emplace_back(type.description.name);
  }
  return names;
}

}  // namespace freeplay
