#include "run/dense_step.h"

#include <cmath>

#include <gtest/gtest.h>

#include "validation/run_model.h"

namespace freeplay {
namespace {

/// q = t^5 - 2 t^3 + t for every coordinate i, times i + 1.
void fill(State& state, double t) {
  state.t() = t;
  for (std::size_t i = 0; i < state.q().size(); ++i) {
    const double factor = static_cast<double>(i + 1);
    state.q()[i] = factor * (std::pow(t, 5) - 2.0 * std::pow(t, 3) + t);
    state.v()[i] = factor * (5.0 * std::pow(t, 4) - 6.0 * t * t + 1.0);
    state.a()[i] = factor * (20.0 * std::pow(t, 3) - 12.0 * t);
  }
}

TEST(DenseStep, GivesBackAQuinticWithItsDerivatives) {
  const auto model = test::load(test::mechanism("pendulum"));
  const Layout layout(*model, Variant::released);
  State start(layout, 0), end(layout, 0), between(layout, 0), known(layout, 0);
  fill(start, 0.3);
  fill(end, 1.1);
  const System system(*model);
  const DenseStep step(system.model().space, start, {}, end, {});
  for (const double s : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    step.at(s, between);
    fill(known, 0.3 + 0.8 * s);
    EXPECT_NEAR(between.t(), known.t(), 1e-15);
    for (std::size_t i = 0; i < 3; ++i) {
      // Rounding of values up to 3, times the coefficients of the quintic: 15, 60 and 180.
      EXPECT_NEAR(between.q()[i], known.q()[i], 2e-14) << s;
      EXPECT_NEAR(between.v()[i], known.v()[i], 1e-13) << s;
      EXPECT_NEAR(between.a()[i], known.a()[i], 4e-13) << s;
    }
  }
}

/// The same for t^8 - t^7 + 2 t^3 - t, and for z = t^5 - t^2 with its rate.
double fill_more(State& state, double t) {
  state.t() = t;
  for (std::size_t i = 0; i < state.q().size(); ++i) {
    const double factor = static_cast<double>(i + 1);
    state.q()[i] = factor * (std::pow(t, 8) - std::pow(t, 7) + 2.0 * std::pow(t, 3) - t);
    state.v()[i] = factor * (8.0 * std::pow(t, 7) - 7.0 * std::pow(t, 6) + 6.0 * t * t - 1.0);
    state.a()[i] = factor * (56.0 * std::pow(t, 6) - 42.0 * std::pow(t, 5) + 12.0 * t);
  }
  state.z()[0] = std::pow(t, 5) - t * t;
  return 5.0 * std::pow(t, 4) - 2.0 * t;
}

TEST(DenseStep, GivesBackAPolynomialOfDegreeEightWhereAccelerationsInsideAreKnown) {
  const auto model = test::load(test::mechanism("pendulum"));
  const Layout layout(*model, Variant::released);
  State start(layout, 0, 1), end(layout, 0, 1), between(layout, 0, 1), known(layout, 0, 1);
  const std::vector<double> start_rate{fill_more(start, 0.3)}, end_rate{fill_more(end, 1.1)};
  const System system(*model);
  InnerMotion inner(start.v().size(), 1);
  const DenseStep by_ends(system.model().space, start, start_rate, end, end_rate);
  for (std::size_t place = 0; place < InnerMotion::places.size(); ++place) {
    const double s = InnerMotion::places[place];
    const std::vector<double> rate{fill_more(known, 0.3 + 0.8 * s)};
    by_ends.missing(s, known, rate, inner.missing(place), inner.missing_rate(place));
  }
  inner.fit();
  const DenseStep step(system.model().space, start, start_rate, end, end_rate, &inner);
  for (const double s : {0.0, 0.1, 0.35, 0.5, 0.8, 1.0}) {
    step.at(s, between);
    fill_more(known, 0.3 + 0.8 * s);
    EXPECT_NEAR(between.z()[0], known.z()[0], 1e-14) << s;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(between.q()[i], known.q()[i], 4e-14) << s;
      EXPECT_NEAR(between.v()[i], known.v()[i], 4e-13) << s;
      EXPECT_NEAR(between.a()[i], known.a()[i], 4e-12) << s;
    }
  }
}

}  // namespace
}  // namespace freeplay
