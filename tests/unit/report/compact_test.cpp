#include "report/compact.h"

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(Compact, LeavesOutCommentsIndentsAndBlanksBesideMarks) {
  EXPECT_EQ(compact("// Why.\nconst a = 1 + 2;  // Why.\n\n  // Why.\n  return a ? b : [c, d];\n", script_syntax),
            "const a=1+2;return a?b:[c,d];");
}

TEST(Compact, KeepsStringsAsTheyAre) {
  EXPECT_EQ(compact("f('a + b', \"c = ' d\", 'e\\' ; f') ;", script_syntax), "f('a + b',\"c = ' d\",'e\\' ; f');");
}

TEST(Compact, KeepsBlanksThatPartWordsAndSigns) {
  EXPECT_EQ(compact("return x - -y + +z in w", script_syntax), "return x- -y+ +z in w");
}

TEST(Compact, KeepsTheEndOfALineThatMayEndAStatement) {
  EXPECT_EQ(compact("const f = () => {\n  g(\n    1,\n    2)\n}\nh", script_syntax), "const f=()=>{g(1,2)}\nh");
}

TEST(Compact, LeavesBlanksOfStylesWhereTheyMeanSomething) {
  EXPECT_EQ(compact("a > b, c { margin: 0 1px; }\n@media (width: 1px) { d { e: f } }", style_syntax),
            "a > b,c{margin:0 1px}@media (width:1px){d{e:f}}");
}

TEST(Compact, LeavesOutWhatEndsAStatementBeforeTheEndOfABlock) {
  EXPECT_EQ(compact("if (a) { b(';}'); }\nelse {\n  c;\n}\n", script_syntax), "if(a){b(';}')}\nelse{c}");
}

TEST(Compact, LeavesOutLineFeedsBetweenTags) {
  EXPECT_EQ(compact("<p title=\"; }\">a\n  b; }</p>\n<p>c</p>\n", html_syntax), "<p title=\"; }\">a\nb; }</p><p>c</p>");
}

}  // namespace
}  // namespace freeplay
