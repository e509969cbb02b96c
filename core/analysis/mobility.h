// Mobility: degrees of freedom and redundancy, counted by rank.
#pragma once

#include "analysis/posture.h"

namespace freeplay {

/// Of the ideal mechanism, drivers of inputs away. Ranks count singular values above 1e-9 of the largest, columns in m
/// and rad.
struct Mobility {
  int freedoms = 0;          ///< velocities minus rank of the joints (and of drivers that stay)
  int redundant_rows = 0;    ///< rows of joints that the others determine
  int held = 0;              ///< freedoms that are left when all inputs are held
  int redundant_inputs = 0;  ///< inputs beyond those that the others determine
  int platform = 0;          ///< freedoms of the platform's frame
  int platform_held = 0;     ///< those that are left when all inputs are held
};

Mobility mobility_at(PostureSolver& solver, double t, const Posture& posture);

/// Least freedoms (of the frame: most) over the posture and some around it, reached by small moves of single
/// coordinates: what holds in general. `special`: the posture itself has more freedoms, or freedoms that inputs do not
/// hold.
struct GeneralMobility {
  Mobility general, here;
  int configurations = 0;
  bool special() const { return here.freedoms > general.freedoms || here.held > general.held; }
  /// Freedoms that neither the inputs hold nor the platform feels, such as the spin of a rod between two balls.
  int idle() const { return general.held - general.platform_held; }
};
GeneralMobility general_mobility(PostureSolver& solver, double t, const Posture& posture);

}  // namespace freeplay
