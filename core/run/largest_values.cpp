#include "run/largest_values.h"

#include <algorithm>
#include <limits>

namespace freeplay {
namespace {

constexpr double nothing = -std::numeric_limits<double>::infinity();

void raise(std::span<const double> values, std::vector<double>& largest) {
  for (std::size_t i = 0; i < values.size(); ++i) largest[i] = std::max(largest[i], values[i]);
}

}  // namespace

LargestValues::LargestValues(const Model& model, const Channels& channels)
    : places_(model, channels),
      noise_(model, places_),
      last_(places_.size()),
      window_(places_.size(), nothing),
      before_(places_.size(), nothing),
      written_(places_.size(), nothing),
      of_written_(places_.size()) {}

void LargestValues::see(std::span<const double> row, double t, bool counts) {
  places_.of(row, last_);
  raise(last_, counts ? window_ : before_);
  if (counts) noise_.see(t, last_);
}

void LargestValues::note_written() { raise(last_, written_); }

void LargestValues::note_written_later(std::span<const double> row) {
  places_.of(row, of_written_);
  raise(of_written_, written_);
}

}  // namespace freeplay
