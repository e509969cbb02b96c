// A joint whose force comes and goes in the period that it declares, but only where its bodies move.
#include <cmath>

#include "freeplay/plugin.h"

namespace {

using namespace freeplay;

constexpr Parameter parameters[] = {
    {.name = "drag", .unit = "N*s/m", .minimum = 0.0, .summary = "Force by speed along x at the crest of a ripple."},
    {.name = "period", .unit = "s", .minimum = 0.0, .open = Open::minimum, .summary = "Of the ripple."}};

class RipplePush final : public Joint {
 public:
  explicit RipplePush(const Parameters& p) : drag_(p.number("drag")), period_(p.number("period")) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = 0.25 * period_;
    layout.forces = 1;
  }

  void apply(const JointInput& in, JointForces& out) const override {
    const double speed = in.b->velocity[0] - in.a->velocity[0];
    const double ripple = std::sin(6.283185307179586 * in.t / period_);
    out.wrench_b[0] = -drag_ * ripple * ripple * speed;
    out.wrench_a[0] = -out.wrench_b[0];
  }

 private:
  double drag_, period_;
};

}  // namespace

FREEPLAY_PLUGIN(ripple_push) {
  static const Component components[] = {joint<RipplePush>({.name = "ripple-push",
                                                            .space = Space::planar,
                                                            .summary = "Drag that comes and goes.",
                                                            .formula = "force = -drag sin(2 pi t/period)^2 speed",
                                                            .parameters = parameters})};
  return publish(*host, *manifest, "ripple_push", "1.0.0", components);
}
