// PlaySamples: what random play does to a platform.
#pragma once

#include <cstdint>

#include "analysis/clearance_error.h"
#include "analysis/play_law.h"
#include "analysis/station.h"

namespace freeplay {

/// Of random samples of dX: root mean squares and largest values; positions [m], angles [rad].
struct PlayStatistics {
  double rms_position = 0.0, rms_dangle = 0.0, max_position = 0.0, max_dangle = 0.0;
};

/// Draws `count` samples of plays and errors of inputs distributed as `law` says, given that rigid bodies close.
/// Without redundancy the draws are independent; with it a Markov chain walks over the plays that close (ClosedPlay),
/// so neighbouring samples resemble each other. Every sample is feasible: none exceeds the exact worst case. Same seed,
/// same numbers. Empty where A has not the rank of its columns, and where no play with every pin on its rim was found
/// to close.
std::optional<PlayStatistics> sample_play(const IdealMechanism& mechanism, const VelocityMap& map, long count,
                                          std::uint64_t seed, const PlayLaw& law = {}, const Tick& tick = {});

/// Root mean squares of the same plays where every leg errs by itself and A dX = d is solved by least squares, in
/// closed form from the variances of the law. Largest values are left 0. Empty where A has not the rank of its columns,
/// and where a play is a polytope, whose variance is not known.
std::optional<PlayStatistics> least_squares_play(const IdealMechanism& mechanism, const VelocityMap& map,
                                                 const PlayLaw& law = {});

}  // namespace freeplay
