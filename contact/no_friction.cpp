#include "freeplay/plugin.h"

namespace freeplay {
namespace {

/// Smooth surfaces: F_T = 0.
class NoFriction final : public FrictionLaw {
 public:
  explicit NoFriction(const Parameters&) {}
  FrictionForce evaluate(const FrictionState&, Span<double>) const override { return {}; }
};

}  // namespace

Component no_friction() {
  return friction_law<NoFriction>({.name = "none", .summary = "No friction.", .formula = "F_T = 0.", .preferred = 1});
}

}  // namespace freeplay
