// ShortLinks: links that are shorter than the play in which they turn.
#pragma once

#include <functional>
#include <string>

#include "model/model.h"

namespace freeplay {

/// `doubtful-clearance`: of a body that only two pins hold, nearer to each other than the clearance of one of them.
[[gnu::cold]] void doubt_short_links(
    const Model& model,
    const std::function<void(const char* id, const std::string& message, const JointElement&)>& doubt);

}  // namespace freeplay
