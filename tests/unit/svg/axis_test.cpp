#include "svg/axis.h"

#include <cmath>
#include <set>

#include <gmock/gmock.h>

namespace freeplay::svg {
namespace {

using testing::ElementsAre;

TEST(Axis, HasRoundNumbersWithThePrefixOfTheUnit) {
  const Axis axis = make_axis(0.0, 36963.8, "N", 4.0, Fit::round);
  EXPECT_EQ("kN", axis.unit);
  EXPECT_EQ(40000.0, axis.until);
  EXPECT_THAT(axis.labels, ElementsAre("0", "10", "20", "30", "40"));
}

TEST(Axis, EndsWhereTheValuesDoWhenItIsExact) {
  const Axis axis = make_axis(0.0, 0.024, "s", 5.0, Fit::exact);
  EXPECT_EQ(0.024, axis.until);
  EXPECT_EQ("ms", axis.unit);
  EXPECT_THAT(axis.labels, ElementsAre("0", "5", "10", "15", "20"));
}

TEST(Axis, SpreadsAroundAValueThatDoesNotChange) {
  const Axis axis = make_axis(523.6, 523.6, "rad/s", 5.0, Fit::round);
  EXPECT_LT(axis.from, 523.6);
  EXPECT_GT(axis.until, 523.6);
  EXPECT_GT(axis.labels.size(), 2u);
  EXPECT_LT(make_axis(0.0, 0.0, "m", 5.0, Fit::round).from, 0.0);
}

TEST(Axis, TellsSmallDifferencesOfLargeValuesApart) {
  const Axis axis = make_axis(1000.00001, 1000.00004, "N", 3.0, Fit::exact);
  EXPECT_THAT(axis.labels, ElementsAre("-20", "-10", "0", "10"));
  EXPECT_EQ("uN from 1000.00003 N", axis.unit);
}

TEST(Axis, HasDifferentLabelsHoweverNarrowItIs) {
  for (const double offset : {1.0, 1e9, -273.15}) {
    for (const double part : {1.5e-12, 2e-11, 1e-9, 1e-6, 1e-3}) {
      for (const Fit fit : {Fit::exact, Fit::round}) {
        const Axis axis = make_axis(offset, offset + part * std::abs(offset), "1", 6.0, fit);
        EXPECT_GT(axis.labels.size(), 2u) << offset << " " << part;
        EXPECT_EQ(axis.labels.size(), std::set(axis.labels.begin(), axis.labels.end()).size()) << offset << " " << part;
      }
    }
  }
}

TEST(Axis, HasNoPrefixBeforeAUnitThatBeginsWithANumber) {
  EXPECT_EQ("1/s", make_axis(0.0, 5000.0, "1/s", 5.0, Fit::round).unit);
  EXPECT_EQ("", make_axis(0.0, 5000.0, "1", 5.0, Fit::round).unit);
}

TEST(Axis, OfValuesThatAreNoNumbersIsThatOfNothing) {
  const Axis axis = make_axis(1.0 / 0.0, -1.0 / 0.0, "N", 5.0, Fit::round);
  EXPECT_EQ(0.0, axis.from);
  EXPECT_EQ(1.0, axis.until);
}

}  // namespace
}  // namespace freeplay::svg
