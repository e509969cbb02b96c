#include "assembly/model_facts.h"

#include <algorithm>

#include "system/layout.h"

namespace freeplay {

ModelFacts count_facts(const Model& model) {
  ModelFacts facts;
  facts.bodies = static_cast<int>(model.bodies.size());
  facts.joints = static_cast<int>(std::ranges::count(model.joints, false, &JointElement::is_force));
  facts.clearance_joints = model.clearance_joints();
  facts.drivers = static_cast<int>(model.drivers.size());
  const auto count = [&](Variant variant, ConstraintFacts& out) {
    const Layout layout(model, variant);
    facts.coordinates = layout.nq();
    facts.velocities = layout.nv();
    facts.driver_constraints = layout.nc() - layout.first_driver_row();
    out = {layout.first_driver_row(), -1, -1, -1, -1, -1};
  };
  if (facts.clearance_joints > 0) count(Variant::closed, facts.ideal.emplace());
  count(Variant::released, facts.actual);
  return facts;
}

}  // namespace freeplay
