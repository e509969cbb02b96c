// RowScan: what the segments of a study say is done.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "study/point_set.h"
#include "study/row_text.h"
#include "study/segment_reader.h"
#include "workers/work.h"

namespace freeplay {

/// Points by what is known of them. Later segments do not undo what earlier ones say.
class RowScan {
 public:
  RowScan(const StudyWork& work, RowLayout layout) : work_(work), layout_(std::move(layout)) {}

  /// Reads the segments, in the order of their making. `accept` looks at their headers, throws for those of another
  /// study, and is false for those without rows of interest. `each` sees every row, in no order.
  void read(const std::vector<std::filesystem::path>& segments, const std::function<bool(const SegmentReader&)>& accept,
            const SegmentReader::Damage& damage, const std::function<void(const SegmentRow&)>& each = {});
  /// A row that has just been written.
  void note(std::uint64_t point, const StudyOutcome& outcome);

  /// Points with a row; those of them without a good one; those of these that were only killed.
  const PointSet& done() const { return done_; }
  const PointSet& failed() const { return failed_; }
  const PointSet& killed() const { return killed_; }

  /// State after the place before `place` in a chain, empty where the next one begins cold. Looks through the segments
  /// unless it is the last one known of its chain.
  std::string state_before(std::uint64_t unit, std::uint64_t place) const;

  /// Errors of the first failed points, by index.
  std::vector<std::pair<std::uint64_t, std::string>> first_failures(std::size_t most) const;

 private:
  void note(std::uint64_t point, bool good, bool killed, std::string_view error, std::string_view state);

  struct Last {
    std::uint64_t place;
    std::string state;
  };

  const StudyWork& work_;
  RowLayout layout_;
  std::vector<std::filesystem::path> segments_;
  PointSet done_, failed_, killed_;
  std::unordered_map<std::uint64_t, Last> last_;   // of chains that are not at their ends
  std::map<std::uint64_t, std::string> failures_;  // of the lowest indices
};

}  // namespace freeplay
