#include "system/evaluation.h"

#include <cstring>

#include "base/index.h"
#include "system/system.h"

namespace freeplay {
namespace {

bool same(std::span<const double> a, std::span<const double> b) {
  return b.empty() || std::memcmp(a.data(), b.data(), b.size_bytes()) == 0;
}

}  // namespace

Evaluation::Evaluation(const System& system, EvaluationContext* own_context)
    : MarkerValues(system.markers()),
      JointValues(system.model().joints.size()),
      DriverValues(system.model().drivers.size()),
      DrivenValues(system.driven().count()),
      ConstraintValues(system.constraints()),
      ForceValues(system.forces(), system.model()),
      context(own_context),
      z(at(system.layout().nz())),
      h(at(system.layout().nh())) {
  system.joints().write_constants(*this);
}

bool Evaluation::has_rows_at(const Point& point) const {
  return (filled & term_position) != 0 && time == point.t && same(q, point.q);
}

bool Evaluation::is_at(const Point& point, unsigned terms) const {
  return (terms & ~filled) == 0 && time == point.t && same(q, point.q) && same(v, point.v) &&
         same(z, point.z.first(z.size())) && same(h, point.h);
}

}  // namespace freeplay
