// Quantiles of the distributions that random axes are drawn from.
#pragma once

#include "format/study_axis.h"

namespace freeplay {

/// The value below which lies the share `u` of the distribution, as it is cut, 0 < u < 1.
double quantile(const Distribution& of, double u);

/// Radial clearance [m]: hole and shaft are drawn apart, by one number each. Normal ones have a sixth of their zone as
/// standard deviation and are cut at its ends.
double clearance_of(const StudyFit& of, double hole, double shaft);

}  // namespace freeplay
