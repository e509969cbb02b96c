// Motions: what the drivers prescribe as functions of time.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "freeplay/parameter.h"
#include "system/antiderivative.h"
#include "system/leg.h"

namespace freeplay {

/// Why a driver, a path or an applied force has no value at some time.
struct MotionFault {
  int driver = -1;      ///< index into Model::drivers, or -1
  int kinematics = -1;  ///< index into Model::kinematics, or -1
  int force = -1;       ///< index into Model::forces, or -1
  const char* id = "";  ///< "ik-unreachable", "bad-expression", "bad-number"
  char text[256] = "";
};

/// Pose that an inverse-kinematics frame is asked for: x, y [m], angle [rad].
using PathPose = std::array<Jet, 3>;

/// All driver motions of a model. Stateless: values depend on t alone.
class Motions {
 public:
  /// Throws Error{input} "ik-underdetermined" when a path cannot be followed by closed-form legs.
  explicit Motions(const Model& model);
  Motions(const Motions&) = delete;
  Motions& operator=(const Motions&) = delete;

  /// Start value of the coordinate of a driver that prescribes a speed [rad or m].
  void set_start(int driver, double coordinate);

  /// f, f', f'' of every driver: coordinates for prescribing ones, the effort for the others. Does not allocate.
  bool evaluate(double t, Span<TimeValue> out, MotionFault& fault) const noexcept;
  bool path(int kinematics, double t, PathPose& pose, MotionFault& fault) const noexcept;
  /// True if values of the driver are angles known up to whole turns.
  bool modulo_turns(int driver) const;
  /// Poses of the bodies of a driver's leg at time t; false when out of reach.
  bool leg_pose(int driver, double t, LegPose& pose, MotionFault& fault) const noexcept;
  const Leg& leg(int driver) const { return legs_[static_cast<std::size_t>(driver)]; }

 private:
  const Model& model_;
  std::vector<Leg> legs_;                        ///< by driver; empty name: none
  std::vector<Antiderivative> antiderivatives_;  ///< by driver
  std::vector<double> starts_;                   ///< by driver
};

}  // namespace freeplay
