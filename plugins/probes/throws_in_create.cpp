// Probe: its constructor throws.
#include <stdexcept>

#include "probe.h"

namespace {
struct Throws : freeplay::probe::Idle {
  explicit Throws(const freeplay::Parameters& p) : Idle(p) { throw std::runtime_error("no such luck"); }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Throws>({.name = "probe", .summary = "Throws when made."})};
  return publish(*host, *manifest, "probe", "1", components);
}
