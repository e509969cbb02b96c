// MotionFormulas: formulas of a model whose variables are channels of the motion.
#pragma once

#include <vector>

#include "base/state_formula.h"

namespace freeplay {

/// A number that position and velocity of the mechanism decide, SI, as the result column of its name has it.
struct MotionChannel {
  enum class Of {
    position,          ///< component of a marker's origin, world axes [m]
    angle,             ///< of a marker, in the plane [rad]
    velocity,          ///< of a marker's origin, world axes [m/s]
    angular_velocity,  ///< world axes [rad/s]
    coordinate,        ///< of a joint [rad or m]
    speed              ///< of a joint [rad/s or m/s]
  };
  Of of = Of::position;
  int element = 0;    ///< index into Model::markers or, for the last two, Model::joints
  int component = 0;  ///< 0 to 2

  bool is_of_joint() const { return of == Of::coordinate || of == Of::speed; }
  friend bool operator==(const MotionChannel&, const MotionChannel&) = default;
};

struct MotionFormulas {
  std::vector<StateFormula> formulas;   ///< by value
  std::vector<MotionChannel> channels;  ///< their variables

  bool empty() const { return formulas.empty(); }
  int switches() const {
    int count = 0;
    for (const StateFormula& formula : formulas) count += formula.switches();
    return count;
  }
};

}  // namespace freeplay
