// ModelText: the expanded model as text for people and as a graph.
#pragma once

#include <string>

#include "base/json_text.h"

namespace freeplay {

/// A tree of bodies with their frames, joints, drivers, forces, start values, steps and output. `model` is what
/// model_json() gives with Quantities::text.
std::string model_tree(const Json& model);

/// Graph of bodies and joints, from either sort of quantities, in the language of Graphviz. Bodies are nodes, joints
/// and forces edges from the first body to the second; gears are edges between the bodies that their joints move.
std::string model_graph(const Json& model);

}  // namespace freeplay
