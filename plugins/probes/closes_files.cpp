// Probe: closes the files of the program.
#include <unistd.h>

#include "probe.h"

namespace {
struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void apply(const freeplay::JointInput&, freeplay::JointForces&) const override {
    for (int file = 0; file < 100; ++file) ::close(file);
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "Closes files."})};
  return publish(*host, *manifest, "probe", "1", components);
}
