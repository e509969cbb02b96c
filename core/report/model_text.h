// ModelText: the expanded model as text for people and as a graph.
#pragma once

#include <string>

#include "io/json_text.h"

namespace freeplay {

/// A tree of bodies with their frames, joints, drivers, forces and start values, numbers with units. `model` is what
/// model_json() gives.
std::string model_tree(const Json& model);

/// Graph of bodies and joints in the language of Graphviz. Bodies are nodes, joints and forces edges from the first
/// body to the second; gears are edges between the bodies that their joints move.
std::string model_graph(const Json& model);

}  // namespace freeplay
