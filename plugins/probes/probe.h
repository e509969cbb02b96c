// Probe: joints that do nothing wrong, for libraries that are wrong in one way each.
#pragma once

#include <cstdint>

#include "freeplay/plugin.h"

namespace freeplay::probe {

/// Writes where no memory is.
inline void crash() {
  volatile std::uintptr_t nowhere = 4096 - sizeof(double);
  *reinterpret_cast<volatile double*>(nowhere) = 1.0;
}

/// A force without effect.
struct Idle : Joint {
  explicit Idle(const Parameters&) {}
  void declare(JointLayout& layout) const override { layout.forces = 1; }
};

/// The origin of b stays on the x axis of a, in the plane: Phi = y_a.(P_b - P_a).
struct Slot : Joint {
  explicit Slot(const Parameters&) {}
  void declare(JointLayout& layout) const override { layout.constraint_rows = 1; }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const double yx = in.a->rotation[1], yy = in.a->rotation[4], w = in.a->angular_velocity[2];
    const double dx = in.b->position[0] - in.a->position[0], dy = in.b->position[1] - in.a->position[1];
    const double vx = in.b->velocity[0] - in.a->velocity[0], vy = in.b->velocity[1] - in.a->velocity[1];
    rows.phi[0] = yx * dx + yy * dy;
    rows.jacobian[0] = -yx;
    rows.jacobian[1] = -yy;
    rows.jacobian[5] = -yy * dx + yx * dy;  // (w x y_a).d
    rows.jacobian[6] = yx;
    rows.jacobian[7] = yy;
    rows.gamma[0] = w * w * rows.phi[0] - 2.0 * w * (-yy * vx + yx * vy);
  }
};

}  // namespace freeplay::probe
