// Derivatives of the forces of a joint, from marker space to the columns of its two bodies.
//
// With Q = J^T W: dQ = J^T dW + dJ^T W, dpose = J dq, dtwist = J dv + (dJ v) and d(s x F)/dtheta = -s.F.
#pragma once

#include <span>

#include "system/planar_kinematics.h"
#include "system/spatial_bodies.h"

namespace freeplay {

/// Row-major pieces of the derivatives of a joint with nz internal variables; w velocities of a body.
struct InternalDerivatives {
  std::span<double> force_z;  ///< 2 w x nz: generalised forces by z
  std::span<double> rate_q;   ///< nz x 2 w: z' by increments of the bodies
  std::span<double> rate_v;   ///< nz x 2 w: z' by their velocities
  std::span<double> rate_z;   ///< nz x nz
};

namespace force_map {

/// Generalised forces of a joint on both bodies by their increments and velocities: 2 w x 2 w numbers each. `arms` of
/// its two markers; `wrench` as in ForceValues; `derivatives` as in JointForces, `width` numbers a row.
void to_bodies(const planar::Arm* const (&arms)[2], const double* wrench, const double* derivatives, std::size_t width,
               double* by_q, double* by_v);
void to_bodies(const spatial::Arm* const (&arms)[2], const double* wrench, const double* derivatives, std::size_t width,
               double* by_q, double* by_v);
/// The same for its internal variables.
void to_internal(const planar::Arm* const (&arms)[2], const double* derivatives, std::size_t width, std::size_t nz,
                 const InternalDerivatives& out);
void to_internal(const spatial::Arm* const (&arms)[2], const double* derivatives, std::size_t width, std::size_t nz,
                 const InternalDerivatives& out);

}  // namespace force_map
}  // namespace freeplay
