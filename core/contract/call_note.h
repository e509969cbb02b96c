// CallNote: which function of a component is being called. Plain memory that a second process can read after a crash.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace freeplay {

/// Written by the suites, one at a time. Texts end with a zero and are cut to what fits.
struct CallNote {
  char function[32] = "";                ///< called now or last; "" before the first call
  char circumstances[128] = "";          ///< which parameters, in the plane or in space
  std::atomic<std::uint32_t> inside{0};  ///< nonzero during the call
  std::atomic<std::uint64_t> calls{0};   ///< so far; one that does not change shows a call that does not return

  void enter(const char* name) noexcept {
    write(function, sizeof function, name);
    calls.fetch_add(1, std::memory_order_relaxed);
    inside.store(1, std::memory_order_release);
  }
  void leave() noexcept { inside.store(0, std::memory_order_release); }
  void say(std::string_view words) noexcept { write(circumstances, sizeof circumstances, words); }

 private:
  static void write(char* to, std::size_t capacity, std::string_view text) noexcept {
    const std::size_t length = text.size() < capacity ? text.size() : capacity - 1;
    std::memcpy(to, text.data(), length);
    to[length] = '\0';
  }
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<std::uint32_t>::is_always_lock_free);

}  // namespace freeplay
