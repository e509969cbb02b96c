// Motions: what the drivers prescribe as functions of time.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "freeplay/parameter.h"
#include "model/leg.h"
#include "model/path_pose.h"
#include "system/antiderivative.h"

namespace freeplay {

/// Why a driver, a path or an applied force has no value at some time.
struct MotionFault {
  MotionFault() { text[0] = '\0'; }
  int driver = -1;      ///< index into Model::drivers, or -1
  int kinematics = -1;  ///< index into Model::kinematics, or -1
  int force = -1;       ///< index into Model::forces, or -1
  const char* id = "";  ///< "ik-unreachable", "bad-expression", "bad-number"
  char text[512];
};

/// An instant at which a path comes closest to a singular place of the mechanism that follows it, so that a very small
/// part of the lengths decides how it goes on.
struct PathEdge {
  int kinematics = 0;     ///< index into Model::kinematics
  double time = 0.0;      ///< [s]
  double distance = 0.0;  ///< of the path from the edge of what is reached [m]
  double width = 0.0;     ///< how long it is as close [s]
  bool jumps = false;     ///< speeds of drivers jump there
  std::string joints{};   ///< "joint 'elbow' (at 0.02 deg)": what turns there without moving the frame
};

/// Drivers that follow a path through the whole mechanism instead of a leg of their own.
class FollowedMotion {
 public:
  /// Work space of one caller at a time.
  struct Work {
    virtual ~Work() = default;
  };
  virtual ~FollowedMotion() = default;
  virtual std::unique_ptr<Work> make_work() const = 0;
  /// Fills the entries of these drivers.
  virtual bool evaluate(double t, Span<TimeValue> out, Work& work, MotionFault& fault) const noexcept = 0;
  /// Pose of the frame of an inverse-kinematics entry, components that the path leaves open included.
  virtual bool frame(int kinematics, double t, PathPose& pose, Work& work, MotionFault& fault) const noexcept = 0;
  virtual std::span<const PathEdge> edges() const = 0;
};

/// Work space of Motions. Allocates when it is first used.
struct MotionWork {
  std::unique_ptr<FollowedMotion::Work> followed{};
};

/// All driver motions of a model. Values depend on t alone, and any number of threads may ask, each with its work
/// space.
class Motions {
 public:
  explicit Motions(const Model& model);
  Motions(const Motions&) = delete;
  Motions& operator=(const Motions&) = delete;

  /// Start value of the coordinate of a driver that prescribes a speed [rad or m].
  void set_start(int driver, double coordinate);
  void take_starts_of(const Motions& other) { starts_ = other.starts_; }

  /// Does a driver, or one of the drivers of an inverse-kinematics entry, lack a closed form? Until follow() is called
  /// such drivers are 0.
  bool follows(int driver) const;
  bool entry_follows(int kinematics) const;
  void follow(std::shared_ptr<const FollowedMotion> followed) { followed_ = std::move(followed); }

  /// f, f', f'' of every driver: coordinates for prescribing ones, the effort for the others.
  bool evaluate(double t, Span<TimeValue> out, MotionWork& work, MotionFault& fault) const noexcept;
  /// Components that the path leaves open are those of the ideal mechanism, and 0 before follow().
  bool path(int kinematics, double t, PathPose& pose, MotionWork& work, MotionFault& fault) const noexcept;
  /// The same with a work space of the call.
  bool evaluate(double t, Span<TimeValue> out, MotionFault& fault) const noexcept;
  bool path(int kinematics, double t, PathPose& pose, MotionFault& fault) const noexcept;
  /// True if values of the driver are angles known up to whole turns.
  bool modulo_turns(int driver) const;
  /// The closed form of a driver by inverse kinematics, or null.
  const Leg* leg(int driver) const;
  /// Where paths come close to the edge of what the mechanism reaches, from the start of the run to a time.
  std::vector<PathEdge> edges(double until) const;
  /// Poses of the bodies of a driver's leg at time t; false when out of reach.
  bool leg_pose(int driver, double t, LegPose& pose, MotionFault& fault) const noexcept;

 private:
  Jet platform_angle(int driver, const PathPose& frame) const;
  FollowedMotion::Work& own_part(MotionWork& work) const;
  bool reaches(int driver, double t, const CrankPose& pose, MotionFault& fault) const noexcept;
  /// Of drivers by inverse kinematics.
  bool follow_paths(double t, Span<TimeValue> out, MotionWork& work, MotionFault& fault) const noexcept;
  bool function(std::size_t driver, double t, TimeValue& out, EvaluationFailure& failure) const noexcept;

  const Model& model_;
  std::vector<std::optional<Leg>> legs_;         ///< by driver
  std::vector<Antiderivative> antiderivatives_;  ///< by driver
  std::vector<double> starts_;                   ///< by driver
  std::vector<double> table_starts_;             ///< by driver: integral of its table up to the start time
  std::shared_ptr<const FollowedMotion> followed_;
};

}  // namespace freeplay
