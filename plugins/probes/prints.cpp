// Probe: chatters on stdout and stderr.
#include <cstdio>

#include "probe.h"

namespace {
struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void apply(const freeplay::JointInput&, freeplay::JointForces&) const override {
    std::printf("{\"chatter\": 1}\n");
    std::fprintf(stderr, "chatter\n");
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "Prints."})};
  return publish(*host, *manifest, "probe", "1", components);
}
