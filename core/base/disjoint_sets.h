// DisjointSets: numbered things that are united to sets, step by step.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "base/index.h"

namespace freeplay {

/// Of `count` things, each a set of its own at first.
class DisjointSets {
 public:
  explicit DisjointSets(int count) : parent_(at(count)) { std::iota(parent_.begin(), parent_.end(), 0); }

  /// The smallest member of the set of `i`.
  int root(int i) {
    while (parent_[at(i)] != i) i = parent_[at(i)] = parent_[at(parent_[at(i)])];
    return i;
  }
  bool together(int a, int b) { return root(a) == root(b); }
  /// False where they were together already.
  bool unite(int a, int b) {
    const auto [first, second] = std::minmax({root(a), root(b)});
    parent_[at(second)] = first;
    return first != second;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace freeplay
