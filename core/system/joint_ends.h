// JointEnds: what a joint is between.
#pragma once

#include "model/model.h"

namespace freeplay {

struct JointEnds {
  int marker_a = 0, marker_b = 0;           ///< into MarkerValues::markers
  BodyId body_a = ground, body_b = ground;  ///< their places (Layout::place)
};

}  // namespace freeplay
