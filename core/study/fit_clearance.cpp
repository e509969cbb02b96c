#include "study/fit_clearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "study/distribution.h"

namespace freeplay {
namespace {

constexpr int panels_of_a_piece = 16;
constexpr int most_steps = 60;  // of a search by halving and Newton's method

// Gauss and Legendre with eight points (Abramowitz and Stegun, table 25.4).
constexpr std::array<std::array<double, 2>, 4> gauss = {{{0.1834346424956498, 0.3626837833783620},
                                                         {0.5255324099163290, 0.3137066458778873},
                                                         {0.7966664774136267, 0.2223810344533745},
                                                         {0.9602898564975363, 0.1012285362903763}}};

/// A zone between its limits: normal about its middle with a sixth of it as deviation, cut at them, or uniform.
Distribution zone(bool normal, double low, double high) {
  if (!normal) return {Distribution::Kind::uniform, low, high};
  return {.kind = Distribution::Kind::normal, .a = (low + high) / 2, .b = (high - low) / 6, .low = low, .high = high};
}

/// The zone between `low` and `high`.
double quantile_within(Distribution zone, double low, double high, double u) {
  zone.low = std::max(zone.low, low);
  zone.high = std::min(zone.high, high);
  return quantile(zone, u);
}

/// Of the zone: density at x up to a factor, and share between two places up to another one.
double density_in(const Distribution& zone, double x) {
  if (zone.kind == Distribution::Kind::uniform) return 1.0;
  const double z = (x - zone.a) / zone.b;
  return std::exp(-0.5 * z * z);
}

double share_in(const Distribution& zone, double low, double high) {
  if (zone.kind == Distribution::Kind::uniform) return std::max(0.0, std::min(high, zone.b) - std::max(low, zone.a));
  const auto scaled = [&](double x) { return (std::clamp(x, zone.low, zone.high) - zone.a) / zone.b; };
  const double from = scaled(low), until = scaled(high);
  // The difference of the smaller tails, so that little is lost of a share far from the middle.
  const auto tail = [](double z) { return std::erfc(z / std::numbers::sqrt2); };
  return std::max(0.0, from > 0.0 ? tail(from) - tail(until) : tail(-until) - tail(-from));
}

}  // namespace

FitClearance::FitClearance(const StudyFit& of) : fit_(of) {
  const IsoFit& limits = fit_.limits;
  if (fit_.low <= limits.smallest_clearance() && fit_.high >= limits.largest_clearance()) return;
  // Where an end of the clearance meets an end of the shaft's zone, the share of shafts has a kink.
  std::vector<double> ends = {limits.hole_low, limits.hole_high};
  for (const double cut : {fit_.low, fit_.high}) {
    for (const double shaft : {limits.shaft_low, limits.shaft_high}) {
      ends.push_back(std::clamp(shaft + 2 * cut, limits.hole_low, limits.hole_high));
    }
  }
  std::ranges::sort(ends);
  share_ = 0.0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double width = (ends[i + 1] - ends[i]) / panels_of_a_piece;
    for (int k = 0; k < panels_of_a_piece && width > 0.0; ++k) {
      const double from = ends[i] + k * width, until = k + 1 < panels_of_a_piece ? from + width : ends[i + 1];
      const double part = share(from, until);
      if (!(part > 0.0)) continue;
      panels_.push_back({from, until, share_});
      share_ += part;
    }
  }
}

/// Of a hole of this size with a shaft that suits it, up to a factor.
double FitClearance::density(double size) const {
  const IsoFit& limits = fit_.limits;
  return density_in(zone(fit_.normal, limits.hole_low, limits.hole_high), size) *
         share_in(zone(fit_.normal, limits.shaft_low, limits.shaft_high), size - 2 * fit_.high, size - 2 * fit_.low);
}

double FitClearance::share(double from, double until) const {
  const double middle = 0.5 * (from + until), half = 0.5 * (until - from);
  double sum = 0.0;
  for (const auto& [place, weight] : gauss) {
    sum += weight * (density(middle - half * place) + density(middle + half * place));
  }
  return half * sum;
}

double FitClearance::size_of_hole(double u) const {
  const double wanted = u * share_;
  const auto after = std::ranges::upper_bound(panels_, wanted, {}, &Panel::share_before);
  const Panel& panel = after == panels_.begin() ? panels_.front() : *std::prev(after);
  double low = panel.from, high = panel.until, size = 0.5 * (low + high);
  for (int step = 0; step < most_steps && high - low > 1e-15 * (panel.until - panel.from); ++step) {
    const double beyond = panel.share_before + share(panel.from, size) - wanted;
    (beyond > 0.0 ? high : low) = size;
    const double next = size - beyond / density(size);
    const double last = size;
    size = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(size - last) <= 1e-13 * (panel.until - panel.from)) break;
  }
  return size;
}

double FitClearance::at(double hole, double shaft) const {
  const IsoFit& limits = fit_.limits;
  const Distribution holes = zone(fit_.normal, limits.hole_low, limits.hole_high);
  const Distribution shafts = zone(fit_.normal, limits.shaft_low, limits.shaft_high);
  const double size = panels_.empty() ? quantile(holes, hole) : size_of_hole(hole);
  const double pin = quantile_within(shafts, size - 2 * fit_.high, size - 2 * fit_.low, shaft);
  return std::clamp((size - pin) / 2, fit_.low, fit_.high);
}

}  // namespace freeplay
