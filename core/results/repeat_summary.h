// RepeatSummary: the figures of runs that differ by their starts, side by side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "run/play_start.h"

namespace freeplay {

/// Collects what runs 0 to runs - 1 found, in any order; 0 is the run that is written. Every number of the parts
/// `joints`, `drivers`, `forces` and `paths` of a summary is kept.
class RepeatSummary {
 public:
  RepeatSummary(std::size_t runs, std::uint64_t seed, StartChange change);

  /// What is kept of a summary, in its order; NaN: none. Summaries of one model have the same numbers.
  static std::vector<double> values_of(const Json& summary);
  void add(std::size_t run, std::vector<double> values);
  void fail(std::size_t run, int exit_code, const std::string& reason);

  /// `repeat` of summary.json; `first`, the summary of any of the runs, has the names. Runs count from 1 there; values
  /// end with the last run that is known, and those of runs that are missing before it are null.
  Json json(const Json& first) const;

 private:
  struct Failure {
    std::size_t run;
    int exit_code;
    std::string reason;
  };
  std::vector<Failure> sorted_failures() const;

  std::size_t runs_, completed_ = 0;
  std::uint64_t seed_;
  StartChange change_;
  std::vector<std::vector<double>> values_;  // by run, as far as they are known
  std::vector<Failure> failures_;
};

}  // namespace freeplay
