// Probe: a joint that does nothing wrong, for libraries that are wrong in one way each.
#pragma once

#include "freeplay/plugin.h"

namespace freeplay::probe {

/// A force without effect.
struct Idle : Joint {
  explicit Idle(const Parameters&) {}
  void declare(JointLayout& layout) const override { layout.forces = 1; }
};

}  // namespace freeplay::probe
