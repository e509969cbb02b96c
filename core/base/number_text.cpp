#include "base/number_text.h"

#include <charconv>
#include <cmath>

namespace freeplay {

void append_number(std::string& out, double value) {
  if (std::isnan(value)) return;
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  out.append(digits, end);
}

std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

}  // namespace freeplay
