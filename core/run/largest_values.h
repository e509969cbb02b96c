// LargestValues: the largest of the numbers that tables and summaries show, in the window of the statistics and before
// it.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "run/peak_noise.h"
#include "run/peak_values.h"

namespace freeplay {

/// All lists are by PeakValues. Before the first row values are negative.
class LargestValues {
 public:
  LargestValues(const Model& model, const Channels& channels);

  /// A row at the time t, in the window if it `counts`.
  void see(std::span<const double> row, double t, bool counts);
  /// The row that was seen last is also written to the result.
  void note_written();
  /// The same of any row that was seen.
  void note_written_later(std::span<const double> row);
  /// Of a step before the window that no row is made of: one of its values.
  void raise_before(std::size_t value, double to) { before_[value] = std::max(before_[value], to); }
  /// Any event of a joint, with its fields.
  void note_event(int joint, int event, std::span<const double> fields) { noise_.event(joint, event, fields); }
  /// See PeakNoise.
  void note_growth(std::span<const double> grown) { noise_.differences_grow(grown); }

  /// Which value stands where.
  const PeakValues& places() const { return places_; }
  const PeakNoise& noise() const { return noise_; }       ///< of those in the window
  std::span<const double> last() const { return last_; }  ///< of the last row, not the largest ones
  std::span<const double> in_window() const { return window_; }
  std::span<const double> written() const { return written_; }  ///< of rows of the result in the window
  /// Before the window. Of written rows alone where nothing can touch.
  std::span<const double> before() const { return before_; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.noise_, self.last_, self.window_, self.before_, self.written_);
  }

 private:
  PeakValues places_;
  PeakNoise noise_;
  std::vector<double> last_, window_, before_, written_, of_written_;
};

}  // namespace freeplay
