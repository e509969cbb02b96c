// Rank correlation: how far one column of a table goes up with another.
#pragma once

#include <string>
#include <vector>

namespace freeplay {

/// Spearman's, from -1 to 1, within the rows of each combination; of several the mean by how many values each has, so
/// that what differs between them says nothing. Rows without a finite number in both do not count.
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b,
                        const std::vector<std::string>& combinations);

}  // namespace freeplay
