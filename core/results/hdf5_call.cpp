#include "results/hdf5_call.h"

#include <algorithm>
#include <new>
#include <string_view>

#include <fmt/format.h>
#include <pthread.h>
#include <sys/mman.h>

#include "base/address_sanitizer.h"
#include "results/formats.h"
#include "results/hdf5_forks.h"

#if FREEPLAY_ADDRESS_SANITIZER
// A file that could not be written is never closed, see hdf5_writer.h: what the library keeps for it is no leak.
// NOLINTNEXTLINE(bugprone-reserved-identifier): the name that the sanitizer looks for
extern "C" __attribute__((visibility("default"))) const char* __lsan_default_suppressions();
// NOLINTNEXTLINE(bugprone-reserved-identifier): as above
extern "C" const char* __lsan_default_suppressions() { return "leak:H5MM_xstrdup"; }
#endif

namespace freeplay {
namespace {

std::recursive_mutex& library() {
  static std::recursive_mutex mutex;
  return mutex;
}

// The system's reason stands in the text of the innermost failure; those around it say what was tried.
herr_t note_reason(unsigned, const H5E_error2_t* error, void* result) {
  std::string& reason = *static_cast<std::string*>(result);
  const std::string_view text = error->desc != nullptr ? error->desc : "";
  constexpr std::string_view mark = "error message = '";
  if (const std::size_t at = text.find(mark); at != std::string_view::npos) {
    const std::string_view rest = text.substr(at + mark.size());
    reason = rest.substr(0, rest.find('\''));
  } else if (reason.empty()) {
    reason = text;
  }
  return 0;
}

}  // namespace

Hdf5Lock::Hdf5Lock() : lock_(library()) {
  static const bool ready = [] {
    require_memory_for_hdf5();
    H5dont_atexit();
    return H5open() >= 0;
  }();
  static_cast<void>(ready);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // each thread has its own
}

void renew_hdf5_lock() { new (&library()) std::recursive_mutex; }

void keep_hdf5_whole_at_forks() {
  // The thread of the child has another number, so that it cannot release what it held.
  ::pthread_atfork([] { library().lock(); }, [] { library().unlock(); }, renew_hdf5_lock);
}

void require_memory_for_hdf5(std::size_t more) {
  const std::size_t bytes = (std::size_t{16} << 20) + more;
  void* some = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (some == MAP_FAILED) throw std::bad_alloc();
  ::munmap(some, bytes);
}

void fail_hdf5() {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, note_reason, &reason);
  throw Hdf5Failure(reason.empty() ? "HDF5 says no reason" : reason);
}

std::string hdf5_version() {
  const Hdf5Lock lock;
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

std::string dataset_name(std::string channel) {
  std::ranges::replace(channel, '/', ':');
  return channel;
}

}  // namespace freeplay
