// GuardedNumbers: an array with marked numbers before and after it, so that a write beside it is seen.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "base/same_bits.h"
#include "freeplay/span.h"

namespace freeplay {

/// One marked number: a NaN that no arithmetic makes.
struct GuardMark {
  std::uint64_t bits = 0x7ff8c0ffee15600d;
  bool intact() const { return bits == GuardMark().bits; }
  constexpr double number() const { return std::bit_cast<double>(bits); }
};

class GuardedNumbers {
 public:
  explicit GuardedNumbers(std::size_t count, double fill = 0.0) : count_(count) {
    if (count > few_.size() - 2 * margin) many_.resize(count + 2 * margin);
    std::memcpy(first(), marks.data(), sizeof marks);  // some million times in an examination
    std::fill_n(first() + margin, count, fill);
    std::memcpy(first() + margin + count, marks.data(), sizeof marks);
  }
  explicit GuardedNumbers(const std::vector<double>& values) : GuardedNumbers(values.size()) {
    std::ranges::copy(values, first() + margin);
  }

  Span<double> span() { return {first() + margin, count_}; }
  std::span<const double> numbers() const { return {first() + margin, count_}; }
  std::vector<double> values() const { return {first() + margin, first() + margin + count_}; }
  bool intact() const {
    return same_bits({first(), margin}, marks) && same_bits({first() + margin + count_, margin}, marks);
  }

 private:
  // Two rows of a joint's Jacobian, so that an index that is one row off is caught and harms nothing else.
  static constexpr std::size_t margin = 24;
  static constexpr std::array<double, margin> marks = [] {
    std::array<double, margin> all{};
    all.fill(GuardMark().number());
    return all;
  }();
  double* first() { return many_.empty() ? few_.data() : many_.data(); }
  const double* first() const { return many_.empty() ? few_.data() : many_.data(); }

  std::size_t count_;
  // Few numbers stand in the object, as suites make them for each call of a component.
  std::array<double, 2 * margin + 24> few_;
  std::vector<double> many_;
};

}  // namespace freeplay
