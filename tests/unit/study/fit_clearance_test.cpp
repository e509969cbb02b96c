#include "study/fit_clearance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

StudyFit fit_of(const char* code, bool normal) {
  const IsoFit limits = *iso_fit(code, 0.010);
  return {limits, normal, limits.smallest_clearance(), limits.largest_clearance()};
}

struct Moments {
  double mean, deviation;
};

/// Over a grid of both numbers [um].
Moments drawn(const StudyFit& fit, int count) {
  const FitClearance clearance(fit);
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      const double c = 1e6 * clearance.at((i + 0.5) / count, (j + 0.5) / count);
      EXPECT_GE(c, 1e6 * fit.low - 1e-9);
      EXPECT_LE(c, 1e6 * fit.high + 1e-9);
      sum += c;
      squares += c * c;
    }
  }
  const double mean = sum / count / count;
  return {mean, std::sqrt(squares / count / count - mean * mean)};
}

/// Of the difference of two uniform variables, cut: its density is the length of the holes that a clearance has, a
/// trapezium, whose moments over each of its straight parts are those of a cubic (Simpson's rule is exact).
Moments cut_trapezium(const StudyFit& fit) {
  const IsoFit& of = fit.limits;
  const auto density = [&](double c) {
    return std::max(0.0, std::min(of.hole_high, of.shaft_high + 2 * c) - std::max(of.hole_low, of.shaft_low + 2 * c));
  };
  std::vector<double> ends = {fit.low, fit.high};
  for (const double hole : {of.hole_low, of.hole_high}) {
    for (const double shaft : {of.shaft_low, of.shaft_high}) {
      ends.push_back(std::clamp((hole - shaft) / 2, fit.low, fit.high));
    }
  }
  std::ranges::sort(ends);
  double moments[3] = {};
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double a = ends[i], b = ends[i + 1], m = (a + b) / 2;
    for (int power = 0; power < 3; ++power) {
      const auto part = [&](double c) { return std::pow(1e6 * c, power) * density(c); };
      moments[power] += (b - a) / 6 * (part(a) + 4 * part(m) + part(b));
    }
  }
  const double mean = moments[1] / moments[0];
  return {mean, std::sqrt(moments[2] / moments[0] - mean * mean)};
}

/// Of the difference of two normal variables, each cut at its zone, cut itself: by the rectangle rule over both.
Moments cut_difference_of_normals(const StudyFit& fit) {
  constexpr int count = 1000;
  const IsoFit& of = fit.limits;
  const auto weight = [](double place) { return std::exp(-0.5 * (6 * place - 3) * (6 * place - 3)); };
  double moments[3] = {};
  for (int i = 0; i < count; ++i) {
    const double c = fit.low + (i + 0.5) / count * (fit.high - fit.low);
    double density = 0.0;
    for (int j = 0; j < count; ++j) {
      const double hole = (j + 0.5) / count, size = of.hole_low + hole * (of.hole_high - of.hole_low);
      const double shaft = (size - 2 * c - of.shaft_low) / (of.shaft_high - of.shaft_low);
      if (shaft >= 0.0 && shaft <= 1.0) density += weight(hole) * weight(shaft);
    }
    for (int power = 0; power < 3; ++power) moments[power] += std::pow(1e6 * c, power) * density;
  }
  const double mean = moments[1] / moments[0];
  return {mean, std::sqrt(moments[2] / moments[0] - mean * mean)};
}

// Annex B of the contract: mean 8.5 um, deviation 1.4382 um for normal zones and 2.5249 um for uniform ones.
TEST(FitClearance, HasTheMomentsOfItsZones) {
  for (const bool normal : {true, false}) {
    const Moments found = drawn(fit_of("H7/g6", normal), 400);
    EXPECT_NEAR(found.mean, 8.5, 1e-6);
    EXPECT_NEAR(found.deviation, normal ? 1.4382 : 2.5249, 1e-3);
  }
}

TEST(FitClearance, CutHasTheMomentsOfTheCutDifferenceLong) {
  for (const auto& [low, high] : std::vector<std::pair<double, double>>{
           {8e-6, 14.5e-6}, {2.5e-6, 6e-6}, {11e-6, 13e-6}, {4e-6, 9e-6}, {2.5e-6, 14e-6}}) {
    for (const bool normal : {true, false}) {
      StudyFit fit = fit_of("H7/g6", normal);
      fit.low = low;
      fit.high = high;
      const Moments wanted = normal ? cut_difference_of_normals(fit) : cut_trapezium(fit), found = drawn(fit, 150);
      EXPECT_NEAR(found.mean, wanted.mean, 1e-3) << low << " " << normal;
      EXPECT_NEAR(found.deviation, wanted.deviation, 4e-3) << low << " " << normal;
    }
  }
}

TEST(FitClearance, IsCutWithoutAHeapAtTheEnds) {
  const IsoFit limits = *iso_fit("H7/h6", 0.010);
  const FitClearance clearance({limits, true, 3e-6, 4e-6});
  for (double u = 0.05; u < 1.0; u += 0.1) {
    for (double v = 0.05; v < 1.0; v += 0.1) {
      EXPECT_GT(clearance.at(u, v), 3e-6);
      EXPECT_LT(clearance.at(u, v), 4e-6);
    }
  }
}

// An end outside of what the zones give cuts nothing, and one just inside hardly anything.
TEST(FitClearance, GrowsOutOfTheOneThatIsNotCut) {
  const StudyFit whole = fit_of("H8/f7", true);
  StudyFit cut = whole;
  cut.low += 1e-12;
  for (double u = 0.1; u < 1.0; u += 0.2) {
    for (double v = 0.1; v < 1.0; v += 0.2) {
      EXPECT_NEAR(FitClearance(whole).at(u, v), FitClearance(cut).at(u, v), 1e-15);
    }
  }
}

}  // namespace
}  // namespace freeplay
