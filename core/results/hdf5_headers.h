// Hdf5Headers: what HDF5 keeps in memory of a file that others may read while it is written.
#pragma once

#include "results/hdf5_call.h"

namespace freeplay {

/// Headers of datasets and lists of their chunks stay in memory: HDF5 1.10 fails where it takes them out of its cache
/// in a file that others read meanwhile, which some 130 loose links came to.
inline void keep_headers(hid_t access) {
  H5AC_cache_config_t cache{};
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  checked(H5Pget_mdc_config(access, &cache));
  cache.incr_mode = H5C_incr__off;
  cache.flash_incr_mode = H5C_flash_incr__off;
  cache.decr_mode = H5C_decr__off;
  cache.evictions_enabled = false;
  checked(H5Pset_mdc_config(access, &cache));
}

}  // namespace freeplay
