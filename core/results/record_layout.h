// RecordLayout of a model: names, units and sources of what its files hold.
#pragma once

#include <cstddef>
#include <span>

#include "model/channel.h"
#include "results/record.h"

namespace freeplay {

/// `picked`: indices into Channels::all(). Root attributes are left to the caller. `described`: with phrases and
/// sources of columns, which text files do without.
[[gnu::cold]] RecordLayout record_layout(const Model& model, const Channels& channels,
                                         std::span<const std::size_t> picked, bool described = true);

}  // namespace freeplay
