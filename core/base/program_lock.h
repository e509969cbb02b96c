// A lock of the whole program that a child of a fork finds free.
#pragma once

#include <mutex>

#include <pthread.h>

namespace freeplay {

/// One for each `Purpose`. A fork waits for it: otherwise the child would have a lock held by a thread that it has not,
/// for ever. Who holds it may ask for no other such lock.
template <class Purpose>
std::mutex& program_lock() {
  static std::mutex mutex;
  static const int asked =
      ::pthread_atfork([] { program_lock<Purpose>().lock(); }, [] { program_lock<Purpose>().unlock(); },
                       [] { program_lock<Purpose>().unlock(); });
  static_cast<void>(asked);
  return mutex;
}

}  // namespace freeplay
