// Probe: takes some seconds without using the processor, as everything does on a busy machine.
#include <chrono>
#include <thread>

#include "probe.h"

namespace {
struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void apply(const freeplay::JointInput&, freeplay::JointForces&) const override {
    static int calls = 0;
    if (++calls <= 500) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "Waits."})};
  return publish(*host, *manifest, "probe", "1", components);
}
