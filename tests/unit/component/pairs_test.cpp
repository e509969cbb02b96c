#include "freeplay/pairs.h"

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(InPairs, GivesTheNumbersOfAPlainLoopForEveryLengthAndPlace) {
  for (std::size_t first = 0; first < 2; ++first) {
    for (std::size_t size = 0; size < 8; ++size) {
      std::vector<double> x(10), y(10, -1.0), plain(10, -1.0);
      for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.1 + 0.37 * static_cast<double>(i * i);
      const Span<double> out = Span<double>(std::span(y)).part(first, size),
                         in = Span<double>(std::span(x)).part(first, size);
      in_pairs(size, [&](auto at) { at(out) = at(in) * 0.3 + 1.7 * at(in) - at(x); });
      for (std::size_t i = 0; i < size; ++i) plain[first + i] = in[i] * 0.3 + 1.7 * in[i] - x[i];
      EXPECT_EQ(y, plain) << first << " " << size;
    }
  }
}

}  // namespace
}  // namespace freeplay
