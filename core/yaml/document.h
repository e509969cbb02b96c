// YamlDocument: reads a YAML file into a Document with exact places.
#pragma once

#include <optional>
#include <string>

#include "base/diagnostics.h"
#include "format/document.h"

namespace freeplay {

/// Reads the text of a model file: UTF-8, one document, at most 16 MiB, 64 levels and 1 000 000 nodes after aliases are
/// expanded. Reports `too-large`, `yaml-syntax`, `yaml-feature`, `duplicate-key`, and `wrong-type` for a list or map as
/// key; makes the text known to `diagnostics`. Nothing is returned if the text cannot be trusted as a tree; after a
/// duplicate key (the first one counts) or a key of the wrong type (left out) the rest is returned. An empty file is a
/// null node at 1:1. `file_name` is for messages only.
std::optional<Document> parse_yaml(std::string text, const std::string& file_name, Diagnostics& diagnostics);

}  // namespace freeplay
