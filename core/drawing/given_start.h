// GivenStart: bodies that do not stand where the file gives their poses, for those who draw a start.
#pragma once

#include <span>
#include <vector>

#include "assembly/given_poses.h"

namespace freeplay {

class GivenStart {
 public:
  /// `q`: where bodies stand.
  GivenStart(const System& system, std::span<const double> q) : q_(q.begin(), q.end()) {
    const GivenPoses poses(system);
    for (BodyId b = 0; b < static_cast<BodyId>(system.model().bodies.size()); ++b) {
      if (poses.shift(b, q) > noticed * system.size() || poses.turn(b, q) > noticed) moved_.push_back(b);
    }
    poses.put_as_given(q_);
  }

  /// Coordinates with every body where the file gives its pose.
  std::span<const double> q() const { return q_; }
  /// Bodies that stand elsewhere, so that it can be seen.
  std::span<const BodyId> moved() const { return moved_; }

 private:
  static constexpr double noticed = 0.01;  // of the size of the model, and in rad

  std::vector<double> q_;
  std::vector<BodyId> moved_;
};

}  // namespace freeplay
