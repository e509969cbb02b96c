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
  return friction_law<NoFriction>(
      {.name = "none",
       .summary = "No friction.",
       .formula = "F_T = 0.",
       .validity = "Surfaces whose friction is small against inertia and load, or a first look.",
       .references = "The limit mu = 0 of Coulomb's law; Johnson 1985, Contact Mechanics, Cambridge University Press, "
                     "ch. 4 (contact without friction)",
       .preferred = 1});
}

}  // namespace freeplay
