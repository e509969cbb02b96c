// What the rooms and archives take of the C library's data. They are compiled for programs, to which data of other
// libraries is as near as their own, so that each name is one of the extension here.
#include <dlfcn.h>

namespace {

using Stream = void*;

/// What the C library calls by this name.
Stream stream_of(const char* name) {
  const auto* const place = static_cast<const Stream*>(::dlsym(RTLD_NEXT, name));
  return place == nullptr ? nullptr : *place;
}

}  // namespace

extern "C" {
[[gnu::visibility("hidden")]] Stream freeplay_stdout asm("stdout");
[[gnu::visibility("hidden")]] Stream freeplay_stderr asm("stderr");
/// Whether counts of shared objects may do without a lock: never, for the interpreter starts threads as it likes.
[[gnu::visibility("hidden")]] char freeplay_single_threaded asm("__libc_single_threaded") = 0;
}

namespace {

[[gnu::constructor]] void find_streams() {
  freeplay_stdout = stream_of("stdout");
  freeplay_stderr = stream_of("stderr");
}

}  // namespace
