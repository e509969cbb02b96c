// Quantiles of the distributions that random axes are drawn from.
#pragma once

#include "format/study_axis.h"

namespace freeplay {

/// The value below which lies the share `u` of the distribution, as it is cut, 0 < u < 1.
double quantile(const Distribution& of, double u);

}  // namespace freeplay
