// Probe: asks for a negative number of rows.
#include "probe.h"

namespace {
struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void declare(freeplay::JointLayout& layout) const override { layout.constraint_rows = -2; }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "Negative rows."})};
  return publish(*host, *manifest, "probe", "1", components);
}
