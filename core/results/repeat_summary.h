// RepeatSummary: the figures of runs that differ by their starts, side by side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/json_text.h"

namespace freeplay {

/// Collects what runs 0 to runs - 1 found, in any order; 0 is the run that is written. Every number of the parts
/// `joints`, `drivers`, `forces` and `paths` of a summary is kept.
class RepeatSummary {
 public:
  RepeatSummary(std::size_t runs, std::uint64_t seed, double moved);

  /// The parts of a summary that add() looks at.
  static Json figures_of(const Json& summary);
  void add(std::size_t run, const Json& figures);
  void fail(std::size_t run, int exit_code, const std::string& reason);

  /// `repeat` of summary.json. Runs count from 1 there; values end with the last run that
  /// is known, and those of runs that are missing before it are null.
  Json json() const;

 private:
  struct Failure {
    std::size_t run;
    int exit_code;
    std::string reason;
  };
  struct Figure {
    std::string part, element, quantity;
    std::vector<Json> values;  // by run
  };
  std::vector<Failure> sorted_failures() const;

  std::size_t runs_, completed_ = 0, known_runs_ = 0;
  std::uint64_t seed_;
  double moved_;
  std::vector<Figure> figures_;  // in the order of the summary
  std::vector<Failure> failures_;
};

}  // namespace freeplay
