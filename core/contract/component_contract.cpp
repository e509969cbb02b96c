#include "contract/component_contract.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "component/instances.h"
#include "contract/description_contract.h"
#include "contract/integrator_contract.h"
#include "contract/joint_contract.h"
#include "contract/law_contract.h"
#include "contract/parameter_words.h"
#include "contract/sample_parameters.h"

namespace freeplay {
namespace {

bool has_functions(const ParameterBlock& block) {
  for (const Parameter& p : block.component->description.parameters) {
    if (p.kind == ParameterKind::function) return true;
  }
  return false;
}

/// Does a contact law, or one that it is made from, say that a damped contact begins with a jump?
bool may_jump(const ParameterBlock& block) {
  const char* validity = block.component->description.validity;
  if (validity != nullptr && std::strstr(validity, "jump") != nullptr) return true;
  return std::ranges::any_of(block.values,
                             [](const auto& entry) { return entry.second.law && may_jump(*entry.second.law); });
}

/// Notes the end of a component's objects, too.
class Subjects {
 public:
  explicit Subjects(const Conditions& conditions) : conditions_(conditions) {}
  ~Subjects() {
    WatchedCall watched(conditions_, "its destructor");
    instances_ = Instances();
    watched.end();
  }
  Subjects(const Subjects&) = delete;
  Subjects& operator=(const Subjects&) = delete;

  /// `make(instances, fault)` with the constructor noted.
  template <class Make>
  auto make(Make&& make_one) {
    CreationFault fault;
    WatchedCall watched(conditions_, "its constructor");
    auto made = make_one(instances_, fault);
    watched.end();
    return made;
  }

 private:
  const Conditions& conditions_;
  Instances instances_;
};

void say(const Conditions& conditions, const std::string& words) {
  if (conditions.note != nullptr) conditions.note->say(words);
}

/// "as few as possible (gap = 0.01 m)": in front of what was found with these parameters.
std::string case_words(const ParameterSample& sample) {
  const std::string values = words_of(*sample.block);
  return values.empty() ? sample.name : fmt::format("{} ({})", sample.name, values);
}

Findings check_joint_sample(const ParameterSample& sample, Space space, const Conditions& conditions) {
  const ParameterBlock& block = *sample.block;
  Findings findings;
  Subjects subjects(conditions);
  const auto make = [&](Instances& instances, CreationFault& fault) {
    return instances.create_joint(block, space, fault);
  };
  const JointRef joint = subjects.make(make), twin = subjects.make(make);
  JointLayout layout;
  layout.space = space;
  Message message;
  WatchedCall watched(conditions, "declare");
  const bool declared = joint.declare(layout, message);
  watched.end();
  if (declared) findings.merge(check_joint_names(layout), "");
  findings.merge(check_joint({joint, twin, space, !has_functions(block), !sample.other_laws}, conditions), "");
  return findings;
}

/// A joint is looked at in each space that it works in: it may be of another class there.
void check_joint_type(const Component& component, const Registry& registry, const Conditions& conditions,
                      Findings& findings) {
  for (const Space space : {Space::planar, Space::spatial}) {
    const auto bits = static_cast<std::uint32_t>(component.description.space);
    if ((bits & static_cast<std::uint32_t>(space)) == 0) continue;
    const std::string where = space == Space::planar ? "in the plane" : "in space";
    const ParameterSamples samples = sample_parameters(component, registry, conditions, space);
    findings.expect("accepts-parameters", !samples.accepted.empty(), [&] { return where + ": " + samples.refusal; });
    for (const ParameterSample& sample : samples.accepted) {
      if (sample.other_laws && !conditions.other_laws) continue;
      say(conditions, fmt::format("{}, {}", sample.name, where));
      findings.merge(check_joint_sample(sample, space, conditions), fmt::format("{}: {}", case_words(sample), where));
    }
  }
}

Findings check_sample(const ParameterSample& sample, const Conditions& conditions) {
  const ParameterBlock& block = *sample.block;
  say(conditions, sample.name);
  Subjects subjects(conditions);
  switch (block.component->kind) {
    case ComponentKind::joint:
      break;
    case ComponentKind::contact_law: {
      const ContactPair pair = sample_contact_pair();
      const auto make = [&](Instances& instances, CreationFault& fault) {
        return instances.create_contact_law(block, pair, fault);
      };
      return check_contact_law({subjects.make(make), subjects.make(make), pair.radial_clearance, may_jump(block)},
                               conditions);
    }
    case ComponentKind::friction_law: {
      const auto make = [&](Instances& instances, CreationFault& fault) {
        return instances.create_friction_law(block, fault);
      };
      return check_friction_law({subjects.make(make), subjects.make(make)}, conditions);
    }
    case ComponentKind::integrator: {
      const auto make = [&](Instances& instances, CreationFault& fault) {
        return instances.create_integrator(block, fault);
      };
      return check_integrator({subjects.make(make), subjects.make(make)}, conditions);
    }
  }
  return Findings();
}

}  // namespace

Findings check_component(const Component& component, const Registry& registry, const Conditions& conditions) {
  Findings findings(conditions.found);
  findings.merge(check_description(component), "");
  // A table that contradicts itself has no valid parameters.
  if (!findings.held()) return findings;
  if (component.kind == ComponentKind::joint) {
    check_joint_type(component, registry, conditions, findings);
    return findings;
  }
  const ParameterSamples samples = sample_parameters(component, registry, conditions);
  findings.expect("accepts-parameters", !samples.accepted.empty(), [&] { return samples.refusal; });
  for (const ParameterSample& sample : samples.accepted) {
    findings.merge(check_sample(sample, conditions), case_words(sample));
  }
  return findings;
}

}  // namespace freeplay
