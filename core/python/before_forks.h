// What a program whose threads use the core needs before it forks.
#pragma once

namespace freeplay {

/// Waits for threads inside of HDF5 at each fork, and makes at once what the core and its libraries otherwise make when
/// it is first needed: a child of a fork would wait for ever for a thread that was making it.
void prepare_for_forks();

}  // namespace freeplay
