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

/// P(5/2, q) / P(3/2, q) of incomplete gamma functions: variance of a normal number in space that lies in the unit
/// ball, over sigma^2; q = 1/(2 sigma^2). By their series of positive terms.
double share_within_ball(double q) {
  if (q > 40.0) return 1.0 - std::exp(-q) * q * std::sqrt(q) / 1.3293403881791370;  // Gamma(5/2)
  const auto series = [q](double a) {
    double term = 1.0 / a, sum = term;
    for (double n = a + 1.0; term > 1e-17 * sum; n += 1.0) sum += term *= q / n;
    return sum;
  };
  return q / 1.5 * series(2.5) / series(1.5);
}

/// A point of the unit ball. A wide normal law comes from the uniform one by rejection.
void draw_in_ball(const PlayLaw& law, RandomDraws& random, std::span<double> out) {
  const bool normal = law.kind == PlayLaw::Kind::normal, wide = normal && law.sigma >= 0.8;
  while (true) {
    double squared = 0.0;
    for (double& number : out) {
      number = random.normal();
      squared += number * number;
    }
    double factor = law.sigma;
    if (law.kind == PlayLaw::Kind::rim) factor = 1.0 / std::sqrt(squared);
    if (law.kind == PlayLaw::Kind::uniform || wide) factor = std::cbrt(random.uniform()) / std::sqrt(squared);
    for (double& number : out) number *= factor;
    squared *= factor * factor;
    if (wide && random.uniform() > std::exp(-0.5 * squared / (law.sigma * law.sigma))) continue;
    if (wide || !normal || squared <= 1.0) return;
  }
}

}  // namespace

double variance(const PlayLaw& law, int size) {
  const double sigma = law.sigma, q = 0.5 / (sigma * sigma);
  switch (law.kind) {
    case PlayLaw::Kind::uniform:
      return 1.0 / (size + 2.0);
    case PlayLaw::Kind::rim:
      return size > 1 ? 1.0 / size : 1.0 / 3.0;
    case PlayLaw::Kind::normal:
      break;
  }
  // The square of the radius is exponential with mean 2 sigma^2, cut off at 1.
  if (size == 2) return sigma * sigma * (1.0 - q / std::expm1(q));
  if (size == 3) return sigma * sigma * share_within_ball(q);
  return sigma * sigma * (1.0 - std::sqrt(2.0 / M_PI) / sigma * std::exp(-q) / std::erf(std::sqrt(q)));
}

void draw(const PlayLaw& law, RandomDraws& random, std::span<double> out) {
  const bool normal = law.kind == PlayLaw::Kind::normal;
  if (out.size() == 1) {
    out[0] = normal ? cut_normal(law.sigma, random) : 2.0 * random.uniform() - 1.0;
    return;
  }
  if (out.size() == 3) return draw_in_ball(law, random, out);
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

void draw(const PlayLaw& law, RandomDraws& random, const PlayHull& hull, std::span<double> out) {
  const bool normal = law.kind == PlayLaw::Kind::normal, wide = normal && law.sigma >= 0.8;
  const Eigen::Map<Eigen::VectorXd> y(out.data(), static_cast<Eigen::Index>(out.size()));
  while (true) {
    for (double& number : out) number = normal && !wide ? law.sigma * random.normal() : 2.0 * random.uniform() - 1.0;
    const double gauge = hull.gauge(y);
    if (law.kind == PlayLaw::Kind::rim && gauge > 0.0) {
      for (double& number : out) number /= gauge;
      return;
    }
    if (gauge > 1.0) continue;
    if (wide && random.uniform() > std::exp(-0.5 * y.squaredNorm() / (law.sigma * law.sigma))) continue;
    return;
  }
}

}  // namespace freeplay
