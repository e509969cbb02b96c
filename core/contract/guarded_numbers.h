// GuardedNumbers: an array with marked numbers before and after it, so that a write beside it is seen.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/same_bits.h"
#include "freeplay/span.h"

namespace freeplay {

/// One marked number: a NaN that no arithmetic makes.
struct GuardMark {
  std::uint64_t bits = 0x7ff8c0ffee15600d;
  bool intact() const { return bits == GuardMark().bits; }
  double number() const { return std::bit_cast<double>(bits); }
};

class GuardedNumbers {
 public:
  explicit GuardedNumbers(std::size_t count, double fill = 0.0) : numbers_(count + 2 * margin, guard()), count_(count) {
    for (double& number : span()) number = fill;
  }
  explicit GuardedNumbers(const std::vector<double>& values) : GuardedNumbers(values.size()) {
    for (std::size_t i = 0; i < count_; ++i) span()[i] = values[i];
  }

  Span<double> span() { return {numbers_.data() + margin, count_}; }
  std::vector<double> values() const { return {numbers_.data() + margin, numbers_.data() + margin + count_}; }
  bool intact() const {
    const auto is_mark = [](double number) {
      return std::bit_cast<std::uint64_t>(number) == std::bit_cast<std::uint64_t>(guard());
    };
    for (std::size_t i = 0; i < margin; ++i) {
      if (!is_mark(numbers_[i]) || !is_mark(numbers_[margin + count_ + i])) return false;
    }
    return true;
  }

 private:
  // Two rows of a joint's Jacobian, so that an index that is one row off is caught and harms nothing else.
  static constexpr std::size_t margin = 24;
  static double guard() { return GuardMark().number(); }
  std::vector<double> numbers_;
  std::size_t count_;
};

}  // namespace freeplay
