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

/// The zone of a hole or shaft, cut.
Distribution zone(bool normal, double low, double high, double cut_low, double cut_high) {
  Distribution made{Distribution::Kind::uniform, low, high};
  if (normal) made = {Distribution::Kind::normal, (low + high) / 2, (high - low) / 6};
  made.low = std::max(low, cut_low);
  made.high = std::min(high, cut_high);
  return made;
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

// The hole is drawn among those that some shaft of the fit suits, then the shaft among those that suit the hole.
double clearance_of(const StudyFit& of, double hole, double shaft) {
  const IsoFit& fit = of.limits;
  const double size = quantile(
      zone(of.normal, fit.hole_low, fit.hole_high, fit.shaft_low + 2 * of.low, fit.shaft_high + 2 * of.high), hole);
  const double pin =
      quantile(zone(of.normal, fit.shaft_low, fit.shaft_high, size - 2 * of.high, size - 2 * of.low), shaft);
  return std::clamp((size - pin) / 2, of.low, of.high);
}

}  // namespace freeplay
