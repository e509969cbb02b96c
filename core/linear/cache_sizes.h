// Sizes of the processor's caches, by which products of large matrices are divided.
#pragma once

namespace freeplay {

/// Asks the processor at once: otherwise the first large product does, and who forks meanwhile has a child that waits
/// for the answer for ever.
void learn_cache_sizes();

}  // namespace freeplay
