#include "format/csv_text.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(CsvText, SkipsCommentsEmptyLinesAndBlanks) {
  const CsvText csv("t.csv", "\xEF\xBB\xBF# motor\n\n time , angle,note\r\n0, 1.5 ,a\n  # more\n1,2\n");
  EXPECT_EQ(csv.names(), (std::vector<std::string>{"time", "angle", "note"}));
  ASSERT_EQ(csv.rows(), 2u);
  EXPECT_EQ(csv.field(0, 1).text, "1.5");
  EXPECT_EQ(csv.field(0, 1).location.line, 4);
  EXPECT_EQ(csv.field(0, 1).location.column, 4);
  EXPECT_EQ(csv.field(1, 2).text, "");
  EXPECT_EQ(csv.field(1, 1).location.line, 6);
}

TEST(CsvText, ReadsNumbersWithAPointOnly) {
  EXPECT_EQ(csv_number("-1.5e-3"), -1.5e-3);
  EXPECT_EQ(csv_number("+2"), 2.0);
  for (const char* bad : {"", "1 2", "1;5", "nan", "inf", "0x10", "1,5"}) EXPECT_FALSE(csv_number(bad)) << bad;
}

TEST(CsvText, DistinguishesNumbersTooLargeFromNumbersTooSmall) {
  EXPECT_EQ(csv_number("1e999"), HUGE_VAL);
  EXPECT_EQ(csv_number("-0.001e999"), -HUGE_VAL);
  EXPECT_EQ(csv_number("1e-400"), 0.0);
  EXPECT_EQ(csv_number("-1" + std::string(400, '0') + "e-50"), -HUGE_VAL);
  EXPECT_EQ(csv_number("1" + std::string(400, '0') + "e-800"), 0.0);
}

TEST(CsvText, EndsLinesAtCarriageReturnsToo) {
  const CsvText csv("t.csv", "time,angle\r0,1\r1,2\r\n2,3\r");
  ASSERT_EQ(csv.rows(), 3u);
  EXPECT_EQ(csv.field(1, 1).text, "2");
  EXPECT_EQ(csv.field(2, 0).location.line, 4);
}

TEST(CsvText, DistinguishesAZeroByteFromBytesThatAreNotUtf8) {
  EXPECT_EQ(CsvText("t.csv", std::string("t,v\n0,0\0\n", 9)).foreign_byte()->text, std::string_view("\0", 1));
  EXPECT_EQ(CsvText("t.csv", "t,v\n0,\xFF\n").foreign_byte()->text, "\xFF");
}

}  // namespace
}  // namespace freeplay
