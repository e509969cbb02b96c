// Processors: how much a command may do at once.
#pragma once

namespace freeplay {

/// FREEPLAY_THREADS, else the processors that this process may use by its affinity and the quotas of its groups; from 1
/// to 256.
int processor_count();

}  // namespace freeplay
