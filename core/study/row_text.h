// RowText: a point of a study as the lines of a segment.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "workers/outcome.h"

namespace freeplay {

/// What the rows of a study hold.
struct RowLayout {
  std::vector<StudyColumn> columns;  ///< of reducers
  std::vector<std::string> samples;  ///< reducers with many values
  bool chained = false;              ///< rows have the state that the next point begins with
};

/// The checksum at the end of a line: CRC-32 of zlib over the line up to and including the last tab.
std::uint32_t row_checksum(std::string_view text);
/// Appends the checksum and a line feed to the line that begins at `from` and ends with a tab.
void seal_line(std::string& out, std::size_t from);
/// The line without checksum and line feed, its last tab included; empty if the checksum is wrong.
std::string_view unsealed(std::string_view line);

/// Appends the lines of a point: samples, message and state, then the row that makes them count. `origin`: in a chain,
/// the place of the cold start that it goes back to.
void append_point(std::string& out, std::uint64_t index, const std::string& hash, const StudyOutcome& outcome,
                  const RowLayout& layout, std::uint64_t origin = 0);

}  // namespace freeplay
