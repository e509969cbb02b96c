#include "study/distribution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "study/normal_quantile.h"

namespace freeplay {
namespace {

/// Share of a standard normal distribution below `z`, to full accuracy in the lower tail.
double normal_share(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// Of a standard normal distribution between `low` and `high`.
double cut_normal(double low, double high, double u) {
  if (low > 0.0) return -cut_normal(-high, -low, 1.0 - u);
  const double from = std::isfinite(low) ? normal_share(low) : 0.0;
  const double to = std::isfinite(high) ? normal_share(high) : 1.0;
  const double share = from + u * (to - from);
  if (!(share > 0.0)) return std::max(low, -std::sqrt(high * high - 2.0 * std::log(u)));  // as far tails fall off
  return share < 1.0 ? normal_quantile(share) : high;
}

double triangular_share(const Distribution& of, double x) {
  if (x <= of.a) return 0.0;
  if (x >= of.c) return 1.0;
  if (x < of.b) return (x - of.a) * (x - of.a) / ((of.c - of.a) * (of.b - of.a));
  return 1.0 - (of.c - x) * (of.c - x) / ((of.c - of.a) * (of.c - of.b));
}

double triangular_quantile(const Distribution& of, double u) {
  const double width = of.c - of.a;
  if (u * width < of.b - of.a) return of.a + std::sqrt(u * width * (of.b - of.a));
  return of.c - std::sqrt((1.0 - u) * width * (of.c - of.b));
}

}  // namespace

double quantile(const Distribution& of, double u) {
  double x = 0.0;
  switch (of.kind) {
    case Distribution::Kind::normal:
      x = of.a + of.b * cut_normal((of.low - of.a) / of.b, (of.high - of.a) / of.b, u);
      break;
    case Distribution::Kind::uniform: {
      const double low = std::max(of.a, of.low), high = std::min(of.b, of.high);
      x = low + u * (high - low);
      break;
    }
    case Distribution::Kind::triangular: {
      const double from = triangular_share(of, of.low), to = triangular_share(of, of.high);
      x = triangular_quantile(of, from + u * (to - from));
      break;
    }
  }
  return std::clamp(x, of.low, of.high);
}

}  // namespace freeplay
