// Formats: what the results of a run are written as.
#pragma once

#include <string>

namespace freeplay {

/// Version of the HDF5 library, such as 1.10.8.
std::string hdf5_version();

}  // namespace freeplay
