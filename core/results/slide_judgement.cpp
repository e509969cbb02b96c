#include "results/slide_judgement.h"

#include <cmath>

#include <fmt/format.h>

#include "base/index.h"
#include "model/element_name.h"
#include "model/force_element.h"
#include "system/joint_freedom.h"

namespace freeplay {
namespace {

constexpr double far_apart = 10.0;  // centres of mass, in sizes of the model: a telescope of ten tubes has one

double between(const RunRecord& record, BodyId a, BodyId b) {
  const double *one = &record.last_row[at(record.channels.bodies[at(a)])],
               *other = &record.last_row[at(record.channels.bodies[at(b)])];
  const double across = record.model.space == Space::planar ? 0.0 : other[2] - one[2];
  return std::hypot(other[0] - one[0], other[1] - one[1], across);
}

}  // namespace

void judge_slides(const RunRecord& record, Verdict& verdict) {
  const Model& model = record.model;
  const double size = record.extremes.size;
  if (!(size > 0.0) || record.last_row.empty()) return;
  for (const JointElement& joint : model.joints) {
    if (joint.gear >= 0 || is_force_element(joint) || holds_origins(joint, model.space)) continue;
    const BodyId a = model.markers[at(joint.marker_a)].body, b = model.markers[at(joint.marker_b)].body;
    if (a == ground || b == ground) continue;
    const double apart = between(record, a, b);
    if (!(apart > far_apart * size)) continue;
    const std::string name = written_name(joint);
    verdict.add({.id = "out-of-reach",
                 .level = Trust::doubtful,
                 .message = fmt::format("{}: its bodies end {:.3g} m apart in a mechanism of {:.2g} m: nothing holds "
                                        "them along each other; is a joint, a spring or a stop missing",
                                        name, apart, size),
                 .element = name,
                 .value = apart / size,
                 .limit = far_apart});
  }
}

}  // namespace freeplay
