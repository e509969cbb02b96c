// PathBridge: what drivers do where a path leads them through a singular place of the mechanism.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "model/path_pose.h"

namespace freeplay {

/// The quintic in time from `a` to `b`, which are `length` apart, at the fraction s of the way, outside of it, too.
Jet quintic(const Jet& a, const Jet& b, double length, double s);

/// At a singular place speeds are quotients of two vanishing numbers, so that what is found there is rounding. Where
/// the motion passes it smoothly it is the quintic of what it is on either side.
class PathBridge {
 public:
  /// One end: the coordinates of the drivers and the poses of the frames of the paths.
  struct End {
    double t = 0.0;
    std::vector<Jet> drivers{};
    std::vector<PathPose> frames{};
  };
  [[gnu::cold]] PathBridge(End left, End right);

  bool covers(double t) const { return t > left_.t && t < right_.t; }
  bool touches(double t) const { return t >= left_.t && t <= right_.t; }
  Jet driver(std::size_t index, double t) const;
  void frame(std::size_t index, double t, bool spatial, PathPose& pose) const;

 private:
  using Quaternion = std::array<Jet, 4>;
  double part(double t) const { return (t - left_.t) / (right_.t - left_.t); }

  End left_, right_;
  std::vector<Quaternion> left_turns_, right_turns_;
};

}  // namespace freeplay
