// A friction law for contacts that roll, such as teeth at their pitch point or a roller.
#pragma once

#include "freeplay/friction_law.h"

namespace freeplay::play {

class NoFriction final : public FrictionLaw {
 public:
  FrictionForce evaluate(const FrictionState&, Span<double>) const override { return {}; }
};
inline const NoFriction shared_no_friction;

inline FrictionLawRef no_friction() { return FrictionLawRef(abi::friction_law_table<NoFriction>, &shared_no_friction); }

}  // namespace freeplay::play
