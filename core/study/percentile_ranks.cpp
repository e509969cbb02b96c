#include "study/percentile_ranks.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace freeplay {
namespace {

constexpr double negligible = 1e-25;  // of the most probable count

}  // namespace

std::optional<std::pair<std::uint64_t, std::uint64_t>> percentile_ranks(std::uint64_t n, double share,
                                                                        double confidence) {
  // Probabilities from the most probable count outwards, in terms of its own: no factorial is needed.
  const auto count = static_cast<double>(n);
  const double most = std::min(std::floor((count + 1.0) * share), count), odds = share / (1.0 - share);
  std::vector<double> below, above{1.0};  // of most - 1, most - 2 ... and of most, most + 1 ...
  for (double k = most, weight = 1.0; k > 0.0 && weight > negligible; k -= 1.0) {
    weight *= k / ((count - k + 1.0) * odds);
    below.push_back(weight);
  }
  for (double k = most; k < count && above.back() > negligible; k += 1.0) {
    above.push_back(above.back() * (count - k) * odds / (k + 1.0));
  }
  const double total =
      std::accumulate(below.rbegin(), below.rend(), 0.0) + std::accumulate(above.rbegin(), above.rend(), 0.0);
  const double tail = 0.5 * (1.0 - confidence) * total;
  std::vector<double> all(below.rbegin(), below.rend());
  all.insert(all.end(), above.begin(), above.end());
  const double first = most - static_cast<double>(below.size());  // the count that all[0] is of
  std::size_t low = 0, high = all.size();                         // left out: counts before low, and from high on
  for (double sum = all[low]; sum <= tail; sum += all[low]) ++low;
  for (double sum = all[high - 1]; sum <= tail; sum += all[high - 1]) --high;
  const double from = first + static_cast<double>(low), until = first + static_cast<double>(high);
  if (from < 1.0 || until > count) return std::nullopt;
  return std::pair(static_cast<std::uint64_t>(from), static_cast<std::uint64_t>(until));
}

}  // namespace freeplay
