#include "results/play_noise.h"

#include <algorithm>
#include <cmath>

#include "run/figure_noise.h"

namespace freeplay {
namespace {
constexpr double of_spread = 2.0;  // of parts of the run
}

PlayNoise play_noise(const RunRecord& record, int joint) {
  const FigureNoise::OfJoint noise = FigureNoise(record.statistics).joint(joint);
  const JointStatistics sums = record.statistics.joint(joint);
  const PlayFigures seen = record.clearances.figures(joint);
  if (!(noise.contacts > 0.0)) return {};
  const double impacts = std::max(1.0, static_cast<double>(seen.impacts)),
               contacts = std::max(1.0, static_cast<double>(sums.contacts));
  const double of_impacts = noise.contacts * std::sqrt(impacts / contacts);
  const double of_time = noise.contact_fraction / std::max(sums.contact_fraction, noise.contact_fraction);
  // The same surfaces may slide to and fro for the same time, and come less or more far.
  const LargestValues& largest = record.statistics.largest();
  const double grown = largest.noise().grown(largest.places().force(joint));
  const ClearanceStatistics::SumNoise spread = record.clearances.sum_noise(joint, contacts);
  const double of_load = sums.rms_force > 0.0 ? noise.rms_force / sums.rms_force : 0.0;
  return {.flight = noise.contact_fraction,
          .impact = seen.impact * std::sqrt(2.0) * of_impacts / impacts,
          .lasting = noise.contact_fraction,
          .impacts = of_impacts,
          .sliding = std::clamp(of_spread * grown * spread.sliding, of_time * seen.sliding, seen.sliding),
          .work = std::clamp(of_spread * grown * spread.work, std::min(1.0, of_time + 2.0 * of_load) * seen.work,
                             seen.work)};
}

}  // namespace freeplay
