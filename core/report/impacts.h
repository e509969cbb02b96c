// Impacts: the contacts that ended, and every row around the largest.
#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "report/courses.h"
#include "results/reader.h"

namespace freeplay {

/// A contact that ended, as a row of events.
struct Impact {
  std::vector<double> numbers;
  std::string joint;
  double begin = 0.0, end = 0.0, force = 0.0;
};

/// Contacts of a result that ended within a window of time. Without events there are none.
class Impacts {
 public:
  Impacts(ResultReader& reader, const RowWindow& window);

  /// By largest force, those of equal force in order of time.
  const std::vector<Impact>& largest() const { return impacts_; }
  /// `{columns, rows, total}`: the `most` largest, in order of time.
  Json json(std::size_t most) const;

 private:
  std::vector<std::string> columns_, kinds_;
  std::vector<Impact> impacts_;
};

/// Which channels of a course belong to a joint.
struct JointChannels {
  std::string joint;
  std::vector<std::size_t> channels;
};

/// Rows around impacts, where buckets hold the rest.
class ImpactWindows {
 public:
  /// Windows of at most 64 rows, `interval` apart, around the 20 largest of each joint, at most so many numbers in all.
  ImpactWindows(const Impacts& impacts, std::span<const JointChannels> joints, double interval, std::size_t numbers);

  /// The next row, as Courses has it.
  void row(std::span<const double> row);
  /// Characters of json(), at most.
  std::size_t size(std::span<const std::string> names) const;
  /// `names` of the channels; `courses` has their offsets.
  Json json(const Courses& courses, std::span<const std::string> names) const;

 private:
  struct Window {
    const JointChannels* joint;
    double from, until;
    std::size_t most_rows, first = 0;
    std::vector<double> times{}, values{};  // row after row
  };

  std::vector<Window> windows_;     // largest impact first
  std::vector<std::size_t> order_;  // of their begins
  std::vector<std::size_t> open_;
  std::size_t next_ = 0, row_ = 0;
};

}  // namespace freeplay
