#include "base/number_text.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

std::string by_standard(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

void expect_standard(double value) { EXPECT_EQ(number_text(value), by_standard(value)); }

TEST(NumberText, IsThatOfTheStandardForAllBitPatterns) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200000; ++i) {
    const std::uint64_t bits = random();
    double value;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isnan(value)) expect_standard(value);
  }
}

TEST(NumberText, IsThatOfTheStandardForNumbersOfModels) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 200000; ++i) {
    const double value = std::ldexp(static_cast<double>(random() >> 11), -53) *
                         std::pow(10.0, static_cast<double>(random() % 50) - 25.0);
    for (const double one : {value, -std::round(value), std::round(1e4 * value) / 1e4}) expect_standard(one);
  }
}

TEST(NumberText, IsThatOfTheStandardForRoundNumbers) {
  for (int power = -323; power < 308; ++power) {
    for (int digits = 1; digits < 130; ++digits) expect_standard(digits * std::pow(10.0, power));
  }
}

TEST(NumberText, HasSignsOfZeroAndInfinityAndNothingOfWhatIsNoNumber) {
  const double none = std::numeric_limits<double>::quiet_NaN(), all = std::numeric_limits<double>::infinity();
  EXPECT_EQ(number_text(0.0), "0");
  EXPECT_EQ(number_text(-0.0), "-0");
  EXPECT_EQ(number_text(all), "inf");
  EXPECT_EQ(number_text(-all), "-inf");
  EXPECT_EQ(number_text(none), "");
}

}  // namespace
}  // namespace freeplay
