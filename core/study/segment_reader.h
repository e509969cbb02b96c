// SegmentReader: the rows of a segment, one after the other, in memory that does not grow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/row_text.h"
#include "study/segment_header.h"

namespace freeplay {

/// A point as it was written. Texts are valid until the next one is read.
struct SegmentRow {
  std::uint64_t index = 0;
  int exit_code = 0;
  std::string_view hash, error, wall, cpu, run;
  std::string_view values;                ///< apart by tabs, one for each column; empty of a failed point
  std::vector<std::string_view> samples;  ///< of each list the fields time:value, apart by tabs
  std::string_view message;               ///< of a failed point
  std::string_view start, state;          ///< in a chain
  std::uint64_t origin = 0;               ///< in a chain: place of the cold start that it goes back to

  bool good() const { return exit_code == 0; }
  /// An administrator or a lack of memory ended its worker: no fact about the point.
  bool killed() const { return error == "killed"; }
};

class SegmentReader {
 public:
  /// Gets the number of each line that is damaged.
  using Damage = std::function<void(const std::filesystem::path&, std::size_t line)>;
  /// Throws Error{file} "file-not-found" where it cannot be read.
  explicit SegmentReader(std::filesystem::path path, Damage damage);
  ~SegmentReader();
  SegmentReader(const SegmentReader&) = delete;
  SegmentReader& operator=(const SegmentReader&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Nothing where the first line is not whole: the segment then has no rows.
  const std::optional<SegmentHeader>& header() const { return header_; }
  /// The next row that is whole, or null.
  const SegmentRow* next(const RowLayout& layout);

 private:
  struct Line {
    std::size_t from = 0, size = 0;  ///< in the buffer, without checksum
  };
  bool read_line(std::string_view& line, bool& last);
  bool refill();
  void damaged();
  bool take(std::string_view row, const RowLayout& layout);

  std::filesystem::path path_;
  Damage damage_;
  int descriptor_ = -1;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, at_ = 0, end_ = 0;  ///< of the lines that wait for their row, of the next line, of all
  bool ended_ = false, hurt_ = false;
  std::size_t line_number_ = 0;
  std::vector<Line> waiting_;
  std::optional<SegmentHeader> header_;
  SegmentRow row_;
};

}  // namespace freeplay
