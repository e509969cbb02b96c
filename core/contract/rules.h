// Rules: what each rule of the contracts asks, in words for the author of a component.
#pragma once

#include <string_view>

#include "freeplay/plugin.h"

namespace freeplay {

/// What the rule asks of components of this kind, and where to look when it is broken: one or two sentences. Empty for
/// a word that is no rule of the kind.
std::string_view rule_meaning(ComponentKind kind, std::string_view rule);

}  // namespace freeplay
