// ContactPoses: where the contacts of a joint begin, found from its event functions alone.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "contract/joint_probe.h"

namespace freeplay {

/// How each contact is tried.
namespace trial {
inline constexpr double shallow = 0.01;      ///< depth, part of the way in the middle
inline constexpr double approach = 1.0;      ///< [m/s]
inline constexpr double per_contact = 20.0;  ///< as runs ask for
}  // namespace trial

/// One contact that is about to begin, all others apart: body a is at rest and so is b.
struct ContactPose {
  std::size_t contact = 0;  ///< in the order of the events that begin one
  int begin = 0, end = -1;  ///< its events; -1: none ends it
  MarkerPair markers;
  double way = 0.0;                  ///< by which the contact is apart in the middle of the play [m]
  std::array<double, 6> by_twist{};  ///< rate of the event function for a unit twist of b, world axes

  /// The markers with the contact `depth` deep [m], or apart, by a shift along its normal.
  MarkerPair at(double depth) const;
  /// How much a turn of b by 1 rad brings, by what a shift of 1 m along the normal does [m].
  double lever() const;
  /// What pushes b out of the contact in a wrench on b, as does work on the event function [N].
  double push(const std::vector<double>& wrench) const;
  /// A twist of b with which the contact closes at `rate` [m/s], made from any one.
  Twelve closing(Twelve twist, double rate) const;
};

/// For each contact of a joint that can be reached from the middle of its play, up to two poses. A joint stands where
/// place() and initial_offset() put it, or with both markers at one place, and is moved from there in directions by
/// chance until the first event function of the role contact_begin passes its zero.
std::vector<ContactPose> contact_poses(const JointProbe& probe, RandomNumbers& random);

/// Names of the two events, for messages.
std::string contact_word(const JointProbe& probe, const ContactPose& pose);

}  // namespace freeplay
