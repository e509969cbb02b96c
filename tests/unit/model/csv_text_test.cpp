#include "model/csv_text.h"

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
  for (const char* bad : {"", "1 2", "1;5", "nan", "inf", "1e999", "0x10", "1,5"}) EXPECT_FALSE(csv_number(bad)) << bad;
}

}  // namespace
}  // namespace freeplay
