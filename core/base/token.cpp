#include "base/token.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <limits>
#include <system_error>

#include "base/text.h"

namespace freeplay {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

std::size_t digits_end(std::string_view text, std::size_t position) {
  while (position < text.size() && is_digit(text[position])) ++position;
  return position;
}

std::size_t exponent_end(std::string_view text, std::size_t position) {
  std::size_t at = position;
  if (at >= text.size() || (text[at] != 'e' && text[at] != 'E')) return position;
  ++at;
  if (at < text.size() && (text[at] == '+' || text[at] == '-')) ++at;
  const std::size_t end = digits_end(text, at);
  return end > at ? end : position;  // "2 e" is no exponent; the e is then judged as a unit
}

/// By the place of the first digit that counts and the exponent.
bool is_below_one(std::string_view number) {
  const std::string_view digits = number.substr(0, number.find_first_of("eE"));
  const auto first = static_cast<std::ptrdiff_t>(std::min(digits.find_first_of("123456789"), digits.size()));
  const auto point = static_cast<std::ptrdiff_t>(std::min(digits.find('.'), digits.size()));
  std::string_view power = number.substr(std::min(digits.size() + 1, number.size()));
  if (power.starts_with('+')) power.remove_prefix(1);
  std::ptrdiff_t exponent = 0;
  const auto result = std::from_chars(power.data(), power.data() + power.size(), exponent);
  if (result.ec == std::errc::result_out_of_range) return power.starts_with('-');
  return exponent + point - first < (first < point ? 1 : 0);
}

}  // namespace

std::size_t skip_blanks(std::string_view text, std::size_t position) {
  while (position < text.size() &&
         (text[position] == ' ' || text[position] == '\t' || text[position] == '\n' || text[position] == '\r')) {
    ++position;
  }
  return position;
}

std::size_t word_end(std::string_view text, std::size_t position) {
  if (position < text.size() && is_digit(text[position])) return position;
  while (position < text.size()) {
    const char c = text[position];
    if (is_letter(c) || is_digit(c)) {
      ++position;
    } else if (static_cast<unsigned char>(c) >= 0x80) {
      const std::size_t length = character_bytes(text, position);
      // U+2000 to U+2FFF are symbols and punctuation such as the true minus sign, not letters.
      if (length == 0 || static_cast<unsigned char>(c) == 0xE2) break;
      position += length;
    } else {
      break;
    }
  }
  return position;
}

std::size_t number_end(std::string_view text, std::size_t position) {
  const std::size_t whole = digits_end(text, position);
  std::size_t end = whole;
  if (end < text.size() && text[end] == '.') {
    end = digits_end(text, end + 1);
    if (whole == position && end == whole + 1) return position;  // a point alone
  }
  return end == position ? position : exponent_end(text, end);
}

double number_value(std::string_view number) {
  double value = 0.0;
  const auto result = std::from_chars(number.data(), number.data() + number.size(), value);
  if (result.ec != std::errc::result_out_of_range) return value;
  // from_chars does not say which way it failed.
  return is_below_one(number) ? 0.0 : std::numeric_limits<double>::infinity();
}

}  // namespace freeplay
