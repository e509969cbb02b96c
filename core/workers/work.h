// StudyWork: what the engine of a study computes, by numbers alone.
#pragma once

#include <cstdint>
#include <string>

#include "workers/outcome.h"

namespace freeplay {

/// A unit is what one worker does in order: a point, or the points of a chain.
struct UnitPlace {
  std::uint64_t unit = 0, place = 0;
};

/// Points count from 0, units too, in the order in which they are to be done. What is computed from a number is
/// computed anew at each call: nothing grows with the points.
class StudyWork {
 public:
  virtual ~StudyWork() = default;

  virtual std::uint64_t points() const = 0;
  virtual std::uint64_t units() const = 0;
  /// Points of a unit, and which they are.
  virtual std::uint64_t unit_size(std::uint64_t unit) const = 0;
  virtual std::uint64_t unit_point(std::uint64_t unit, std::uint64_t place) const = 0;
  virtual UnitPlace place_of(std::uint64_t point) const = 0;
  /// Whether a point begins where the one before it in its unit has ended.
  virtual bool chained() const = 0;
  /// 24 hexadecimal digits.
  virtual std::string hash(std::uint64_t point) const = 0;

  /// Called in a worker process. Throws nothing for what is wrong at the point.
  virtual StudyOutcome run(std::uint64_t point, const std::string& state_before) = 0;
};

}  // namespace freeplay
