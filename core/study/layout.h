// StudyLayout: which values a point of a study has, and in which order points are run, by their numbers alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "format/study_section.h"
#include "study/planned_axis.h"
#include "workers/work.h"

namespace freeplay {

/// Where a point is among the values of the axes.
struct PlacedPoint {
  std::size_t model = 0;
  std::uint64_t sample = 0;
  bool down = false;                                 ///< its chain goes downwards there
  std::vector<std::optional<std::uint64_t>> places;  ///< by axis: number of its value, or it sets nothing
};

/// Points count with the model slowest, then directions of chains, axes in order, and samples fastest of all. Memory
/// does not grow with them.
class StudyLayout {
 public:
  /// `present` of the axes is filled. Reports axes of different length that go side by side, and more points than
  /// there may be: many_points, or most_points with `many`. Both outlive it.
  StudyLayout(const StudySection& section, const std::vector<PlannedAxis>& axes, std::size_t models, bool many);

  std::uint64_t points() const { return points_; }
  std::uint64_t samples() const { return samples_; }
  PlacedPoint at(std::uint64_t point) const;

  /// Units: a point, or a chain; by sample first where there is a rule for the end.
  std::uint64_t units() const { return bases_ * samples_; }
  std::uint64_t unit_size(std::uint64_t unit) const;
  std::uint64_t unit_point(std::uint64_t unit, std::uint64_t place) const;
  UnitPlace place_of(std::uint64_t point) const;
  bool chained() const { return chain_digit_.has_value(); }

 private:
  /// Axes that change together; of a model that has none of them the size is 1.
  struct Digit {
    std::vector<std::size_t> axes;
    std::uint64_t size = 1;
  };
  struct Part {
    std::vector<Digit> digits;
    std::uint64_t combinations = 1, first_point = 0;
    std::uint64_t bases = 1, first_base = 0;  ///< units of one sample
    std::uint64_t stride = 1;                 ///< of the digit that chains go along
  };
  struct Span {
    std::uint64_t begin, end;
  };
  /// A unit without its sample.
  struct Base {
    const Part* part;
    std::uint64_t other = 0;  ///< number of the combination of what does not change along the chain
    std::uint64_t piece = 0;
    std::uint64_t sample = 0;
  };

  std::vector<std::vector<std::size_t>> groups() const;
  void count(std::size_t models, bool many);
  bool check_lengths(const std::vector<std::vector<std::size_t>>& groups) const;
  bool too_many(bool many) const;
  std::string product_text() const;
  const Part& part_of_point(std::uint64_t point) const;
  Base base_of(std::uint64_t unit) const;
  std::uint64_t unit_of(std::uint64_t base, std::uint64_t sample) const;
  std::uint64_t pieces(const Part& part) const;
  Span span(const Part& part, std::uint64_t piece) const;
  std::uint64_t point_of(const Part& part, std::uint64_t direction, std::uint64_t combination,
                         std::uint64_t sample) const;

  const StudySection& section_;
  const std::vector<PlannedAxis>& axes_;
  std::vector<Part> parts_;
  std::optional<std::size_t> chain_digit_;
  bool star_;
  std::uint64_t samples_ = 1, directions_ = 1, points_ = 0, bases_ = 0;
  bool by_sample_;
};

}  // namespace freeplay
