#include "base/text_place.h"

#include <algorithm>

#include "base/text.h"

namespace freeplay {

TextPlaces::TextPlaces(std::string_view text) : text_(text), line_starts_{0} {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') line_starts_.push_back(i + 1);
  }
}

TextPlace TextPlaces::at(std::size_t position) {
  position = std::min(position, text_.size());
  const auto next = std::upper_bound(line_starts_.begin(), line_starts_.end(), position);
  const int line = static_cast<int>(next - line_starts_.begin());
  const bool onward = line == last_place_.line && position >= last_;
  const std::size_t from = onward ? last_ : *(next - 1);
  const int column = (onward ? last_place_.column : 1) + character_count(text_.substr(from, position - from));
  last_ = position;
  last_place_ = {line, column};
  return last_place_;
}

}  // namespace freeplay
