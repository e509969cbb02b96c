// DocumentJson: what a file says, as one text without its layout.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "format/document.h"

namespace freeplay {

/// The tree below `node` as JSON without blanks, keys in their order, scalars as texts. Keys of `node` itself that are
/// in `without` are left out.
std::string document_json(const Node& node, std::span<const std::string_view> without = {});

}  // namespace freeplay
