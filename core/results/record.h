// Record: rows and events of a run on their way into files, and what these files call them.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace freeplay {

struct RecordColumn {
  std::string name, unit;
  std::string long_name;  ///< a phrase for people
  std::string source;     ///< what computes it
};

/// What the files of a run hold. Numbers of an event stand in the order of its columns: time, index of the joint, index
/// of the kind, then fields, NaN where an event has none.
struct RecordLayout {
  std::vector<RecordColumn> columns;                            ///< of a row; the first is time
  std::vector<RecordColumn> events;                             ///< of an event; the first are time, joint and kind
  std::vector<std::string> joints, kinds;                       ///< words that events count
  std::vector<std::string> bearings;                            ///< joints with tables by bearing sector
  std::vector<std::pair<std::string, std::string>> attributes;  ///< of the whole, name and text
};

/// Some rows and events, each one after the other.
struct RecordBlock {
  std::span<const double> rows, events;
};

/// The same, collected.
struct RecordBuffer {
  std::vector<double> rows, events;

  operator RecordBlock() const { return {rows, events}; }
};

/// Rows that a file holds whatever comes after.
struct HeldRows {
  long count = 0;
  double last_time = 0.0;
};

/// One file that rows and events go to, used by one thread. The first failure is kept, and nothing is written after it.
class RecordWriter {
 public:
  virtual ~RecordWriter() = default;
  virtual void write(const RecordBlock& block) = 0;
  /// Hands over to the system what is held back.
  virtual void flush() = 0;
  /// The same, and tells the disk.
  virtual void sync() = 0;
  virtual void close() = 0;
  /// Notes as a failure that another program removed, replaced or changed the file.
  virtual void look_after() = 0;
  /// Whether that is the failure.
  virtual bool disturbed() const { return false; }
  /// What was handed over, at least; null for what holds no rows.
  virtual const HeldRows* held() const { return nullptr; }
  /// "cannot write 'DIR/FILE': REASON"; empty while all is well.
  virtual const std::string& failure() const = 0;
};

}  // namespace freeplay
