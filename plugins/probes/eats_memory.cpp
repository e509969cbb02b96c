// Probe: takes memory without end in its constructor.
#include <cstddef>

#include "probe.h"

namespace {
struct Probe : freeplay::probe::Idle {
  explicit Probe(const freeplay::Parameters& p) : Idle(p) {
    for (char* volatile block = nullptr;; block[0] = 1) block = new char[std::size_t{1} << 30];
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "Takes all memory."})};
  return publish(*host, *manifest, "probe", "1", components);
}
