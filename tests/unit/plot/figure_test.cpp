#include "plot/figure.h"

#include <gtest/gtest.h>

namespace freeplay::plot {
namespace {

Figure one_line(std::vector<Point> points) {
  Panel panel;
  panel.channel = panel.title = "joint.<a>.fn";
  panel.unit = "N";
  panel.x = svg::make_axis(0.0, 1.0, "s", 5.0, svg::Fit::exact);
  panel.y = svg::make_axis(0.0, 2.0, "N", 5.0, svg::Fit::round);
  Line line{std::move(points), {}, 3};
  for (const Point& point : line.points) line.seen.add(point.x, point.y);
  panel.lines.push_back(std::move(line));
  Figure figure;
  figure.title = "a & b";
  figure.names = {"r"};
  figure.panels.push_back(std::move(panel));
  return figure;
}

TEST(FigureSvg, EscapesNames) {
  const std::string text = figure_svg(one_line({{0.0, 0.0}, {1.0, 2.0}}), {});
  EXPECT_NE(std::string::npos, text.find("joint.&lt;a&gt;.fn"));
  EXPECT_NE(std::string::npos, text.find("<title>a &amp; b</title>"));
}

TEST(FigureSvg, IsWrittenInMillimetresForPaper) {
  const PageSize paper{84.0 * 96.0 / 25.4, 240.0, true};
  EXPECT_NE(std::string::npos, figure_svg(one_line({{0.0, 0.0}, {1.0, 2.0}}), paper).find("width=\"84mm\""));
}

TEST(FigureSvg, SaysSoWhereAChannelHasNoNumbers) {
  const std::string text = figure_svg(one_line({}), {});
  EXPECT_NE(std::string::npos, text.find("no numbers"));
  EXPECT_EQ(std::string::npos, text.find("class=\"line\""));
}

TEST(FigureSvg, DrawsOneRowAsADot) {
  EXPECT_NE(std::string::npos, figure_svg(one_line({{0.5, 1.0}}), {}).find("class=\"line\" d=\"M478.00 "));
}

TEST(FigureAsText, PutsTheLeastValueBelowAndTheLargestAbove) {
  const std::string text = figure_text(one_line({{0.0, 0.0}, {1.0, 2.0}}), 2, false);
  EXPECT_EQ("joint.<a>.fn [N]  0 ... 2  (3 rows)\n *\n *\n *\n *\n *\n *\n*\n*\n*\n*\n*\n*\n0 ... 1\n", text);
  const std::string braille = figure_text(one_line({{0.0, 0.0}, {1.0, 2.0}}), 1, true);
  EXPECT_NE(std::string::npos, braille.find("(3 rows)\n⢸\n")) << braille;
}

}  // namespace
}  // namespace freeplay::plot
