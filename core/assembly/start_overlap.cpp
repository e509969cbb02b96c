#include "assembly/start_overlap.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/index.h"
#include "component/joint_roles.h"

namespace freeplay {
namespace {

constexpr double deepest = 0.5;  // by the smaller radius

/// The penetration at the start; NaN where the joint tells none.
double start_penetration(const System& system, int joint, const State& start, const Evaluation& e) {
  const JointLayout& layout = system.joints().layout(joint);
  std::vector<double> channels(layout.channels.size);
  Message message;
  const double none = std::numeric_limits<double>::quiet_NaN();
  if (!system.joints().handle(joint).observe(system.joints().input(joint, point(start), e), {},
                                             {channels.data(), channels.size()}, message))
    return none;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channel_role(layout, i) == ChannelRole::penetration) return channels[i];
  }
  return none;
}

}  // namespace

void refuse_overlap(const System& system, const State& start, const Evaluation& e) {
  const Model& model = system.model();
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointLayout& layout = system.joints().layout(j);
    const bool touches = layout.constraint_rows == 0 && layout.clearance == 0.0 && layout.smaller_radius > 0.0;
    if (!touches) continue;
    const double depth = start_penetration(system, j, start, e);
    if (!(depth > deepest * layout.smaller_radius)) continue;
    const JointElement& joint = model.joints[at(j)];
    throw Error(Error::Category::input, "starts-inside",
                fmt::format("what '{}' lets touch starts {:.4g} m deep in each other, more than half of the smaller "
                            "radius, {:.4g} m",
                            joint.name, depth, layout.smaller_radius),
                joint.location, "move one of its bodies away from the other, or turn it");
  }
}

}  // namespace freeplay
