// my-type: a friction law of your own. As it stands, Coulomb friction with a root in place of the jump.
#include <cmath>

#include "freeplay/plugin.h"

namespace {

using namespace freeplay;

// What a model file may say under `friction:`.
constexpr Parameter parameters[] = {
    {.name = "mu", .minimum = 0.0, .summary = "Coefficient of friction."},
    {.name = "vs",
     .unit = "m/s",
     .default_value = 1e-3,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Slip speed at which seven tenths of the friction act."},
};

/// F_T = -mu F_N v / sqrt(v^2 + vs^2), v: slip speed [m/s], F_N: normal force [N]. It opposes the slip.
class MyType final : public FrictionLaw {
 public:
  explicit MyType(const Parameters& p) : mu_(p.number("mu")), vs_(p.number("vs")) {}

  // A law with memory says internal_variables() and fills their rates; this one has none.
  FrictionForce evaluate(const FrictionState& s, Span<double>) const override {
    const double root = std::hypot(s.slip_speed, vs_), share = s.slip_speed / root;
    return {.tangential = -mu_ * s.normal_force * share,
            .d_normal = -mu_ * share,
            .d_slip = -mu_ * s.normal_force * vs_ * vs_ / (root * root * root)};
  }

 private:
  double mu_, vs_;
};

}  // namespace

FREEPLAY_PLUGIN(my_type) {
  static const Component components[] = {
      friction_law<MyType>({.name = "my-type",
                            .summary = "Coulomb friction, smoothed by a root.",
                            .formula = "F_T = -mu F_N v / sqrt(v^2 + vs^2)",
                            .validity = "Sliding; at rest it creeps.",
                            .parameters = parameters}),
  };
  return publish(*host, *manifest, "my_type", "0.1.0", components);
}
