#include "study/point_message.h"

#include <vector>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(PointMessage, NamesFilesWithoutTheirFolders) {
  const std::vector<std::string> folders = {"", "models/of me"};
  EXPECT_EQ(point_message("plugin '/a b/x.so' failed at '2 m/s'", folders), "plugin 'x.so' failed at '2 m/s'");
  EXPECT_EQ(point_message("the law's file 'models/of me/data/t.csv' ends", folders), "the law's file 't.csv' ends");
  EXPECT_EQ(point_message("'other/t.csv' and 'a", folders), "'other/t.csv' and 'a");
}

TEST(PointMessage, IsOneLine) { EXPECT_EQ(point_message("a\nb\x1b", {}).find_first_of("\n\x1b"), std::string::npos); }

}  // namespace
}  // namespace freeplay
