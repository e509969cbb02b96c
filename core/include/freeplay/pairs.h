// Optional for authors: loops over arrays of the length of q, v or lambda, two numbers at a time.
#pragma once

#include <cstddef>
#include <vector>

#include "freeplay/span.h"

namespace freeplay {

/// Two neighbouring numbers of an array, which arithmetic takes one by one.
using Pair [[gnu::vector_size(16), gnu::aligned(8)]] = double;

/// Two numbers of an array, from `first` on; and one. No type is deduced: that would forget that pairs may stand at any
/// number.
struct TwoNumbers {
  std::size_t first;
  Pair& operator()(Span<double> all) const { return *reinterpret_cast<Pair*>(all.data + first); }
  Pair& operator()(std::vector<double>& all) const { return (*this)(Span<double>(std::span(all))); }
  const Pair& operator()(Span<const double> all) const { return *reinterpret_cast<const Pair*>(all.data + first); }
};
struct OneNumber {
  std::size_t first;
  double& operator()(Span<double> all) const { return all[first]; }
  double& operator()(std::vector<double>& all) const { return all[first]; }
  const double& operator()(Span<const double> all) const { return all[first]; }
};

/// Calls `body` with all of `size` numbers: two at a time, and the last one alone where their number
/// is odd. The results are those of a plain loop, to the bit; a dozen numbers take fewer instructions.
///
///   in_pairs(v.size, [&](auto at) { at(v) += dt * at(a); });
template <class Body>
inline void in_pairs(std::size_t size, Body&& body) {
  std::size_t i = 0;
  for (; i + 2 <= size; i += 2) body(TwoNumbers{i});
  if (i < size) body(OneNumber{i});
}

/// Largest absolute value of the `size` numbers that `term(at)` gives; no number where one is infinite or none.
///
///   largest_in_pairs(v.size, [&](auto at) { return at(scale) * at(v); });
template <class Term>
inline double largest_in_pairs(std::size_t size, Term&& term) {
  Pair most{}, nothing{};  // nothing: x - x
  std::size_t i = 0;
  for (; i + 2 <= size; i += 2) {
    const Pair x = term(TwoNumbers{i}), other = -x, magnitude = x < other ? other : x;
    nothing += x - x;
    most = most < magnitude ? magnitude : most;
  }
  double largest = most[0] < most[1] ? most[1] : most[0], none = nothing[0] + nothing[1];
  if (i < size) {
    const double x = term(OneNumber{i}), magnitude = x < 0.0 ? -x : x;
    none += x - x;
    if (largest < magnitude) largest = magnitude;
  }
  return largest + none;
}

}  // namespace freeplay
