// Corners of formulas, asked for as a run does: from window to window.
#include "base/formula_course.h"

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace freeplay {
namespace {

Expression expression_of(std::string_view text) { return Expression::compile(text, EmptyScope{}, true); }

/// All corners of (from, to), asked for in steps of at most `dt`; `unknown` sums what is not known.
struct Walk {
  std::vector<double> corners;
  double unknown = 0.0;
};
Walk walk(std::string_view text, double from, double to, double dt) {
  const Expression expression = expression_of(text);
  FormulaCourse course(expression, from, to);
  Walk out;
  for (double t = from; t < to;) {
    const double corner = course.next_corner(t, t + dt), end = std::min({corner, t + dt, to});
    if (std::isinf(course.rate_within(t, end))) out.unknown += end - t;
    if (corner <= end) out.corners.push_back(corner);
    t = end;
  }
  return out;
}

// sin(w t) > level from (asin(level) + 2 k pi)/w to (pi - asin(level) + 2 k pi)/w.
TEST(FormulaCourse, EveryPulseOfAPeriodicLoadIsKnownHoweverManyThereAre) {
  for (const double frequency : {3.0, 77.0, 512.0, 4096.0}) {
    const double w = 2.0 * M_PI * frequency, level = 0.9985, end = 2.3;
    const Walk found = walk(fmt::format("4*max(0, sin({:.17g}*t) - {})", w, level), 0.0, end, 0.11);
    std::vector<double> wanted;
    for (int k = 0; k < frequency * end; ++k) {
      for (const double angle : {std::asin(level), M_PI - std::asin(level)}) {
        if (const double t = (angle + 2.0 * M_PI * k) / w; t < end) wanted.push_back(t);
      }
    }
    ASSERT_EQ(found.corners.size(), wanted.size()) << frequency;
    for (std::size_t i = 0; i < wanted.size(); ++i) ASSERT_NEAR(found.corners[i], wanted[i], 1e-11) << frequency;
    EXPECT_EQ(found.unknown, 0.0);
  }
}

// A short load on a long run, whose side is no parabola: where |u| < half is known in closed form.
TEST(FormulaCourse, AShortLoadIsKnownWhateverCurveDecides) {
  struct Load {
    const char* text;
    double half;
  };
  const Load loads[] = {{"max(0, 1 - u^8)", 1.0},
                        {"max(0, exp(-u^2) - 0.4)", std::sqrt(-std::log(0.4))},
                        {"max(0, 1/(1 + u^4) - 0.25)", std::pow(3.0, 0.25)},
                        {"max(0, cos(atan2(u, 1)) - 0.5)", std::sqrt(3.0)},
                        {"smooth(1/(1 + u^2), 0.2, 0.9)", 2.0},
                        {"min(1, max(0, 2 - sqrt(1 + u^2)))", std::sqrt(3.0)},
                        {"abs(min(0, u^2 + u^6 - 2))", 1.0}};
  const double end = 40.0;
  for (const Load& load : loads) {
    for (const double at : {0.013, 17.77123, 39.2}) {
      for (const double width : {3e-3, 2e-5}) {
        std::string text = load.text;
        for (std::size_t i = text.find('u'); i != std::string::npos; i = text.find('u', i + 1)) {
          if (i > 0 && std::isalpha(text[i - 1])) continue;  // of a function's name
          const std::string u = fmt::format("((t - {:.17g})/{:.17g})", at, width);
          text.replace(i, 1, u);
          i += u.size() - 1;
        }
        const Walk found = walk(text, 0.0, end, 1.7);
        ASSERT_GE(found.corners.size(), 2u) << text;
        EXPECT_NEAR(found.corners.front(), at - load.half * width, 1e-12 * end) << text;
        EXPECT_NEAR(found.corners.back(), at + load.half * width, 1e-12 * end) << text;
      }
    }
  }
}

TEST(FormulaCourse, ABeatShowsEachOfItsCrestsAboveTheLevel) {
  const double end = 30.0;
  const auto load = [](double t) { return std::sin(2 * M_PI * 31 * t) * std::sin(2 * M_PI * 32 * t) - 0.99; };
  const Walk found = walk("max(0, sin(2*pi*31*t)*sin(2*pi*32*t) - 0.99)", 0.0, end, 0.5);
  std::size_t changes = 0;
  const int looks = 1'000'000;
  for (int i = 0; i < looks; ++i) changes += (load(end * i / looks) > 0.0) != (load(end * (i + 1) / looks) > 0.0);
  EXPECT_EQ(found.corners.size(), changes);
}

// At t = 0 the sine is zero and grows: the load does from the start what it does.
TEST(FormulaCourse, ACornerAtTheStartIsNone) {
  for (const char* text : {"max(0, sin(7*t))", "max(0, 10*sin(5*t))*t", "abs(t)", "max(0, t^3)", "min(t, 2*t)"}) {
    for (const double corner : walk(text, 0.0, 0.3, 0.01).corners) EXPECT_GT(corner, 1e-3) << text;
  }
  EXPECT_EQ(walk("max(0, sin(7*(t - 2)))", 2.0, 2.3, 0.01).corners.size(), 0u);
}

TEST(FormulaCourse, CornersWithinRoundingOfTheTimeAreOne) {
  EXPECT_EQ(walk("abs(t - 3) + abs(t - 3.0000000000000004) + max(0, 3 - t)", 0.0, 10.0, 1.0).corners.size(), 1u);
}

TEST(FormulaCourse, ALongFormulaIsKnownToItsEnd) {
  std::string text = "0";
  for (int i = 0; i < 250; ++i) text += fmt::format("+max(0,1-abs(t-{})/1e-6)", 0.003 + 0.0077 * i);
  const Walk found = walk(text, 0.0, 2.0, 0.05);
  EXPECT_EQ(found.corners.size(), 750u);
  EXPECT_EQ(found.unknown, 0.0);
}

// The angle of a point goes through its jump on the left.
TEST(FormulaCourse, AJumpOfAnAngleIsACorner) {
  const Walk switched = walk("atan2(0, t - 0.4)", 0.0, 1.0, 0.3);
  ASSERT_EQ(switched.corners.size(), 1u);
  EXPECT_EQ(switched.corners[0], 0.4);
  // As long as the ramp has not begun the point is on the axis of x.
  const Walk resting = walk("atan2(smooth(t, 0.6, 0.8), 0.25 - t)", 0.0, 1.0, 0.3);
  ASSERT_EQ(resting.corners.size(), 3u);
  EXPECT_NEAR(resting.corners[0], 0.25, 1e-15);
  const Walk turning = walk("atan2(sin(9*t), cos(9*t))", 0.0, 2.0, 0.3);
  ASSERT_EQ(turning.corners.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(turning.corners[k], (2.0 * static_cast<double>(k) + 1.0) * M_PI / 9.0, 1e-15);
}

// What nothing can decide costs bounded work, and is said to be unknown.
TEST(FormulaCourse, WhatCannotBeDecidedIsUnknownAndCostsLittle) {
  const Expression expression = expression_of("max(0, sin(300*t)^2 + cos(300*t)^2 - 1)");
  FormulaCourse course(expression, 0.0, 50.0);
  double t = 0.0, unknown = 0.0;
  while (t < 50.0) {
    const double end = std::min({course.next_corner(t, t + 0.2), t + 0.2, 50.0});
    if (std::isinf(course.rate_within(t, end))) unknown += end - t;
    t = end;
  }
  EXPECT_GT(unknown, 40.0);
  EXPECT_LT(course.work(), 100'000'000);
}

// Where spans are halved, and where windows end, rounding decides on which side of it a corner is.
TEST(FormulaCourse, NoCornerIsLostWhereSpansMeet) {
  for (const int frequency : {5, 16, 32, 50, 64, 96}) {
    for (const double end : {1.0, 2.0, 3.0}) {
      EXPECT_EQ(walk(fmt::format("abs(sin(2*pi*{}*t))", frequency), 0.0, end, 0.07).corners.size(),
                static_cast<std::size_t>(2 * frequency * end) - 1)
          << frequency << " over " << end;
      EXPECT_EQ(walk(fmt::format("max(0, cos(2*pi*{}*t))", frequency), 0.0, end, 0.11).corners.size(),
                static_cast<std::size_t>(2 * frequency * end))
          << frequency << " over " << end;
    }
  }
}

// Windows do not show in what is found.
TEST(FormulaCourse, CornersDoNotDependOnWhoAsksHowFar) {
  const char* const text = "max(0, sin(40*t) - 0.3)*abs(cos(3*t)) + smooth(t^2, 0.5, 0.7)";
  const std::vector<double> wide = walk(text, 0.0, 3.0, 3.0).corners;
  for (const double dt : {1e-3, 0.017, 0.4}) EXPECT_EQ(walk(text, 0.0, 3.0, dt).corners, wide);
}

// Half periods of the sine, in windows of the run and between them.
TEST(FormulaCourse, WhatTouchesTheEndOfARootOrAnArcHasItsCornerThere) {
  for (const double frequency : {1.0, 10.0, 77.7}) {
    const double w = 2.0 * M_PI * frequency;
    for (const char* text :
         {"sqrt(sin({0:.17g}*t)^2)", "(sin({0:.17g}*t)^2)^0.5", "sqrt(1 - cos({0:.17g}*t)^2)", "acos(cos({0:.17g}*t))",
          "asin(cos({0:.17g}*t))", "acos(1 - sin({0:.17g}*t)^2)", "max(-1, sqrt(sin({0:.17g}*t)^2 + 1e-26))"}) {
      const Walk found = walk(fmt::format(fmt::runtime(text), w), 0.0, 4.0, 0.11);
      std::vector<double> wanted;
      for (int k = 1; k * M_PI < w * 4.0 - 1e-9; ++k) wanted.push_back(k * M_PI / w);
      ASSERT_EQ(found.corners.size(), wanted.size()) << text << frequency;
      // 1 - cos^2 is known to the root of the rounding alone.
      for (std::size_t i = 0; i < wanted.size(); ++i) ASSERT_NEAR(found.corners[i], wanted[i], 1e-8) << text;
    }
  }
}

TEST(FormulaCourse, ARootThatStaysAwayFromItsEndHasNoCorner) {
  EXPECT_TRUE(
      walk("sqrt(0.2 - 0.1*sin(7*t)^2) + asin(0.5*sin(5*t)) + (2 + cos(t))^1.5", 0.0, 10.0, 0.3).corners.empty());
}

TEST(FormulaCourse, InfiniteSlopesAreKnownOnTheirSideOfACorner) {
  const auto singular = [](const char* text, double t) {
    const Expression expression = expression_of(text);
    FormulaCourse course(expression, 0.0, 4.0);
    course.next_corner(t - 0.5, 4.0), course.next_corner(t, 4.0);
    return course.singular(t);
  };
  const auto after_root = singular("sqrt(max(0, t - 1))", 1.5);
  EXPECT_NEAR(after_root.before, 0.5, 1e-12);
  EXPECT_TRUE(std::isinf(after_root.after));
  const auto before_arc = singular("asin(min(1, t/2))", 1.5);
  EXPECT_NEAR(before_arc.after, 0.5, 1e-12);
  EXPECT_NEAR(singular("max(0, t - 1)^1.3", 1.5).before, 0.5, 1e-12);
  EXPECT_TRUE(std::isinf(singular("max(0, t - 1)^2.5", 1.5).before));
  EXPECT_NEAR(singular("sqrt(t)", 0.5).before, 0.5, 1e-12);
}

TEST(FormulaCourse, AFormThatTheRunBeginsOrEndsWithIsAsLongAsItIsThere) {
  const auto length = [](const char* text, double t) {
    const Expression expression = expression_of(text);
    FormulaCourse course(expression, 0.0, 4.0);
    course.next_corner(0.0, 4.0);
    return course.length_of_form(t, 2);
  };
  EXPECT_NEAR(length("smooth(t, 0, 1)", 0.5), 1.0, 1e-9);
  EXPECT_NEAR(length("smooth(t, 1, 2)", 1.5), 1.0, 1e-9);
  EXPECT_NEAR(length("smooth(t, 3, 5)", 3.5), 1.0, 1e-9);
  EXPECT_NEAR(length("t^3", 2.0), 4.0, 1e-9);
  EXPECT_TRUE(std::isinf(length("t^2", 2.0)));
  EXPECT_TRUE(std::isinf(length("smooth(t, 0, 1)", 2.0)));
}

// Its middle is the very place where smooth() is touched, and shows nothing of it.
TEST(FormulaCourse, ALoadThatTouchesTheBeginOfARampInItsMiddleChanges) {
  const Expression expression = expression_of("1 - smooth(((t - 2)/0.5)^2, 0, 1)");
  FormulaCourse course(expression, 0.0, 4.0);
  EXPECT_NEAR(course.length_of_change(2.0, 0, 4.0), 1.0, 1e-9);
  EXPECT_TRUE(std::isinf(course.length_of_change(2.0, 0, 0.5)));
  EXPECT_TRUE(std::isinf(course.length_of_change(3.0, 0, 4.0)));
}

}  // namespace
}  // namespace freeplay
