#include "study/picture_page.h"

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace freeplay {
namespace {

/// Points of the discs in a picture of these marks.
std::vector<int> shown(const std::vector<PictureMark>& marks) {
  std::vector<double> x, y;
  for (const PictureMark& mark : marks) x.push_back(mark.x), y.push_back(mark.y);
  PicturePage page("marks", PictureScale("x", x, "", svg::Fit::exact), PictureScale("y", y, "", svg::Fit::round));
  page.marks(marks, 0, 1.0);
  const std::string text = page.text();
  std::vector<int> points;
  const std::regex disc("<circle data-point=\"(\\d+)\"");
  for (std::sregex_iterator at(text.begin(), text.end(), disc), end; at != end; ++at) {
    points.push_back(std::stoi((*at)[1]));
  }
  return points;
}

/// At each of `columns` places x twelve values that alternate between -1 and 1.
std::vector<PictureMark> branches(int columns) {
  std::vector<PictureMark> marks;
  for (int i = 0; i < 12 * columns; ++i) {
    marks.push_back({static_cast<double>(i / 12), i % 2 == 0 ? -1.0 : 1.0, static_cast<std::uint64_t>(i)});
  }
  return marks;
}

TEST(PicturePage, ShowsEachOfFewMarks) { EXPECT_EQ(shown(branches(20)).size(), 240U); }

TEST(PicturePage, ShowsBothBranchesOfAForkWithTooManyMarks) {
  const std::vector<int> points = shown(branches(1700));  // of which every sixth is on one branch
  EXPECT_LE(points.size(), PicturePage::most_marks);
  const auto upper = std::ranges::count_if(points, [](int point) { return point % 2 == 1; });
  EXPECT_EQ(upper, static_cast<long>(points.size()) - upper);
  EXPECT_GT(upper, 100);
}

TEST(PicturePage, LosesNoMarkThatStandsApart) {
  std::vector<PictureMark> marks = branches(2000);
  marks[13'337].y = 0.3;
  const std::vector<int> points = shown(marks);
  EXPECT_TRUE(std::ranges::find(points, 13'337) != points.end());
}

/// Of a picture whose upright axis has these words.
double left_edge(const std::vector<std::string>& words) {
  const std::string text =
      PicturePage("words", PictureScale("x", {0.0, 1.0}, "", svg::Fit::exact), PictureScale("y", words)).text();
  std::smatch frame;
  EXPECT_TRUE(std::regex_search(text, frame, std::regex("<rect x=\"([0-9.]+)\"[^>]*fill=\"none\"")));
  return std::stod(frame[1]);
}

TEST(PicturePage, HasRoomForLongNamesOnItsLeft) {
  const std::string name = "joints.leg1.B.clearance.radial_clearance";
  EXPECT_GT(left_edge({name, "c"}), 6.0 * static_cast<double>(name.size()));
  EXPECT_LT(left_edge({"a", "c"}), 100.0);
  EXPECT_LT(left_edge({std::string(500, 'x')}), 400.0);
}

TEST(PicturePage, LegendsOfManyFamiliesStayOnThePage) {
  const PictureScale numbers("x", {0.0, 1.0}, "", svg::Fit::exact);
  const std::string text =
      PicturePage("families", numbers, numbers, std::vector<std::string>(60, "lankarani-nikravesh")).text();
  const std::regex entry("<circle cx=\"([-0-9.]+)\"");
  int entries = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), entry), end; at != end; ++at, ++entries) {
    EXPECT_GE(std::stod((*at)[1]), 0.0);
    EXPECT_LE(std::stod((*at)[1]), 650.0);
  }
  EXPECT_NE(text.find(fmt::format("and {} more", 60 - entries)), std::string::npos);
}

}  // namespace
}  // namespace freeplay
