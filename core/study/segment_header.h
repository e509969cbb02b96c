// SegmentHeader: the first line of a segment, which says what its rows are of.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace freeplay {

/// Which units: those whose number is `part` - 1 modulo `parts`.
struct Shard {
  std::uint64_t part = 1, parts = 1;

  bool has(std::uint64_t unit) const { return unit % parts == part - 1; }
  /// Whether some unit may be in both.
  bool meets(const Shard& other) const;
  friend bool operator==(const Shard&, const Shard&) = default;
};

struct SegmentHeader {
  std::string study, program, arithmetic;  ///< hashes; program: VERSION/BUILD
  Shard shard;
  std::string host;
  std::string started;  ///< UTC

  /// The line with its checksum and line feed.
  std::string text() const;
  /// Nothing if it is none.
  static std::optional<SegmentHeader> parse(std::string_view line);
};

}  // namespace freeplay
