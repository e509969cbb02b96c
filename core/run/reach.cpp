#include "run/reach.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "base/index.h"
#include "system/joint_freedom.h"

namespace freeplay {
namespace {

double distance(const Vector3& a, const Vector3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// How far the origins of a joint with play can stand apart while one surface is still within the other [m].
double allowance(const JointLayout& layout) {
  constexpr double without_radius = 10.0;  // of the clearance
  return layout.smaller_radius > 0.0 ? layout.clearance + layout.smaller_radius : without_radius * layout.clearance;
}

}  // namespace

std::vector<double> reach(const Model& model) {
  // By marker: bound of its distance from the origin.
  std::vector<double> bound(model.markers.size(), unbounded);
  for (std::size_t m = 0; m < model.markers.size(); ++m) {
    if (model.markers[m].body == ground) bound[m] = distance(model.markers[m].position, {});
  }
  const auto index = [](BodyId body) { return at(body + 1); };  // the ground first
  std::vector<std::vector<std::size_t>> on_body(model.bodies.size() + 1);
  for (std::size_t m = 0; m < model.markers.size(); ++m) on_body[index(model.markers[m].body)].push_back(m);
  std::vector<std::vector<const JointElement*>> holding(model.bodies.size() + 1);  // by body
  for (const JointElement& joint : model.joints) {
    if (!holds_origins(joint, model.space)) continue;
    for (const int marker : {joint.marker_a, joint.marker_b})
      holding[index(model.markers[at(marker)].body)].push_back(&joint);
  }
  std::deque<BodyId> due{ground};
  for (; !due.empty(); due.pop_front()) {
    for (const JointElement* joint : holding[index(due.front())]) {
      for (const auto& [from, to] :
           {std::pair(at(joint->marker_a), at(joint->marker_b)), std::pair(at(joint->marker_b), at(joint->marker_a))}) {
        const double farthest = bound[from] + allowance(joint->layout);
        const BodyId body = model.markers[to].body;
        if (body == ground || !(farthest < bound[to])) continue;
        for (const std::size_t other : on_body[index(body)]) {
          const double way = distance(model.markers[to].position, model.markers[other].position);
          bound[other] = std::min(bound[other], farthest + way);
        }
        due.push_back(body);
      }
    }
  }
  std::vector<double> of_bodies(model.bodies.size(), unbounded);
  for (std::size_t b = 0; b < of_bodies.size(); ++b) {
    for (const std::size_t m : on_body[b + 1]) {
      of_bodies[b] = std::min(of_bodies[b], bound[m] + distance(model.markers[m].position, model.bodies[b].com));
    }
  }
  return of_bodies;
}

}  // namespace freeplay
