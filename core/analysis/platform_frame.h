// PlatformFrame: the platform's frame, between the numbers of its pose and the coordinates of its body.
#pragma once

#include <span>
#include <vector>

#include "analysis/pose_form.h"
#include "base/jet.h"
#include "system/system.h"

namespace freeplay {

/// A number of the pose that is demanded, as a row g V of the frame's twist V.
struct PoseRow {
  double g[6] = {};
  double gap = 0.0;           ///< what g must move the frame by, to first order [m or rad]
  double rate = 0.0;          ///< g V [m/s or rad/s]
  double acceleration = 0.0;  ///< g V' [m/s^2 or rad/s^2]
};

class PlatformFrame {
 public:
  /// `marker`: index into Model::markers, on a body.
  PlatformFrame(const System& system, int marker);

  const PoseForm& form() const { return form_; }
  /// Angles in the plane count turns; in space they are principal ones, with yaw 0 where roll and yaw turn about one
  /// axis.
  FramePose pose(std::span<const double> q) const;
  /// Puts the body of the frame where the frame has this pose.
  void place(const FramePose& pose, std::span<double> q) const;
  /// Rows of the `given` numbers at a state that is evaluated, in their order. Angles may differ by whole turns. In
  /// space all three angles together become rows of the rotation vector, which has no singular places; single ones are
  /// rows of the rates of the angles, which have one where the pitch is a quarter turn.
  void rows(const Components& given, const std::array<Jet, most_components>& pose, const Evaluation& e,
            std::vector<PoseRow>& out) const;
  /// A row in the velocities of the frame's body (3 or 6 numbers) as a row of the frame's twist, in the order of dX.
  void frame_row(const double* row, const Evaluation& e, double* out) const;

 private:
  void turn_rows(const Components& given, const std::array<Jet, most_components>& pose, const MarkerKinematics& here,
                 std::vector<PoseRow>& out) const;

  const System& system_;
  int marker_;
  const PoseForm& form_;
};

}  // namespace freeplay
