// PercentileRanks: which of n values in order a percentile lies between.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

namespace freeplay {

/// Ranks, from 1, of the values between which the `share` of a distribution lies with at least this confidence,
/// whatever the distribution is: how many of n values are below is binomial, and each end errs at most half as often as
/// both. None where n are too few.
std::optional<std::pair<std::uint64_t, std::uint64_t>> percentile_ranks(std::uint64_t n, double share,
                                                                        double confidence);

}  // namespace freeplay
