#include "run/force_kinks.h"

#include <algorithm>

#include "base/index.h"

namespace freeplay {
namespace {
constexpr double beside_the_ends = 0.02;  // of a step
}

ForceKinks::ForceKinks(RunContext& run) : run_(run) {
  std::size_t most = 0;
  for (int j = 0; j < static_cast<int>(run.model.joints.size()); ++j) {
    const std::int32_t kinks = run.model.joints[at(j)].gear >= 0 ? 0 : run.system.joints().layout(j).kinks;
    if (kinks <= 0) continue;
    joints_.push_back(j);
    most = std::max(most, at(kinks));
  }
  before_.resize(most);
  after_.resize(most);
}

bool ForceKinks::first_inside(double& part, Fault& fault) {
  part = 1.0;
  for (const int j : joints_) {
    const std::size_t count = at(run_.system.joints().layout(j).kinks);
    const auto look = [&](const State& state, const Evaluation& e, std::vector<double>& g) {
      std::fill_n(g.begin(), count, std::numeric_limits<double>::quiet_NaN());
      return run_.system.joints().handle(j).kinks(run_.system.joints().input(j, point(state), e), {g.data(), count},
                                                  fault.message);
    };
    if (!look(run_.accepted, run_.e_accepted, before_) || !look(run_.trial, run_.e_trial, after_)) {
      fault.kind = Fault::Kind::plugin;
      fault.joint = j;
      return false;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!(before_[i] * after_[i] < 0.0)) continue;
      const double root = before_[i] / (before_[i] - after_[i]);
      if (root > beside_the_ends && root < 1.0 - beside_the_ends) part = std::min(part, root);
    }
  }
  return true;
}

}  // namespace freeplay
