// PathEdges: where paths come so close to the edge of what the mechanism reaches that hardly anything is known of it.
#pragma once

#include <vector>

#include "run/trust.h"
#include "system/system.h"

namespace freeplay {

class PathEdges {
 public:
  [[gnu::cold]] explicit PathEdges(const System& system);

  /// The longest step from t on that resolves how fast drivers move beside such a place [s].
  double longest_step(double t, double dt) const {
    for (const PathEdge& edge : edges_) dt = step_beside(edge, t, dt);
    return dt;
  }
  /// Of a run from its start to `until`; `step`: of steps of one size, else 0 [s].
  [[gnu::cold]] std::vector<TrustReason> doubts(double until, double step) const;

 private:
  static double step_beside(const PathEdge& edge, double t, double dt);
  const System& system_;
  std::vector<PathEdge> edges_;
};

}  // namespace freeplay
