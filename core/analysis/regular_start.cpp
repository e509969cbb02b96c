#include "analysis/regular_start.h"

#include <vector>

#include "assembly/leg_modes.h"
#include "base/error.h"

namespace freeplay {

Posture regular_start(IdealMechanism& mechanism, const Components& given) {
  const Platform& platform = mechanism.platform();
  Posture start = mechanism.start();
  for (std::size_t i = 0; platform.elbow_given && i < platform.inputs.size(); ++i) {
    bend_leg(mechanism.model(), platform.inputs[i], platform.marker, platform.elbow[i], start.q);
  }
  PostureSolver solver(mechanism);
  std::vector<double> v, a;
  const auto is_regular = [&](const Posture& posture) {
    Demand demand;
    demand.t = mechanism.model().settings.start;
    demand.given = given;
    const FramePose here = solver.frame(posture);
    for (std::size_t i = 0; i < here.size(); ++i) demand.pose[i] = Jet::constant(here[i]);
    return solver.rates(demand, posture, v, a);
  };
  if (is_regular(start)) return start;
  const std::vector<double> inputs = solver.inputs(start);
  for (const double share : {0.3, 0.1, 0.03}) {
    Demand turned;
    turned.t = mechanism.model().settings.start;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const double unit = mechanism.is_angle(static_cast<int>(i)) ? 1.0 : mechanism.system().size();
      turned.inputs.push_back(Jet::constant(inputs[i] + platform.elbow[i] * share * unit));
    }
    Posture posture;
    Unreachable why;
    if (solver.reach(turned, start, posture, why) && is_regular(posture)) return posture;
  }
  return start;
}

void close_joints(const IdealMechanism& mechanism, double t, Posture& posture) {
  PostureSolver solver(mechanism);
  Demand demand;
  demand.t = t;
  if (solver.settle(demand, posture)) return;
  throw Error(Error::Category::input, "assembly-failed",
              "the mechanism cannot be put together with its clearances closed", mechanism.platform().location);
}

}  // namespace freeplay
