#include "run/impact_maxima.h"

#include <algorithm>

#include "base/index.h"
#include "component/joint_roles.h"

namespace freeplay {

ImpactMaxima::ImpactMaxima(const Joints& joints, const Channels& channels) {
  for (int j = 0; j < joints.count(); ++j) {
    const JointLayout& layout = joints.layout(j);
    const JointColumns& columns = channels.joints[at(j)];
    if (columns.normal_force < 0 || contact_count(layout) != 1) continue;
    OfJoint& joint = joints_.emplace_back();
    joint.joint = j;
    joint.columns = {columns.normal_force, columns.penetration};
    for (std::size_t i = 0; i < layout.events.size; ++i) {
      const EventRole role = event_role(layout, i);
      const Event& event = layout.events[i];
      joint.kinds.push_back({role == EventRole::contact_begin,
                             role == EventRole::contact_end,
                             {field_index(event, "max_fn"), field_index(event, "max_delta")}});
    }
  }
}

void ImpactMaxima::see(std::span<const double> row) {
  for (OfJoint& joint : joints_) {
    for (std::size_t q = 0; q < joint.columns.size(); ++q) {
      if (joint.columns[q] >= 0) joint.largest[q] = std::max(joint.largest[q], row[at(joint.columns[q])]);
    }
  }
}

void ImpactMaxima::raise(StepEvents& events) {
  for (const StepEvents::Happening& happening : events.happenings()) {
    const auto found = std::ranges::find(joints_, happening.joint, &OfJoint::joint);
    if (found == joints_.end()) continue;
    const EventKind& kind = found->kinds[at(happening.event)];
    if (!kind.begins && !kind.ends) continue;
    const std::span<double> fields = events.fields(happening);
    for (std::size_t q = 0; kind.ends && q < kind.fields.size(); ++q) {
      if (kind.fields[q] < 0) continue;
      double& field = fields[at(kind.fields[q])];
      field = std::max(field, found->largest[q]);  // NaN, which is not known, stays
    }
    found->largest = {};
  }
}

}  // namespace freeplay
