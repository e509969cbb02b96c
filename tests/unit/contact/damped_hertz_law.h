// What every law K delta^n (1 + chi delta'/v_0) is asked: force, derivatives, rebound, range.
#pragma once

#include <cmath>
#include <string>

#include "law_probe.h"

namespace freeplay::test {

/// The law on the pair R_b = 5 mm, R_j = 4.9 mm of steel, K = 75062104464.4181 N/m^1.5.
inline ContactUnderTest damped_law(const std::string& name, double restitution) {
  return {name, {{"restitution", restitution}}, pair_of(0.005, 0.0049)};
}

/// Six forces [N] at e = 0.9, from the closed form max(0, K delta^1.5 (1 + chi delta'/v_0)).
inline void expect_forces(const std::string& name, const double (&forces)[6]) {
  const ContactState states[6] = {{1e-6, 0.05, 0.1},    {1e-6, -0.05, 0.1}, {5e-6, 0.0, 0.2},
                                  {2.5e-7, 0.01, 0.01}, {1e-6, -0.2, 0.1},  {-1e-6, 0.1, 0.1}};
  const ContactUnderTest law = damped_law(name, 0.9);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(law.law.evaluate(states[i]).normal, forces[i], 2e-13 * (1.0 + forces[i]));
}

/// chi and out-speed ratio s at a restitution; s is the root of chi (1 + s) = ln[(1 + chi)/(1 - chi s)], 34 digits.
struct Rebound {
  double restitution, chi, ratio;
};

template <std::size_t N>
void expect_rebounds(const std::string& name, const Rebound (&rebounds)[N]) {
  for (const Rebound& r : rebounds) {
    const ContactUnderTest law = damped_law(name, r.restitution);
    const double elastic = law.law.evaluate({1e-6, 0.0, 0.1}).normal;
    EXPECT_NEAR(law.law.evaluate({1e-6, 0.1, 0.1}).normal / elastic - 1.0, r.chi, 1e-14 * (1.0 + r.chi));
    // The ratio depends on neither mass nor speed. Contacts last 120 us or more: 3000 steps.
    EXPECT_NEAR(rebound_ratio(law.law, 0.2, 0.1, 40e-9), r.ratio, 1e-7);
    EXPECT_NEAR(rebound_ratio(law.law, 1.0, 0.5, 40e-9), r.ratio, 1e-7);
  }
}

inline void expect_smooth_without_tension(const std::string& name) {
  const ContactUnderTest law = damped_law(name, 0.9);
  for (const double rate : {-0.2, 0.0, 0.2}) expect_derivatives(law.law, {1e-6, rate, 0.1});
  const ContactForce pulled = law.law.evaluate({1e-6, -2.0, 0.1});  // chi > 0.05
  EXPECT_EQ(pulled.normal, 0.0);
  EXPECT_EQ(pulled.d_penetration, 0.0);
  EXPECT_EQ(pulled.d_rate, 0.0);
  EXPECT_NEAR(pulled.potential, 0.4 * 75.0621044644181 * 1e-6, 1e-17);
  // Without approach speed, and with e = 1, the elastic part is left.
  EXPECT_NEAR(law.law.evaluate({1e-6, 0.3, 0.0}).normal, 75.0621044644181, 1e-11);
  EXPECT_NEAR(damped_law(name, 1.0).law.evaluate({1e-6, 0.3, 0.1}).normal, 75.0621044644181, 1e-11);
}

/// The law reports a restitution below `lowest` (0: none) and a penetration beyond a tenth of the clearance.
inline void expect_range(const std::string& name, double lowest) {
  for (const double restitution : {0.05, 0.35, 0.45, 0.6, 0.89, 0.95}) {
    const bool outside = damped_law(name, restitution).law.outside_range({1e-6, 0.0, 0.1}) != nullptr;
    EXPECT_EQ(outside, restitution < lowest) << restitution;
  }
  EXPECT_NE(damped_law(name, 0.95).law.outside_range({1.1e-5, 0.0, 0.1}), nullptr);
}

inline void expect_refusals(const std::string& name) {
  const auto id = [&](const Numbers& numbers, const ContactPair& pair) {
    return bad_parameter_id([&] { ContactUnderTest(name, numbers, pair); });
  };
  EXPECT_EQ(id({{"restitution", 0.9}}, bare_pair()), "missing-key");
  EXPECT_EQ(id({{"restitution", 0.9}, {"exponent", 1.1}}, pair_of(0.005, 0.0049)), "missing-key");
  EXPECT_EQ(id({{"restitution", 0.9}, {"exponent", 1.1}, {"K", 1e9}}, bare_pair()), "");
  const Parameter& e = parameter_of(name, "restitution");
  EXPECT_TRUE(std::isnan(e.default_value));
  EXPECT_EQ(e.minimum, 0.0);
  EXPECT_EQ(e.maximum, 1.0);
  EXPECT_EQ(e.open, Open::minimum);
}

}  // namespace freeplay::test
