// SampleParameters: blocks of parameters that a component accepts, made from its table alone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "component/parameter_block.h"
#include "component/registry.h"
#include "contract/conditions.h"

namespace freeplay {

struct ParameterSample {
  std::string name;  ///< what is special about it: "as few as possible", "choice of 'split'"
  std::shared_ptr<const ParameterBlock> block;
  bool other_laws = false;  ///< differs from an earlier sample by a law alone, which has a contract of its own
};

struct ParameterSamples {
  std::vector<ParameterSample> accepted;  ///< empty: the constructor refused whatever was tried
  std::string refusal;                    ///< what the constructor said to the first block that was tried
};

/// A steel journal in a bearing with everything known: what laws are made for when no joint asks.
ContactPair sample_contact_pair();

/// Blocks that the constructor accepts: as few parameters as it needs, as many as it takes, each word of a choice, the
/// ends of the ranges, and each law of the registry where a law is asked for. Numbers are of a size usual for their
/// unit and stay within their bounds; optional ones are added one by one and in pairs until the constructor is content.
/// With as many as possible, numbers that have a default take another value, and in one more block choices, too. A law
/// may ask for a law, but never for itself, and the third within each other asks for none. `space`: of joints, planar
/// or spatial.
ParameterSamples sample_parameters(const Component& component, const Registry& registry,
                                   const Conditions& conditions = {}, Space space = Space::planar);

}  // namespace freeplay
