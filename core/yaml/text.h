// YamlText: a document as YAML for people.
#pragma once

#include <string>

#include "format/document.h"

namespace freeplay {

/// The tree below `root`, a map: sections and their entries on lines of their own, what fits on a line in braces and
/// brackets. Reads back to the same tree. Empty maps below the root are left out.
std::string yaml_text(const Node& root);

/// The text of a scalar, in quotes where YAML would read it differently.
std::string yaml_scalar(const std::string& text);

/// The tree on one line, in braces and brackets.
std::string yaml_flow(const Node& node);

}  // namespace freeplay
