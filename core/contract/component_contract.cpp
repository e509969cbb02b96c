#include "contract/component_contract.h"

#include <cstring>

#include "component/instances.h"
#include "contract/description_contract.h"
#include "contract/integrator_contract.h"
#include "contract/joint_contract.h"
#include "contract/law_contract.h"
#include "contract/sample_parameters.h"

namespace freeplay {
namespace {

bool has_functions(const ParameterBlock& block) {
  for (const Parameter& p : block.component->description.parameters) {
    if (p.kind == ParameterKind::function) return true;
  }
  return false;
}

Findings check_joint_sample(const ParameterBlock& block, const Conditions& conditions) {
  Findings findings;
  Instances instances;
  CreationFault fault;
  const JointRef joint = instances.create_joint(block, fault), twin = instances.create_joint(block, fault);
  for (const Space space : {Space::planar, Space::spatial}) {
    const auto bits = static_cast<std::uint32_t>(block.component->description.space);
    if ((bits & static_cast<std::uint32_t>(space)) == 0) continue;
    JointLayout layout;
    layout.space = space;
    Message message;
    if (joint.declare(layout, message)) findings.merge(check_joint_names({layout.events, layout.channels}), "");
    findings.merge(check_joint({joint, twin, space, !has_functions(block)}, conditions),
                   space == Space::planar ? "in the plane" : "in space");
  }
  return findings;
}

Findings check_sample(const ParameterBlock& block, const Conditions& conditions) {
  Instances instances;
  CreationFault fault;
  const Description& description = block.component->description;
  switch (block.component->kind) {
    case ComponentKind::joint:
      return check_joint_sample(block, conditions);
    case ComponentKind::contact_law: {
      const ContactPair pair = sample_contact_pair();
      const bool may_jump = description.validity != nullptr && std::strstr(description.validity, "jump") != nullptr;
      return check_contact_law({instances.create_contact_law(block, pair, fault),
                                instances.create_contact_law(block, pair, fault), pair.radial_clearance, may_jump},
                               conditions);
    }
    case ComponentKind::friction_law:
      return check_friction_law(
          {instances.create_friction_law(block, fault), instances.create_friction_law(block, fault)}, conditions);
    case ComponentKind::integrator:
      return check_integrator({instances.create_integrator(block, fault), instances.create_integrator(block, fault)},
                              conditions);
  }
  return {};
}

}  // namespace

Findings check_component(const Component& component, const Registry& registry, const Conditions& conditions) {
  Findings findings = check_description(component);
  // A table that contradicts itself has no valid parameters.
  if (!findings.held()) return findings;
  const ParameterSamples samples = sample_parameters(component, registry);
  findings.expect("accepts-parameters", !samples.accepted.empty(), [&] { return samples.refusal; });
  for (const ParameterSample& sample : samples.accepted) {
    findings.merge(check_sample(*sample.block, conditions), sample.name);
  }
  return findings;
}

}  // namespace freeplay
