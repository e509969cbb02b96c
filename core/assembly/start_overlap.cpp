#include "assembly/start_overlap.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/index.h"
#include "component/joint_roles.h"
#include "model/element_name.h"

namespace freeplay {
namespace {

constexpr double deepest = 0.5, doubtful = 0.01;  // by the smaller radius

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

/// Calls found(element, depth, radius) of surfaces without play that start deeper in each other than `share` of it.
template <class Found>
void find_overlaps(const System& system, const State& start, const Evaluation& e, double share, const Found& found) {
  const Model& model = system.model();
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointLayout& layout = system.joints().layout(j);
    const bool touches = layout.constraint_rows == 0 && layout.clearance == 0.0 && layout.smaller_radius > 0.0;
    if (!touches) continue;
    const double depth = start_penetration(system, j, start, e);
    if (depth > share * layout.smaller_radius) found(model.joints[at(j)], depth, layout.smaller_radius);
  }
}

}  // namespace

void refuse_overlap(const System& system, const State& start, const Evaluation& e) {
  find_overlaps(system, start, e, deepest, [](const JointElement& joint, double depth, double radius) {
    throw Error(Error::Category::input, "starts-inside",
                fmt::format("what '{}' lets touch starts {:.4g} m deep in each other, more than half of the smaller "
                            "radius, {:.4g} m",
                            joint.name, depth, radius),
                joint.location, "move one of its bodies away from the other, or turn it");
  });
}

void doubt_overlaps(const System& system, const State& start, const Evaluation& e,
                    const std::function<void(const char* id, const std::string& message, const JointElement&)>& doubt) {
  find_overlaps(system, start, e, doubtful, [&](const JointElement& joint, double depth, double radius) {
    doubt("starts-inside",
          fmt::format("what {} lets touch starts {:.3g} m deep in each other, {:.2g} times the smaller radius, and is "
                      "thrown apart: check 'initial', the poses of its bodies and the sizes of both surfaces",
                      written_name(joint), depth, depth / radius),
          joint);
  });
}

}  // namespace freeplay
