// Flights: when the surfaces of joints with play do not touch.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "results/reader.h"

namespace freeplay::plot {

class Flights {
 public:
  /// From the events of a result, which outlives this; flights shorter than `shortest` [s] are left out.
  Flights(ResultReader& reader, double from, double until, double shortest);

  /// Spans of time [s] of the joint that a channel belongs to; none where it has no contacts.
  std::vector<std::pair<double, double>> of_channel(const std::string& channel) const;

 private:
  struct Joint {
    double free_since = 0.0;
    bool free = false, seen = false;
    std::vector<std::pair<double, double>> spans;
  };
  const RecordLayout& layout_;  // a text file names its joints as they come
  std::vector<Joint> joints_;
};

}  // namespace freeplay::plot
