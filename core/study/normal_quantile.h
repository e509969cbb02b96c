// NormalQuantile: the inverse of the standard normal distribution.
#pragma once

namespace freeplay {

/// The x below which a standard normal number lies with probability `p`, 0 < p < 1. Wichura's AS 241 (PPND16), Applied
/// Statistics 37 (1988): about 1e-16 relative.
double normal_quantile(double p);

}  // namespace freeplay
