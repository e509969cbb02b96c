#include "base/number_text.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/compile.h>

namespace freeplay {
namespace {

constexpr double largest_with_all_integers = 9007199254740992.0;  // 2^53

std::size_t size(int count) { return static_cast<std::size_t>(count); }

/// The shortest digits that read back, and the power of ten of the last of them.
struct Decimal {
  char digits[24];
  int count = 0, exponent = 0;
};

/// `text` is a positive number, as "0.0125" or "1.25e-07".
Decimal decimal(const char* text, const char* end) {
  Decimal out;
  const char* const mantissa_end = std::find(text, end, 'e');
  if (mantissa_end != end) out.exponent = std::atoi(mantissa_end + 1);
  bool fraction = false;
  for (const char* c = text; c != mantissa_end; ++c) {
    if (*c == '.') {
      fraction = true;
      continue;
    }
    if (fraction) --out.exponent;
    if (out.count > 0 || *c != '0') out.digits[out.count++] = *c;
  }
  for (; out.count > 1 && out.digits[out.count - 1] == '0'; --out.count) ++out.exponent;
  return out;
}

/// As 12.5, 0.0125 or 12500.
void append_fixed(std::string& out, const Decimal& number) {
  const int before = number.count + number.exponent;  // digits before the point
  if (before <= 0) {
    out.append("0.").append(size(-before), '0').append(number.digits, size(number.count));
  } else if (number.exponent >= 0) {
    out.append(number.digits, size(number.count)).append(size(number.exponent), '0');
  } else {
    out.append(number.digits, size(before)).append(1, '.');
    out.append(number.digits + before, size(number.count - before));
  }
}

/// As 1.25e-07, with two digits of the exponent at least.
void append_scientific(std::string& out, const Decimal& number) {
  out.append(number.digits, 1);
  if (number.count > 1) out.append(1, '.').append(number.digits + 1, size(number.count - 1));
  char text[16];
  const char* const end = fmt::format_to(text, FMT_COMPILE("e{:+03d}"), number.exponent + number.count - 1);
  out.append(text, size(static_cast<int>(end - text)));
}

/// The shorter of both forms, fixed where they are as long; whole numbers in fixed form have all of their digits.
void append_shorter(std::string& out, const Decimal& number, double amount) {
  const bool single = number.count == 1;
  const int least = single ? -3 : -(number.count + 3), most = single ? 4 : 5;
  if (number.exponent < least || number.exponent > most) {
    append_scientific(out, number);
  } else if (number.exponent > 0 && amount > largest_with_all_integers) {
    char text[32];
    const char* const end = fmt::format_to(text, FMT_COMPILE("{:.0f}"), amount);
    out.append(text, size(static_cast<int>(end - text)));
  } else {
    append_fixed(out, number);
  }
}

}  // namespace

// The forms are those of std::to_chars, which would bring 100 kB of tables for numbers of digits that nothing asks for.
void append_number(std::string& out, double value) {
  if (std::isnan(value)) return;
  char text[32];
  char* const end = fmt::format_to(text, FMT_COMPILE("{}"), value);
  const double amount = std::abs(value);
  const bool same_form = amount < 9e-5 || (amount >= 1e-3 && amount < 1e5) || std::isinf(amount);
  if (same_form) {
    out.append(text, size(static_cast<int>(end - text)));
    return;
  }
  *end = '\0';
  const bool negative = text[0] == '-';
  if (negative) out.append(1, '-');
  append_shorter(out, decimal(text + (negative ? 1 : 0), end), amount);
}

std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

}  // namespace freeplay
