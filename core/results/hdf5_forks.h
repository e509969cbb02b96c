// Forks of a program whose threads write HDF5.
#pragma once

namespace freeplay {

/// From now on a fork waits until no thread is inside the library, so that the child can use it.
void keep_hdf5_whole_at_forks();

}  // namespace freeplay
