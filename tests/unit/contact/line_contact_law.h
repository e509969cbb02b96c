// What every law of line contact is asked: force, slope, energy, limit, damping.
#pragma once

#include <cmath>
#include <string>

#include "law_probe.h"

namespace freeplay::test {

/// Elastic force [N] and slope [N/m] at a penetration [m], for steel of given length and radial clearance [m]. The
/// implicit formula solved with the lower Lambert branch, residual below 1e-25.
struct LineForce {
  double length, clearance, penetration, force, slope;
};

template <std::size_t N>
void expect_line_forces(const std::string& name, const LineForce (&rows)[N]) {
  for (const LineForce& r : rows) {
    const ContactUnderTest law(name, {}, line_pair(r.length, r.clearance));
    for (const double rate : {-0.3, 0.0, 0.3}) {
      const ContactForce f = law.law.evaluate({r.penetration, rate, 0.1});
      EXPECT_NEAR(f.normal / r.force, 1.0, 1e-13);
      EXPECT_NEAR(f.d_penetration / r.slope, 1.0, 1e-13);
      EXPECT_EQ(f.d_rate, 0.0);
    }
  }
}

/// delta = F/(pi E* L) [ln(B/F) + k] for steel, L = 15 mm, c = 0.1 mm, with B = factor E* L c.
inline double line_penetration(double force, double factor, double k) {
  const double modulus = 207e9 / (2.0 * 0.91) * 0.015;  // E* L
  return force / (M_PI * modulus) * (std::log(factor * modulus * 1e-4 / force) + k);
}

/// From the smallest penetrations to the limit: the force solves the formula, the slope and the potential belong to it.
inline void expect_line_law(const std::string& name, double factor, double k, double limit) {
  const ContactUnderTest law(name, {}, line_pair(0.015, 1e-4));
  for (const double part : {1e-9, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999, 1.0 - 1e-9}) {
    const double penetration = part * limit;
    EXPECT_NEAR(line_penetration(law.law.evaluate({penetration, 0.0, 0.1}).normal, factor, k) / penetration, 1.0,
                1e-12);
    if (part > 0.99) continue;
    const double step = 1e-5 * penetration;
    const auto potential = [&](double x) { return law.law.evaluate({x, 0.0, 0.1}).potential; };
    expect_derivatives(law.law, {penetration, 0.05, 0.1});
    // dU/ddelta = F; the difference of nearly equal potentials keeps ten digits.
    const double slope = (potential(penetration + step) - potential(penetration - step)) / (2.0 * step);
    EXPECT_NEAR(slope / law.law.evaluate({penetration, 0.0, 0.1}).normal, 1.0, 1e-8);
  }
}

/// U at 1 micron by Simpson's rule over F in [0, F_1]: U = F_1 delta_1 - integral of delta dF.
inline void expect_line_potential(const std::string& name, double factor, double k) {
  const ContactForce f = ContactUnderTest(name, {}, line_pair(0.015, 1e-4)).law.evaluate({1e-6, 0.0, 0.1});
  const int intervals = 20000;
  double sum = line_penetration(f.normal, factor, k);
  for (int i = 1; i < intervals; ++i)
    sum += (i % 2 == 1 ? 4.0 : 2.0) * line_penetration(f.normal * i / intervals, factor, k);
  const double complement = sum * f.normal / intervals / 3.0;
  EXPECT_NEAR(f.potential / (f.normal * 1e-6 - complement), 1.0, 1e-8);  // ln F at F = 0 costs order
}

inline void expect_line_limit(const std::string& name, double limit) {
  const ContactUnderTest law(name, {}, line_pair(0.015, 1e-4));
  EXPECT_NO_THROW(law.law.evaluate({limit * (1.0 - 1e-12), 0.0, 0.1}));
  for (const double beyond : {limit * (1.0 + 1e-12), 2.0 * limit, 1.0}) {
    try {
      law.law.evaluate({beyond, 0.0, 0.1});
      ADD_FAILURE() << "no force exists at " << beyond;
    } catch (const BadParameter&) {
      ADD_FAILURE() << "not a fault of the model file";
    } catch (const std::exception& e) {
      EXPECT_NE(std::string(e.what()).find("penetration"), std::string::npos);
    }
  }
  for (const double nothing : {-1e-6, 0.0, 9e-15}) {
    const ContactForce f = law.law.evaluate({nothing, 0.1, 0.1});
    EXPECT_EQ(f.normal, 0.0);
    EXPECT_EQ(f.d_penetration, 0.0);
    EXPECT_EQ(f.potential, 0.0);
  }
  EXPECT_GT(law.law.evaluate({1.1e-14, 0.0, 0.1}).normal, 0.0);
}

/// Each word of `damping` but the first is the law of that name: its factor on a Hertz contact is the one used here.
inline void expect_line_damping(const std::string& name) {
  std::string words = parameter_of(name, "damping").choices;
  for (int index = 0; !words.empty(); ++index) {
    const std::string word = words.substr(0, words.find('|'));
    words.erase(0, word.size() + 1);
    if (index == 0) {
      EXPECT_EQ(word, "none");
      continue;
    }
    const ContactUnderTest law(name, {{"restitution", 0.7}}, line_pair(0.015, 1e-4), {{"damping", index}});
    const ContactUnderTest point(word, {{"restitution", 0.7}, {"K", 1e10}}, bare_pair());
    const auto factor = [](const ContactLawRef& of) {
      return of.evaluate({1e-6, 0.06, 0.1}).normal / of.evaluate({1e-6, 0.06, 0.0}).normal;
    };
    EXPECT_NEAR(factor(law.law), factor(point.law), 1e-14) << word;
    EXPECT_STREQ(law.law.outside_range({1e-6, 0.0, 0.1}), point.law.outside_range({1e-6, 0.0, 0.1})) << word;
    expect_derivatives(law.law, {1e-6, -0.05, 0.1});
    EXPECT_EQ(law.law.evaluate({1e-6, -10.0, 0.1}).normal, 0.0);
  }
}

inline void expect_line_refusals(const std::string& name) {
  const auto id = [&](const ContactPair& pair, const Numbers& numbers = {}, const Words& words = {}) {
    return bad_parameter_id([&] { ContactUnderTest(name, numbers, pair, words); });
  };
  ContactPair radii = pair_of(0.005, 0.0049);
  EXPECT_EQ(id(radii), "missing-key");
  radii.length = 0.015;
  EXPECT_EQ(id(radii), "");
  radii.radial_clearance = unknown;
  EXPECT_EQ(id(radii), "");
  radii.journal_radius = unknown;
  EXPECT_EQ(id(radii), "missing-key");
  EXPECT_EQ(id(line_pair(0.015, 1e-4)), "");
  ContactPair bare = bare_pair();
  bare.length = 0.015;
  EXPECT_EQ(id(bare), "missing-key");
  bare.bearing = steel;
  EXPECT_EQ(id(bare), "missing-key");
  // Its clearance is that of two cylinders: the play at a wall is another number.
  ContactPair wall = line_pair(0.015, 1e-4);
  wall.bearing_shape = SurfaceShape::plane;
  EXPECT_EQ(id(wall), "out-of-range");
  EXPECT_EQ(id(line_pair(0.015, 1e-4), {}, {{"damping", 1}}), "missing-key");
  EXPECT_EQ(id(line_pair(0.015, 1e-4), {{"restitution", 0.9}}), "conflicting-keys");
  EXPECT_EQ(id(line_pair(0.015, 1e-4), {{"restitution", 0.9}}, {{"damping", 1}}), "");
}

}  // namespace freeplay::test
