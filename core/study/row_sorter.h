// RowSorter: rows of many segments in the order of their points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "study/segment_reader.h"

namespace freeplay {

/// A row that waits to be sorted: without the state of a chain, with the number of its segment.
struct SortedRow {
  std::uint64_t index = 0;
  std::uint32_t segment = 0;
  int exit_code = 0;
  std::string_view hash, error, wall, cpu, run, values, message, start;
  std::vector<std::string_view> samples;

  bool good() const { return exit_code == 0; }
};

/// Rows go to files by the range of their points; one after the other is read and sorted, and divided again where it is
/// too large: time is linear and memory flat. The files have no name: nothing stays of a program that is killed.
class RowSorter {
 public:
  /// `expected`: bytes of all rows.
  RowSorter(std::filesystem::path folder, std::uint64_t points, std::uint64_t expected);
  ~RowSorter();
  RowSorter(const RowSorter&) = delete;
  RowSorter& operator=(const RowSorter&) = delete;

  /// Throws Error{file} "cannot-write".
  void put(const SegmentRow& row, std::uint32_t segment);
  /// All rows of a point at once, in the order in which they were put. May be called once.
  using Visit = std::function<void(const std::vector<SortedRow>&)>;
  void visit(const Visit& each);

 private:
  class Bucket;
  void put(std::uint64_t index, std::string_view record);
  void visit(Bucket& bucket, const Visit& each) const;

  std::filesystem::path folder_;
  std::uint64_t first_, end_;  ///< points
  std::vector<std::unique_ptr<Bucket>> buckets_;
  std::string record_;

  RowSorter(std::filesystem::path folder, std::uint64_t first, std::uint64_t end, std::uint64_t expected);
};

}  // namespace freeplay
