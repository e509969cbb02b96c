// TextPlace: line and column of a byte position.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace freeplay {

/// From 1; columns in characters.
struct TextPlace {
  int line = 1, column = 1;
};

/// Turns byte positions of a text into places. Fast for positions that rise, also within a very long line.
class TextPlaces {
 public:
  explicit TextPlaces(std::string_view text);
  TextPlace at(std::size_t position);

 private:
  std::string_view text_;
  std::vector<std::size_t> line_starts_;
  std::size_t last_ = 0;  // position of the last answer
  TextPlace last_place_;
};

}  // namespace freeplay
