#include "report/compact.h"

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(Compact, LeavesOutCommentsIndentsAndBlanksBesideMarks) {
  EXPECT_EQ(compact("// Why.\nconst a = 1 + 2;\n\n  // Why.\n  return a ? b : [c, d];\n", script_marks),
            "const a=1+2;return a?b:[c,d];");
}

TEST(Compact, KeepsStringsAsTheyAre) {
  EXPECT_EQ(compact("f('a + b', \"c = ' d\", 'e\\' ; f') ;", script_marks), "f('a + b',\"c = ' d\",'e\\' ; f');");
}

TEST(Compact, KeepsBlanksThatPartWordsAndSigns) {
  EXPECT_EQ(compact("return x - -y + +z in w", script_marks), "return x- -y+ +z in w");
}

TEST(Compact, KeepsTheEndOfALineThatMayEndAStatement) {
  EXPECT_EQ(compact("const f = () => {\n  g(\n    1,\n    2)\n}\nh", script_marks), "const f=()=>{g(1,2)\n}\nh");
}

TEST(Compact, LeavesBlanksOfStylesWhereTheyMeanSomething) {
  EXPECT_EQ(compact("a > b, c { margin: 0 1px; }\n@media (width: 1px) { d { e: f } }", style_marks),
            "a > b,c{margin:0 1px;}\n@media (width:1px){d{e:f}}");
}

}  // namespace
}  // namespace freeplay
