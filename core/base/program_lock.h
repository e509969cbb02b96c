// A lock of the whole program that a child of a fork finds free.
#pragma once

#include <mutex>

#include <pthread.h>

namespace freeplay {

/// One for each `Purpose`. A fork waits for it: otherwise the child would have a lock held by a thread that it has not,
/// for ever. Who holds it may ask for no other such lock. Forks know of it from the start of the program: a thread that
/// announced it at its first use would wait for a fork under way, and the child for that thread.
template <class Purpose>
class ProgramLock {
 public:
  static std::mutex& get() {
    static_cast<void>(known_);
    return mutex_;
  }

 private:
  static inline std::mutex mutex_;
  static inline const int known_ =
      ::pthread_atfork([] { mutex_.lock(); }, [] { mutex_.unlock(); }, [] { mutex_.unlock(); });
};

}  // namespace freeplay
