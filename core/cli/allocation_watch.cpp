#include "cli/allocation_watch.h"

#include <atomic>
#include <cerrno>
#include <cstddef>

#include "base/address_sanitizer.h"

namespace {

std::atomic<bool> watching{false};
std::atomic<long> count{0};

void count_one() {
  if (watching.load(std::memory_order_relaxed)) count.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

#if FREEPLAY_ADDRESS_SANITIZER

// The sanitizer has replaced the allocator; it reports every allocation.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, std::size_t),
                                                         void (*on_free)(const volatile void*));

void freeplay::watch_allocations() {
  __sanitizer_install_malloc_and_free_hooks([](const volatile void*, std::size_t) { count_one(); },
                                            [](const volatile void*) {});
  watching = true;
}

#else

// The functions of an executable stand before those of the C library for everybody, also for libraries that are opened
// later. These count and pass on to the C library's own, which it exports for the purpose; operator new ends here, too.
// free() is passed on with them, so that an allocator that is put in between gets all or nothing.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

#define FREEPLAY_EXPORTED __attribute__((visibility("default")))

FREEPLAY_EXPORTED void* malloc(std::size_t size) {
  count_one();
  return __libc_malloc(size);
}
FREEPLAY_EXPORTED void* calloc(std::size_t number, std::size_t size) {
  count_one();
  return __libc_calloc(number, size);
}
FREEPLAY_EXPORTED void* realloc(void* memory, std::size_t size) {
  count_one();
  return __libc_realloc(memory, size);
}
FREEPLAY_EXPORTED void* memalign(std::size_t alignment, std::size_t size) {
  count_one();
  return __libc_memalign(alignment, size);
}
FREEPLAY_EXPORTED void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count_one();
  return __libc_memalign(alignment, size);
}
FREEPLAY_EXPORTED int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  const bool power_of_two = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!power_of_two || alignment % sizeof(void*) != 0) return EINVAL;
  count_one();
  void* made = __libc_memalign(alignment, size);
  if (made == nullptr) return ENOMEM;
  *memory = made;
  return 0;
}
FREEPLAY_EXPORTED void free(void* memory) { __libc_free(memory); }
}

void freeplay::watch_allocations() { watching = true; }

#endif

long freeplay::allocations() { return count.load(std::memory_order_relaxed); }
