// What teeth without play do to the bearings of their wheels.
#pragma once

#include <array>
#include <span>

#include "system/system.h"

namespace freeplay {

/// Of one joint, on its second body at its marker, in the plane.
struct ToothWrench {
  int joint;
  bool is_whole;  ///< of the gear itself; else it adds to what the rows alone do
  std::array<double, 2> force;
  double moment;

  /// `to`: fx, fy and the torque, which stand `torque` numbers behind fx.
  void add_to(double* to, std::size_t torque) const {
    const double rest = is_whole ? 0.0 : 1.0;
    to[0] = rest * to[0] + force[0];
    to[1] = rest * to[1] + force[1];
    to[torque] = rest * to[torque] + moment;
  }
};

/// Of a gear with teeth, and of the joints of its wheels. Wheels stand on rigid pins and slides of one body, so that
/// nothing moves otherwise than by the row of the gear alone, and the forces follow from its multiplier.
///
/// Marker a is the middle of the first wheel and b that of the second, d = P_b - P_a, u = d/|d|, t = u turned by +90
/// degrees, i the ratio of their turns against the body that carries both, and T_b the torque that the gear passes to
/// b. The force on b, at the pitch point C, is
///
///   C = P_b - d/(1 - i),   F = F_t t + F_r u,   F_t = -(1 - i) T_b/|d|,   F_r = -sign(i) |F_t| tan(alpha)
///
/// and -F acts on a: their moments about P_b and P_a are T_b and -i T_b. On a rack b with the x axis h, n = h turned by
/// +90 degrees, the pitch radius i and the force f_b along h:
///
///   C = P_a - i n,         F = f_b h + F_r n,   F_r = -sign(i) |f_b| tan(alpha)
///
/// Teeth only push: F_r parts wheels that stand side by side whichever flank carries, and presses one inside of a ring
/// away from it. Of the gear itself it is the wrench on the wheel or rack of the second joint, at its frame. Litvin and
/// Fuentes 2004, Gear Geometry and Applied Theory, chapter 10.
std::array<ToothWrench, 3> tooth_wrenches(const System& system, const Gear& gear, const Evaluation& e,
                                          std::span<const double> lambda);

}  // namespace freeplay
