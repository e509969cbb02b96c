// StartReport: what a start has made of the start values of the file.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "assembly/start_velocities.h"
#include "base/error.h"
#include "system/system.h"

namespace freeplay {

/// A start value of the file that the start does not have.
struct MovedStart {
  std::string body;      ///< empty for the journal of a joint
  std::string quantity;  ///< "position", "angle", "orientation", "velocity", "angular velocity", "eccentricity",
                         ///< "turn" of a body whose pose gives no angle, where a guide on ground turns its frames, or
                         ///< "place under load" of a journal
  std::string unit;      ///< m, rad, m/s or rad/s
  double by = 0.0;       ///< how far it was moved
  bool far = false;      ///< by more than 10 degrees, or 10 % of the size of the model or of the given velocity
  Location location;     ///< of the key that gives it, or of the joint
  std::string joint{};   ///< with play, whose block gives it; of a turn the guide
};

/// A position that is as near to what the file gives as the one that was taken.
struct TwinStart {
  std::string body;          ///< that stands otherwise there
  std::string taken, other;  ///< where: an angle or a position
  Location location;
};

struct StartReport {
  std::vector<MovedStart> moved;    ///< in the order of bodies
  std::vector<ChosenSpeed> chosen;  ///< in the order of joints, then of bodies
  std::vector<TwinStart> twins;
};

/// Adds what of its block's start the journal of `joint` with play has not kept, for gaps `apart` [m] and `rate` [m/s].
void add_moved_journal(const JointElement& joint, bool gives_velocity, const InitialOffset& wanted, double apart,
                       double rate, std::vector<MovedStart>& moved);

/// What of the poses and velocities of bodies a start at `q` and `v` of the closed mechanism has not kept: more than
/// 1e-4 of the size of the model, of a radian or of the velocity, or of a body with play 1/20 of that.
std::vector<MovedStart> moved_starts(const System& closed, std::span<const double> q, std::span<const double> v);

/// The body in which two positions differ most.
TwinStart twin_start(const System& closed, std::span<const double> taken, std::span<const double> other);

/// One line each, as "body 'lower' starts 2.3 deg from the angle that its `pose` gives".
std::string sentence(const MovedStart& moved);
std::string sentence(const TwinStart& twin);
/// "joint 'pivot' starts at -2.2 rad/s, which the file leaves open".
std::string sentence(const Model& model, const ChosenSpeed& chosen);

}  // namespace freeplay
