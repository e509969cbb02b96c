// compare_tables: how far the tables of two studies agree.
#pragma once

#include <filesystem>

#include "results/comparison.h"
#include "study/open_study.h"

namespace freeplay {

struct ComparedStudy {
  const OpenStudy& study;
  std::filesystem::path folder;
};

/// Compares the reducers of the points that both have: the same runs by their hashes, whatever their numbers. `at_time`
/// of a difference is the number of the point in `a`. Throws Error{usage} "unknown-channel" when a pattern fits no
/// column, Error{input} "file-not-found" where there is no table.
Comparison compare_tables(const ComparedStudy& a, const ComparedStudy& b, const ComparisonRules& rules);

}  // namespace freeplay
