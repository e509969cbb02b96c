#include "analysis/play_law.h"

namespace freeplay {
namespace {

/// A normal number of standard deviation sigma, given that it lies in [-1, 1]: rejection, from the uniform law where
/// that is nearer.
double cut_normal(double sigma, RandomDraws& random) {
  while (true) {
    if (sigma < 0.8) {
      const double x = sigma * random.normal();
      if (std::abs(x) <= 1.0) return x;
    } else {
      const double x = 2.0 * random.uniform() - 1.0;
      if (random.uniform() <= std::exp(-0.5 * x * x / (sigma * sigma))) return x;
    }
  }
}

}  // namespace

double variance(const PlayLaw& law, int size) {
  const double sigma = law.sigma, q = 0.5 / (sigma * sigma);
  switch (law.kind) {
    case PlayLaw::Kind::uniform:
      return size == 2 ? 0.25 : 1.0 / 3.0;
    case PlayLaw::Kind::rim:
      return size == 2 ? 0.5 : 1.0 / 3.0;
    case PlayLaw::Kind::normal:
      break;
  }
  // The square of the radius is exponential with mean 2 sigma^2, cut off at 1.
  if (size == 2) return sigma * sigma * (1.0 - q / std::expm1(q));
  return sigma * sigma * (1.0 - std::sqrt(2.0 / M_PI) / sigma * std::exp(-q) / std::erf(std::sqrt(q)));
}

void draw(const PlayLaw& law, RandomDraws& random, std::span<double> out) {
  const bool normal = law.kind == PlayLaw::Kind::normal;
  if (out.size() == 1) {
    out[0] = normal ? cut_normal(law.sigma, random) : 2.0 * random.uniform() - 1.0;
    return;
  }
  double radius = 1.0;
  if (normal) {
    const double twice = 2.0 * law.sigma * law.sigma;
    radius = std::sqrt(-twice * std::log1p(random.uniform() * std::expm1(-1.0 / twice)));
  } else if (law.kind == PlayLaw::Kind::uniform) {
    radius = std::sqrt(random.uniform());
  }
  const double angle = 2.0 * M_PI * random.uniform();
  out[0] = radius * std::cos(angle);
  out[1] = radius * std::sin(angle);
}

}  // namespace freeplay
