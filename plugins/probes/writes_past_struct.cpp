// Probe: fills an array inside a struct beyond its end.
#include "probe.h"

namespace {
struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void declare(freeplay::JointLayout& layout) const override { layout.coordinate = freeplay::Coordinate::position; }
  void coordinate(const freeplay::JointInput& in, freeplay::CoordinateRow& out) const override {
    // Through memory that the compiler cannot see to be too short.
    double* volatile row = out.jacobian;
    for (int i = 0; i < 3; ++i) row[12 + i] = in.b->position[i];
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "Writes past the end of a row."})};
  return publish(*host, *manifest, "probe", "1", components);
}
