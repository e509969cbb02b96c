#include "run/figure_noise.h"

#include <algorithm>
#include <cmath>

namespace freeplay {
namespace {

// Of ten mechanisms 5 in 6 means and parts of the time and 3 in 4 counts of another run lie within.
constexpr double of_spread = 1.5;  // of parts of the run
constexpr double of_peak = 0.05;   // of the noise of a peak is that of its mean square root at least
constexpr double of_chance = 2.0;  // roots of a number of events that hang on chance

}  // namespace

FigureNoise::Loose FigureNoise::beside(std::size_t place) const {
  const LargestValues& largest = statistics_.largest();
  Loose all;
  for (int j = 0; j < static_cast<int>(statistics_.joints_.size()); ++j) {
    const JointStatistics seen = statistics_.joint(j);
    if (std::isnan(seen.contact_fraction) || !largest.noise().share_chance(place, largest.places().force(j))) continue;
    all.joints += 1.0;
    all.contacts += static_cast<double>(seen.contacts);
    all.flight += 1.0 - seen.contact_fraction;
  }
  const double joints = std::max(all.joints, 1.0);
  return {all.joints, all.contacts / joints, all.flight / joints};
}

double FigureNoise::of_rms(const Statistics::Mean& wanted) const {
  const double duration = statistics_.duration_, rms = statistics_.any() ? wanted.rms(duration) : 0.0;
  if (!(rms > 0.0)) return 0.0;
  const PeakNoise& noise = statistics_.largest().noise();
  double out = 0.0;
  std::size_t i = 0;
  Statistics::each_mean(statistics_, [&](const Statistics::Mean& mean, std::size_t place) {
    const std::size_t index = i++;
    const double grown = &mean == &wanted ? noise.grown(place) : 0.0;
    if (!(grown > 0.0)) return;
    const Loose loose = beside(place);
    const double events = loose.joints * loose.contacts, peak = statistics_.largest().in_window()[place];
    const double square = statistics_.mean_noise_.of(index, statistics_.last_time_, mean.integral, events) / duration;
    const double by_peak = peak > 0.0 ? of_peak * noise.of(place) / peak * rms : 0.0;
    out = std::hypot(of_spread * grown * square / (2.0 * rms), by_peak);
  });
  return out;
}

// Events that chance makes, as many as in a joint beside it at least: their number varies by its root, and what they
// last in all by a little more.
FigureNoise::OfJoint FigureNoise::joint(int index) const {
  const LargestValues& largest = statistics_.largest();
  const std::size_t place = largest.places().force(index);
  OfJoint out{of_rms(statistics_.joints_[static_cast<std::size_t>(index)].force), 0.0, 0.0};
  const JointStatistics seen = statistics_.joint(index);
  if (std::isnan(seen.contact_fraction) || largest.noise().is_settled(place)) return out;
  const Loose loose = beside(place);
  const double grown = largest.noise().grown(place);
  const double contacts = std::max(static_cast<double>(seen.contacts), loose.contacts);
  out.contacts = of_chance * grown * std::sqrt(contacts);
  const double flight = 1.0 - seen.contact_fraction;
  const double noise = of_chance * grown * std::max(flight, loose.flight) * std::sqrt(2.0 / std::max(contacts, 1.0));
  out.contact_fraction = std::min(noise, std::max(flight, seen.contact_fraction));  // a part is between 0 and 1
  return out;
}

double FigureNoise::rms_of_driver(int index) const {
  return of_rms(statistics_.drivers_[static_cast<std::size_t>(index)].effort);
}

FigureNoise::OfPath FigureNoise::path(int index) const {
  const auto& sums = statistics_.paths_[static_cast<std::size_t>(index)];
  return {of_rms(sums.position), of_rms(sums.angle)};
}

}  // namespace freeplay
