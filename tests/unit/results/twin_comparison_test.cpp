#include "results/twin_comparison.h"

#include <cmath>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

Model model_in(Space space) {
  Model model;
  model.space = space;
  model.bodies.resize(1);
  model.bodies[0].name = "arm";
  model.drivers.resize(1);
  model.drivers[0].name = "motor";
  model.settings.start = 1.0;
  model.settings.discard = 0.5;
  model.settings.interval = 0.1;
  return model;
}

using Numbers = std::vector<double>;

TEST(TwinComparison, HasLargestAndMeanSquareOfRowsThatCount) {
  const Model model = model_in(Space::planar);
  TwinComparison comparison(model);
  EXPECT_TRUE(comparison.json().is_null());
  comparison.add(Numbers{1.4, 9.0, 9.0, 9.0, 9.0}, Numbers{1.4, 0.0, 0.0, 0.0, 0.0});
  EXPECT_TRUE(comparison.json().is_null());
  comparison.add(Numbers{1.5, 3.0, 4.0, 0.1, 12.0}, Numbers{1.5, 0.0, 0.0, 0.3, 10.0});
  comparison.add(Numbers{1.6, 1.0, 1.0, 0.3, 7.0}, Numbers{1.6, 1.0, 1.0, 0.2, 10.0});
  const Json json = comparison.json(), &body = json["bodies"]["arm"], &driver = json["drivers"]["motor"];
  EXPECT_EQ(body["max_position"], 5.0);
  EXPECT_NEAR(body["rms_position"], 5.0 / std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(body["max_angle"], 0.2, 1e-15);
  EXPECT_NEAR(body["rms_angle"], std::sqrt(0.025), 1e-15);
  EXPECT_EQ(driver["max"], 3.0);
  EXPECT_NEAR(driver["rms"], std::sqrt(6.5), 1e-15);
  EXPECT_NEAR(driver["ripple"], std::sqrt(6.5) / 10.0, 1e-15);
}

TEST(TwinComparison, RippleOfNoEffortIsNotKnown) {
  const Model model = model_in(Space::planar);
  TwinComparison comparison(model);
  comparison.add(Numbers{2.0, 0.0, 0.0, 0.0, 0.0}, Numbers{2.0, 0.0, 0.0, 0.0, 0.0});
  EXPECT_TRUE(comparison.json()["drivers"]["motor"]["ripple"].is_null());
}

// A turn of 0.4 rad about any axis, after any other turn, whatever the sign of the quaternion.
TEST(TwinComparison, AngleInSpaceIsThatOfTheTurnBetween) {
  const Model model = model_in(Space::spatial);
  const double w = 0.5, x = 0.1, y = -0.7, z = std::sqrt(1.0 - 0.25 - 0.01 - 0.49), c = std::cos(0.2),
               s = std::sin(0.2);
  const double a = s * 0.6, b = s * 0.8;  // about (0.6, 0.8, 0)
  for (const double sign : {1.0, -1.0}) {
    TwinComparison comparison(model);
    comparison.add(Numbers{2.0, 1.0, 2.0, 4.0, w, x, y, z, 0.0},
                   Numbers{2.0, 1.0, 0.0, 3.0, sign * (c * w - a * x - b * y), sign * (c * x + a * w + b * z),
                           sign * (c * y - a * z + b * w), sign * (c * z + a * y - b * x), 0.0});
    EXPECT_NEAR(comparison.json()["bodies"]["arm"]["max_angle"], 0.4, 1e-14);
    EXPECT_NEAR(comparison.json()["bodies"]["arm"]["max_position"], std::sqrt(5.0), 1e-15);
  }
}

}  // namespace
}  // namespace freeplay
