// RepeatWork: the runs of `freeplay run --repeat` beside the one that is written, each by its number.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "model/model.h"
#include "workers/work.h"

namespace freeplay {

struct RepeatPlan {
  std::size_t runs = 0;  ///< in all, with that of the model's own start; 0: the run is not repeated
  std::uint64_t seed = 1;
};

/// What --repeat and --seed say, empty where they are not given. Throws Error{usage} "bad-value" or "usage".
RepeatPlan repeat_plan(const std::string& repeat, const std::string& seed);

/// Throws Error{usage}: "nothing-to-repeat" for a model in which nothing can touch, "usage" where it asks for another
/// start than the first.
void require_repeatable(const Model& model);

/// A study with one axis, the number of the start in the play: point p is run p + 1. A run gives the figures of its
/// summary.
class RepeatWork final : public StudyWork {
 public:
  /// The model outlives it. A run ends, as one that failed, once `stop` is not 0; it may be null.
  RepeatWork(const Model& model, const RepeatPlan& plan, const std::atomic<int>* stop = nullptr)
      : model_(model), plan_(plan), stop_(stop) {}

  std::uint64_t points() const override { return plan_.runs - 1; }
  std::uint64_t units() const override { return points(); }
  std::uint64_t unit_size(std::uint64_t) const override { return 1; }
  std::uint64_t unit_point(std::uint64_t unit, std::uint64_t) const override { return unit; }
  UnitPlace place_of(std::uint64_t point) const override { return {point, 0}; }
  bool chained() const override { return false; }
  std::string hash(std::uint64_t) const override { return {}; }
  StudyOutcome run(std::uint64_t point, const std::string& state_before) override;

 private:
  const Model& model_;
  RepeatPlan plan_;
  const std::atomic<int>* stop_;
};

}  // namespace freeplay
