// A law of the contact library, made from a map of its parameters.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "../parameter_stub.h"

extern "C" freeplay::Status freeplay_plugin_v1_contact(const freeplay::Host*, freeplay::Manifest*) noexcept;

namespace freeplay::test {

using Numbers = std::map<std::string, double>;

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
inline constexpr Material steel{207e9, 0.3}, bronze{110e9, 0.34}, no_material{unknown, unknown};

inline ContactPair pair_of(double bearing_radius, double journal_radius, Material bearing = steel,
                           Material journal = steel) {
  return {bearing_radius, journal_radius, bearing_radius - journal_radius, unknown, bearing, journal};
}
/// Only the clearance is known.
inline ContactPair bare_pair() { return {unknown, unknown, 1e-4, unknown, no_material, no_material}; }
/// What a line contact needs: no radii.
inline ContactPair line_pair(double length, double radial_clearance) {
  return {unknown, unknown, radial_clearance, length, steel, steel};
}

/// Words by the names of choices, each as its index.
using Words = std::map<std::string, int>;

/// A law under test and the handle that a joint would have on it.
struct ContactUnderTest {
  ContactUnderTest(const std::string& name, const Numbers& numbers, const ContactPair& pair, const Words& words = {})
      : instance(row(name), stub(name, numbers, words), &pair), law(instance.table(), instance.self()) {}
  static const Component& row(const std::string& name) { return component(freeplay_plugin_v1_contact, name); }
  static ParameterStub stub(const std::string& name, const Numbers& numbers, const Words& words = {}) {
    ParameterStub s(row(name));
    s.numbers = numbers;
    s.words = words;
    return s;
  }
  Instance<abi::ContactLawTable> instance;
  ContactLawRef law;
};

struct FrictionUnderTest {
  FrictionUnderTest(const std::string& name, const Numbers& numbers)
      : instance(ContactUnderTest::row(name), ContactUnderTest::stub(name, numbers)),
        law(instance.table(), instance.self()) {}
  Instance<abi::FrictionLawTable> instance;
  FrictionLawRef law;
};

/// Partial derivatives of a law against central differences, relative 1e-7.
inline void expect_derivatives(const ContactLawRef& law, const ContactState& s) {
  const double dp = 1e-5 * s.penetration, dr = 1e-5 * std::abs(s.rate) + 1e-9;
  const ContactForce f = law.evaluate(s);
  const auto at = [&](double p, double r) { return law.evaluate({p, r, s.approach_speed}); };
  const double by_p = (at(s.penetration + dp, s.rate).normal - at(s.penetration - dp, s.rate).normal) / (2.0 * dp);
  const double by_r = (at(s.penetration, s.rate + dr).normal - at(s.penetration, s.rate - dr).normal) / (2.0 * dr);
  EXPECT_NEAR(f.d_penetration, by_p, 1e-7 * std::abs(by_p));
  EXPECT_NEAR(f.d_rate, by_r, 1e-7 * std::abs(by_r) + 1e-9);
}

/// Speed after over speed before of a mass [kg] that falls on a fixed surface with `speed` [m/s] and no other force,
/// by the Runge-Kutta method of order 4 with steps `h` [s].
inline double rebound_ratio(const ContactLawRef& law, double mass, double speed, double h) {
  double x = 0.0, v = speed;
  const auto a = [&](double xx, double vv) { return -law.evaluate({xx, vv, speed}).normal / mass; };
  do {
    const double k1 = a(x, v), k2 = a(x + 0.5 * h * v, v + 0.5 * h * k1),
                 k3 = a(x + 0.5 * h * (v + 0.5 * h * k1), v + 0.5 * h * k2),
                 k4 = a(x + h * (v + 0.5 * h * k2), v + h * k3);
    x += h * (v + h * (k1 + k2 + k3) / 6.0);
    v += h * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
  } while (x > 0.0);
  return -v / speed;
}

/// The entry of a law's table.
inline const Parameter& parameter_of(const std::string& law, const std::string& name) {
  for (const Parameter& p : ContactUnderTest::row(law).description.parameters)
    if (name == p.name) return p;
  throw std::runtime_error("no parameter " + name);
}

}  // namespace freeplay::test
