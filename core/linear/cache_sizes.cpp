#include "linear/cache_sizes.h"

#include <Eigen/Core>

namespace freeplay {

void learn_cache_sizes() { static_cast<void>(Eigen::l1CacheSize()); }

}  // namespace freeplay
