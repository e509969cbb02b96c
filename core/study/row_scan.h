// RowScan: what the segments of a study say is done.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "study/point_set.h"
#include "study/row_text.h"
#include "study/segment_reader.h"
#include "workers/work.h"

namespace freeplay {

/// Points by what is known of them. Later segments do not undo what earlier ones say.
///
/// In a chain a row counts where it began as the row before it that counts has ended: cold after a failed one, else
/// from the same cold start, its origin. Once a failed point has a good row, the rows after it do not count any more
/// and their points are not done: in the end there are the rows of a chain that nothing disturbed. Points of a chain
/// are done without gaps, from its first on.
class RowScan {
 public:
  RowScan(const StudyWork& work, RowLayout layout) : work_(work), layout_(std::move(layout)) {}

  /// Reads the segments. `accept` looks at their headers, throws for those of another study, and is false for those
  /// without rows of interest.
  void read(const std::vector<std::filesystem::path>& segments, const std::function<bool(const SegmentReader&)>& accept,
            const SegmentReader::Damage& damage);
  /// A row that has just been computed, with running_origin().
  void note(std::uint64_t point, const StudyOutcome& outcome);
  /// Where a row that has just been computed goes back to. Of a point that has a good row already it need not count: if
  /// the point before it has failed this time, it began cold.
  std::uint64_t running_origin(std::uint64_t point) const;

  /// Points with a row that counts; those of them without a good one; those of these that were only killed.
  const PointSet& done() const { return done_; }
  const PointSet& failed() const { return failed_; }
  const PointSet& killed() const { return killed_; }

  /// Place in its chain of the cold start that a row of the point goes back to, if it is to count; 0 without chains.
  std::uint64_t origin(std::uint64_t point) const;
  /// A failed one does although there is a good one of the same origin.
  bool counts(const SegmentRow& row) const;
  /// Reads the segments once more.
  void each_that_counts(const std::function<void(const SegmentRow&)>& each) const;

  /// State after the place before `place` in a chain, empty where the next one begins cold. Looks through the segments
  /// unless it is the last one known of its chain.
  std::string state_before(std::uint64_t unit, std::uint64_t place) const;

  /// Errors of the first failed points, by index.
  std::vector<std::pair<std::uint64_t, std::string>> first_failures(std::size_t most) const;

 private:
  struct Fact {
    bool good, killed;
    std::string error;
  };
  struct Last {
    std::uint64_t place, next_origin;
    std::string state;
  };
  struct Running {
    std::uint64_t place, origin;
  };

  void note(std::uint64_t point, std::uint64_t origin, const Fact& fact, std::string_view state);
  void count(std::uint64_t point, const Fact& fact);
  void forget(std::uint64_t point);
  void learn(std::uint64_t point, std::uint64_t origin, const Fact& fact);
  const Fact* known(std::uint64_t point, std::uint64_t origin) const;
  std::uint64_t length(std::uint64_t unit) const;
  std::uint64_t origin_at(std::uint64_t unit, std::uint64_t place) const;
  void settle(std::uint64_t unit, std::uint64_t place);

  const StudyWork& work_;
  RowLayout layout_;
  std::vector<std::filesystem::path> segments_;
  PointSet done_, failed_, killed_;
  std::map<std::uint64_t, std::string> failures_;  // of the lowest indices
  // Of chains:
  PointSet unbroken_;                                               // with a good row of origin 0
  std::map<std::pair<std::uint64_t, std::uint64_t>, Fact> others_;  // all other rows, by point and origin
  std::set<std::pair<std::uint64_t, std::uint64_t>> cold_again_;    // unit and place after each failed row that counts
  std::unordered_map<std::uint64_t, Last> last_;                    // of those that are not at their ends
  std::unordered_map<std::uint64_t, Running> running_;              // of those of which rows are noted: what comes next
};

}  // namespace freeplay
