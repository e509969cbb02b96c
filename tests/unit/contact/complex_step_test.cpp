// Every law against its formula written a second time, and its derivatives against complex steps of that: a function of
// x + i h has the derivative Im/h without the cancellation of differences, so that all digits can be asked for.
#include <cmath>
#include <complex>
#include <functional>

#include "law_probe.h"

namespace freeplay::test {
namespace {

using Complex = std::complex<double>;
constexpr double tiny = 1e-40;  // of the quantity that is stepped

struct Derivative {
  double value, slope;
};
Derivative derivative(const std::function<Complex(Complex)>& f, double x) {
  const double h = tiny * std::abs(x);
  const Complex value = f({x, h});
  return {value.real(), value.imag() / h};
}

constexpr double restitutions[] = {0.1, 0.5, 0.9, 1.0};
struct Loss {
  const char* law;
  int word;  ///< index of the law among the words of `damping`
  double (*chi)(double);
};
const Loss losses[] = {
    {"hunt-crossley", 1, [](double e) { return 3.0 * (1.0 - e) / 2.0; }},
    {"herbert-mcwhannell", 2, [](double e) { return 6.0 * (1.0 - e) / (std::pow(2.0 * e - 1.0, 2) + 3.0); }},
    {"lee-wang", 3, [](double e) { return 3.0 * (1.0 - e) / 4.0; }},
    {"lankarani-nikravesh", 4, [](double e) { return 3.0 * (1.0 - std::pow(e, 2)) / 4.0; }},
    {"gonthier", 5, [](double e) { return (1.0 - std::pow(e, 2)) / e; }},
    {"flores", 6, [](double e) { return 8.0 * (1.0 - e) / (5.0 * e); }},
    {"hu-guo", 7, [](double e) { return 3.0 * (1.0 - e) / (2.0 * e); }},
    {"zhiying-qishao", 8, [](double e) { return 3.0 * (1.0 - std::pow(e, 2)) / 4.0 * std::exp(2.0 * (1.0 - e)); }}};

/// F_N = max(0, F_s (1 + chi delta'/v_0)) and everything that a law says with it.
void expect_damped(const ContactLawRef& law, const std::function<Complex(Complex)>& elastic, double chi,
                   double penetration, double rate, double approach) {
  SCOPED_TRACE("delta " + std::to_string(penetration) + ", rate " + std::to_string(rate));
  const ContactForce f = law.evaluate({penetration, rate, approach});
  const Derivative s = derivative(elastic, penetration);
  const double factor = 1.0 + chi * rate / approach;
  const double cut = factor > 0.0 ? 1.0 : 0.0;
  // What the formula cancels where the damper nearly stops the spring.
  const double rounding = 4e-15 * (1.0 + std::abs(chi * rate / approach));
  EXPECT_NEAR(f.normal, cut * s.value * factor, rounding * s.value);
  EXPECT_NEAR(f.d_penetration, cut * s.slope * factor, 4.0 * rounding * s.slope);
  EXPECT_NEAR(f.d_rate, cut * s.value * chi / approach, 4e-15 * s.value * chi / approach);
  EXPECT_NEAR(f.elastic, s.value, 4e-15 * s.value);
}

void expect_over_the_range(const ContactLawRef& law, const std::function<Complex(Complex)>& elastic, double chi,
                           double deepest) {
  for (const double part : {1e-7, 1e-5, 1e-3, 0.1, 0.5, 0.9}) {
    for (const double rate : {-1.0, -0.3, -1e-3, 0.0, 1e-6, 0.02, 0.3, 1.0}) {
      for (const double approach : {1e-3, 0.05, 1.0}) {
        expect_damped(law, elastic, chi, part * deepest, rate, approach);
      }
    }
  }
}

TEST(ComplexStep, LawsOfContinuousImpactAndTheirDerivatives) {
  for (const double exponent : {1.5, 1.1, 2.0}) {
    const auto elastic = [&](Complex d) { return 3e9 * std::pow(d, exponent); };
    const ContactUnderTest hertz("hertz", {{"K", 3e9}, {"exponent", exponent}}, bare_pair());
    expect_over_the_range(hertz.law, elastic, 0.0, 1e-4);
    for (const Loss& loss : losses) {
      for (const double e : restitutions) {
        SCOPED_TRACE(std::string(loss.law) + " " + std::to_string(e));
        const ContactUnderTest law(loss.law, {{"K", 3e9}, {"exponent", exponent}, {"restitution", e}}, bare_pair());
        expect_over_the_range(law.law, elastic, loss.chi(e), 1e-4);
      }
    }
  }
}

TEST(ComplexStep, KelvinVoigt) {
  const ContactUnderTest law("kelvin-voigt", {{"K", 2e7}, {"D", 300.0}}, bare_pair());
  for (const double penetration : {1e-12, 1e-8, 1e-5, 1e-3}) {
    for (const double rate : {-1.0, -1e-3, 0.0, 1e-3, 1.0}) {
      const ContactForce f = law.law.evaluate({penetration, rate, 0.1});
      const double force = 2e7 * penetration + 300.0 * rate, on = force > 0.0 ? 1.0 : 0.0;
      EXPECT_NEAR(f.normal, on * force, 1e-15 * (std::abs(300.0 * rate) + 2e7 * penetration));
      EXPECT_EQ(f.d_penetration, on * 2e7);
      EXPECT_EQ(f.d_rate, on * 300.0);
      EXPECT_EQ(f.elastic, 2e7 * penetration);
    }
  }
}

/// delta = F/(pi E* L) [ln(B/F) + k] solved for F by bisection in ln F and Newton's method on complex numbers.
Complex line_force(Complex penetration, double modulus, double b, double k) {
  double low = std::log(1e-30 * b), high = std::log(b) + k - 1.0;  // there the slope is infinite
  const auto depth = [&](Complex f) { return f / modulus * (std::log(b / f) + k); };
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (depth(std::exp(middle)).real() < penetration.real() ? low : high) = middle;
  }
  Complex force = std::exp(0.5 * (low + high));
  for (int i = 0; i < 4; ++i) force -= (depth(force) - penetration) * modulus / (std::log(b / force) + k - 1.0);
  return force;
}

TEST(ComplexStep, LawsOfLineContactAndTheirDerivatives) {
  constexpr double length = 0.015, clearance = 1e-4;
  const double plane = 207e9 / (2.0 * (1.0 - 0.09));  // E*
  const struct {
    const char* law;
    double factor, k;
  } forms[] = {{"johnson", 4.0 * M_PI, -1.0}, {"radzimovsky", 3.125, 2.0 / 3.0}, {"esdu-78035", 4.0 * M_PI, 1.0}};
  for (const auto& form : forms) {
    SCOPED_TRACE(form.law);
    const double modulus = M_PI * plane * length, b = form.factor * plane * length * clearance;
    const double limit = form.factor * clearance / M_PI * std::exp(form.k - 1.0);
    const auto elastic = [&](Complex d) { return line_force(d, modulus, b, form.k); };
    const ContactUnderTest plain(form.law, {}, line_pair(length, clearance));
    for (const double part : {1e-8, 1e-5, 1e-3, 0.1, 0.5, 0.9}) {
      const ContactForce f = plain.law.evaluate({part * limit, 0.2, 0.1});
      const Derivative s = derivative(elastic, part * limit);
      EXPECT_NEAR(f.normal / s.value, 1.0, 2e-14);
      EXPECT_NEAR(f.d_penetration / s.slope, 1.0, 1e-13) << part;  // the slope grows without bound toward the limit
      EXPECT_EQ(f.elastic, f.normal);
    }
    for (const Loss& loss : losses) {
      const ContactUnderTest law(form.law, {{"restitution", 0.6}}, line_pair(length, clearance),
                                 {{"damping", loss.word}});
      const double chi = loss.chi(0.6);
      const ContactForce f = law.law.evaluate({0.2 * limit, 0.03, 0.05});
      const Derivative s = derivative(elastic, 0.2 * limit);
      EXPECT_NEAR(f.normal / (s.value * (1.0 + chi * 0.6)), 1.0, 2e-14) << loss.law;
      EXPECT_NEAR(f.d_penetration / (s.slope * (1.0 + chi * 0.6)), 1.0, 1e-13) << loss.law;
      EXPECT_NEAR(f.d_rate / (s.value * chi / 0.05), 1.0, 2e-14) << loss.law;
    }
  }
}

/// mu_eff at v > 0, on the side of a kink where the real part lies.
struct Coefficient {
  const char* law;
  Numbers numbers;
  std::function<Complex(Complex)> mu;
};
const Coefficient coefficients[] = {
    {"coulomb-tanh", {{"mu", 0.2}, {"vs", 2e-3}}, [](Complex v) { return 0.2 * std::tanh(v / 2e-3); }},
    {"coulomb-linear",
     {{"mu", 0.2}, {"vs", 2e-3}},
     [](Complex v) { return v.real() < 2e-3 ? 0.2 * v / 2e-3 : Complex(0.2); }},
    {"coulomb-atan", {{"mu", 0.2}, {"vs", 2e-3}}, [](Complex v) { return 0.4 / M_PI * std::atan(v / 2e-3); }},
    {"ambrosio",
     {{"mu", 0.2}, {"v0", 1e-4}, {"v1", 1e-3}},
     [](Complex v) {
       return v.real() <= 1e-4 ? Complex(0.0) : v.real() >= 1e-3 ? Complex(0.2) : 0.2 * (v - 1e-4) / (1e-3 - 1e-4);
     }},
    {"threlfall",
     {{"mu", 0.2}, {"v_r", 1e-3}},
     [](Complex v) {
       return v.real() <= 1e-3 ? 0.2 * (1.0 - std::exp(-3.0 * v / 1e-3)) / (1.0 - std::exp(-3.0)) : 0.2;
     }},
    {"bengisu-akay",
     {{"mu_s", 0.2}, {"mu_k", 0.12}, {"v0", 1e-3}, {"xi", 80.0}},
     [](Complex v) {
       const Complex u = v / 1e-3 - 1.0;
       return v.real() < 1e-3 ? 0.2 * (1.0 - u * u) : 0.12 + (0.2 - 0.12) * std::exp(-80.0 * (v - 1e-3));
     }},
    {"stribeck",
     {{"mu_s", 0.2}, {"mu_k", 0.12}, {"v_stribeck", 0.01}, {"exponent", 1.7}, {"vs", 2e-3}, {"viscous", 0.3}},
     [](Complex v) { return (0.12 + 0.08 * std::exp(-std::pow(v / 0.01, 1.7))) * std::tanh(v / 2e-3) + 0.3 * v; }}};

TEST(ComplexStep, FrictionLawsAndTheirDerivatives) {
  for (const Coefficient& c : coefficients) {
    SCOPED_TRACE(c.law);
    const FrictionUnderTest friction(c.law, c.numbers);
    for (const double speed : {1e-12, 1e-6, 9.9e-5, 2e-4, 9e-4, 1.5e-3, 3e-3, 0.02, 0.5, 10.0}) {
      for (const double sign : {-1.0, 1.0}) {
        SCOPED_TRACE(sign * speed);
        const FrictionForce f = friction.law.evaluate({150.0, sign * speed, {}}, {});
        const Derivative mu = derivative(c.mu, speed);
        // Differences of terms as large as the coefficients keep their rounding.
        EXPECT_NEAR(f.tangential, -sign * 150.0 * mu.value, 150.0 * 1e-15 + 4e-15 * 150.0 * mu.value);
        EXPECT_NEAR(f.d_normal, -sign * mu.value, 1e-15 + 4e-15 * mu.value);
        EXPECT_NEAR(f.d_slip, -150.0 * mu.slope, 1e-13 * 150.0 * (std::abs(mu.slope) + mu.value / speed));
      }
    }
  }
}

TEST(ComplexStep, LugreAndItsDerivatives) {
  const FrictionUnderTest friction(
      "lugre",
      {{"mu_s", 0.2}, {"mu_k", 0.12}, {"v_stribeck", 0.01}, {"sigma0", 1e5}, {"sigma1", 8.0}, {"sigma2", 0.3}});
  for (const double slip : {-2.0, -0.01, -1e-5, 1e-9, 3e-4, 0.02, 1.0}) {
    for (const double z : {-1.9e-6, -1e-8, 0.0, 5e-7, 1.2e-6}) {
      const double sign = slip > 0.0 ? 1.0 : -1.0;
      const auto rate = [&](Complex v) {
        const Complex u = v / 0.01, g = 0.12 + (0.2 - 0.12) * std::exp(-u * u);
        return v - 1e5 * sign * v / g * z;
      };
      const auto mu = [&](Complex v) { return 1e5 * z + 8.0 * rate(v) + 0.3 * v; };
      double z_rate = 0.0;
      const FrictionForce f = friction.law.evaluate({150.0, slip, {&z, 1}}, {&z_rate, 1});
      const Derivative coefficient = derivative(mu, slip);
      const double terms =
          1e5 * std::abs(z) + 8.0 * std::abs(slip) * (1.0 + 1e5 * std::abs(z) / 0.12) + 0.3 * std::abs(slip);
      EXPECT_NEAR(z_rate, derivative(rate, slip).value, 1e-15 * terms);
      EXPECT_NEAR(f.tangential, -150.0 * coefficient.value, 1e-15 * 150.0 * terms);
      EXPECT_NEAR(f.d_normal, -coefficient.value, 1e-15 * terms);
      EXPECT_NEAR(f.d_slip, -150.0 * coefficient.slope, 4e-15 * 150.0 * terms / std::abs(slip));
    }
  }
}

}  // namespace
}  // namespace freeplay::test
