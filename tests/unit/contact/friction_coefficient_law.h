// What every friction law without memory is asked: coefficient, slope, direction.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "law_probe.h"

namespace freeplay::test {

/// mu_eff at a slip speed [m/s], closed form in double precision.
struct Coefficient {
  double slip, value;
};

template <std::size_t N>
void expect_coefficients(const std::string& name, const Numbers& numbers, const Coefficient (&rows)[N]) {
  const FrictionUnderTest friction(name, numbers);
  EXPECT_EQ(friction.law.internal_variables(), 0);
  for (const Coefficient& r : rows) {
    for (const double sign : {1.0, -1.0}) {
      const FrictionForce f = friction.law.evaluate({200.0, sign * r.slip, {}}, {});
      EXPECT_NEAR(f.tangential, -200.0 * sign * r.value, 200.0 * 2e-15) << r.slip;
      EXPECT_NEAR(f.d_normal, -sign * r.value, 2e-15) << r.slip;
      EXPECT_LE(f.tangential * sign * r.slip, 0.0);
    }
  }
}

/// The slope away from kinks against central differences, and at rest against mu_eff(v)/v of a tiny v.
inline void expect_slopes(const std::string& name, const Numbers& numbers, std::initializer_list<double> slips) {
  const FrictionUnderTest friction(name, numbers);
  const auto at = [&](double slip) { return friction.law.evaluate({200.0, slip, {}}, {}); };
  for (const double slip : slips) {
    const double h = 1e-4 * std::abs(slip);
    const double slope = (at(slip + h).tangential - at(slip - h).tangential) / (2.0 * h);
    // The error of the difference is h^2/6 of the third derivative, and rounding of 20 N over h.
    EXPECT_NEAR(at(slip).d_slip, slope, 1e-6 * std::abs(slope) + 1e-14 / h) << slip;
    EXPECT_EQ(at(slip).d_slip, at(-slip).d_slip);
  }
  EXPECT_NEAR(at(0.0).d_slip, at(1e-18).tangential / 1e-18, 1e-6 * std::abs(at(0.0).d_slip));
}

/// The law declares these slip speeds [m/s], and its slope jumps at each.
inline void expect_kinks(const std::string& name, const Numbers& numbers, std::initializer_list<double> speeds) {
  const FrictionUnderTest friction(name, numbers);
  EXPECT_TRUE(std::ranges::equal(friction.law.kinks(), speeds));
  for (const double speed : speeds) {
    const auto slope = [&](double part) { return friction.law.evaluate({200.0, part * speed, {}}, {}).d_slip; };
    const double jump = std::abs(slope(1.0 + 1e-9) - slope(1.0 - 1e-9));
    EXPECT_GT(jump, 0.01 * std::abs(slope(1.0 - 1e-9) + slope(1.0 + 1e-9))) << speed;
    EXPECT_EQ(jump, std::abs(slope(-1.0 - 1e-9) - slope(-1.0 + 1e-9)));
  }
}

}  // namespace freeplay::test
