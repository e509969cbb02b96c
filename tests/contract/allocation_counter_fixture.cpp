#include <atomic>
#include <cstdlib>
#include <new>

#include "allocation_counter.h"

namespace {
std::atomic<long> count{0};

void* counted(std::size_t size, const std::nothrow_t&) {
  ++count;
  return std::malloc(size);
}
void* counted(std::size_t size) {
  if (void* memory = counted(size, std::nothrow)) return memory;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void* operator new(std::size_t size, const std::nothrow_t& silent) noexcept { return counted(size, silent); }
void* operator new[](std::size_t size, const std::nothrow_t& silent) noexcept { return counted(size, silent); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }

namespace freeplay::test {
long allocations() { return count; }
}  // namespace freeplay::test
