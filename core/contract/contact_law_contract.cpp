#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "contract/guarded_numbers.h"
#include "contract/law_contract.h"
#include "contract/slope.h"

namespace freeplay {
namespace {

std::string words(const ContactState& s) {
  return fmt::format("at {:.3g} m, {:.3g} m/s, approach {:.3g} m/s", s.penetration, s.rate, s.approach_speed);
}

class ContactLawCheck {
 public:
  ContactLawCheck(const ContactLawSubject& subject, const Conditions& conditions)
      : subject_(subject), conditions_(conditions), findings_(conditions.found) {}

  Findings run() {
    check_states();
    // What follows would only say the same in other words.
    if (findings_.broken("answers") || findings_.broken("finite")) return std::move(findings_);
    check_start();
    check_elastic_part();
    for (const double v0 : {0.01, 0.3, 6.0}) {
      for (const double rebound : {0.2, 0.7, 1.0}) check_cycle(v0, rebound);
    }
    check_memory();
    return std::move(findings_);
  }

 private:
  ContactForce ask(const ContactLawRef& law, const ContactState& s) {
    ContactForce f{};
    std::string text;
    WatchedCall watched(conditions_, "evaluate");
    try {
      f = law.evaluate(s);
    } catch (const std::exception& e) {
      text = e.what();
    }
    const long allocated = watched.end();
    findings_.expect("answers", text.empty(), [&] { return "evaluate() fails " + words(s) + ": " + text; });
    if (conditions_.allocations && text.empty()) {
      findings_.expect("allocation", allocated == 0,
                       [&] { return fmt::format("evaluate() allocates {}: {} in one call", words(s), allocated); });
    }
    const bool finite = std::isfinite(f.normal) && std::isfinite(f.d_penetration) && std::isfinite(f.d_rate) &&
                        std::isfinite(f.potential);
    findings_.expect("finite", finite, [&] { return "a result is not finite " + words(s); });
    findings_.expect("no-tension", !(f.normal < 0.0),
                     [&] { return fmt::format("the normal force is {:.6g} N {}", f.normal, words(s)); });
    return f;
  }
  ContactForce ask(const ContactState& s) { return ask(subject_.law, s); }

  std::vector<double> penetrations() const {
    std::vector<double> all;
    for (double x = 1e-8; x < 0.35; x *= 3.7) all.push_back(x * subject_.clearance);
    return all;
  }

  void check_states() {
    for (const double penetration : penetrations()) {
      for (const double v0 : {0.0, 0.003, 0.1, 1.0, 8.0}) {
        for (const double share : {-2.13, -0.91, -0.31, 0.0, 0.43, 1.0, 1.29}) {
          check_state({penetration, share * (v0 > 0.0 ? v0 : 0.2), v0});
        }
        for (const double rate : {-12.0, 12.0}) check_state({penetration, rate, v0});
      }
    }
  }
  void check_state(const ContactState& s) {
    check_derivatives(s);
    check_range(s);
  }

  void check_derivatives(const ContactState& s) {
    const ContactForce f = ask(s);
    if (findings_.broken("answers") || findings_.broken("finite")) return;
    // Where the force is cut at zero there is a kink: either side of it will do.
    const auto compare = [&](const char* name, double given, const auto& force, double largest) {
      Slope d = slope(force, largest);
      const auto good = [&] { return agrees(given, d.value[0], d.error[0], 10.0 * std::abs(d.value[0])); };
      const double central = d.value[0];
      for (const Side side : {Side::above, Side::below}) {
        if (!good()) d = slope(force, largest, side);
      }
      if (findings_.broken("answers") || findings_.broken("finite")) return;
      findings_.expect("derivatives", good(), [&] {
        return fmt::format("{} is {:.9g}, differences give {:.9g} {}", name, given, central, words(s));
      });
    };
    compare(
        "d_penetration", f.d_penetration,
        [&](double x) {
          return std::vector<double>{ask({s.penetration + x, s.rate, s.approach_speed}).normal};
        },
        0.2 * s.penetration);
    const double speed = std::max(std::abs(s.rate), s.approach_speed);
    if (!(speed > 0.0)) return;
    compare(
        "d_rate", f.d_rate,
        [&](double x) {
          return std::vector<double>{ask({s.penetration, s.rate + x, s.approach_speed}).normal};
        },
        0.05 * speed);
  }

  void check_range(const ContactState& s) {
    std::string text;
    const char* why = nullptr;
    WatchedCall watched(conditions_, "outside_range");
    try {
      why = subject_.law.outside_range(s);
    } catch (const std::exception& e) {
      text = e.what();
    }
    const long allocated = watched.end();
    findings_.expect("allocation", allocated == 0 || !text.empty(),
                     [&] { return fmt::format("outside_range() allocates {}", words(s)); });
    findings_.expect("answers", text.empty(), [&] { return "outside_range() fails " + words(s) + ": " + text; });
    findings_.expect("outside-range", why == nullptr || why[0] != '\0',
                     [] { return std::string("outside_range() answers with an empty sentence"); });
  }

  void check_start() {
    const double small = 1e-10 * subject_.clearance, ordinary = 0.01 * subject_.clearance;
    for (const double v0 : {0.0, 0.1}) {
      if (v0 > 0.0 && subject_.may_jump) continue;
      const double first = ask({small, v0, v0}).normal, later = ask({ordinary, v0, v0}).normal;
      // Any power of the penetration above a fourth; a jump leaves a force of the same order.
      findings_.expect("continuous", first <= 1e-2 * later, [&] {
        return fmt::format("contact with {} m/s begins with {:.6g} N; {:.6g} N at a hundredth of the clearance", v0,
                           first, later);
      });
    }
  }

  static bool same_but_rounding(double a, double b) { return std::abs(a - b) <= 1e-12 * std::abs(b); }

  void check_elastic_part() {
    double force = 0.0, energy = 0.0, from = 0.0;
    // A potential may be a difference of terms as large as this, whatever the penetration.
    const double terms = ask({penetrations().back(), 0.0, 0.0}).normal * subject_.clearance;
    const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * terms;
    for (const double penetration : penetrations()) {
      const ContactForce still = ask({penetration, 0.0, 0.0});
      findings_.expect("monotone", still.normal >= force, [&] {
        return fmt::format("the elastic force falls to {:.6g} N {}", still.normal, words({penetration, 0.0, 0.0}));
      });
      force = still.normal;
      for (const double rate : {-11.0, -0.5, 0.02, 1.0, 11.0}) {
        const ContactForce moving = ask({penetration, rate, 0.0});
        findings_.expect("elastic-part", moving.normal == still.normal && moving.d_rate == 0.0, [&] {
          return fmt::format("without approach speed the force depends on the rate {}",
                             words({penetration, rate, 0.0}));
        });
        const ContactForce damped = ask({penetration, rate, 0.4});
        findings_.expect("potential", damped.potential == still.potential && moving.potential == still.potential, [&] {
          return "the stored energy depends on a speed " + words({penetration, rate, 0.4});
        });
        findings_.expect("elastic-part", std::isnan(damped.elastic) || same_but_rounding(damped.elastic, still.normal),
                         [&] {
                           return fmt::format("`elastic` is {:.9g} N, the force without approach speed {:.9g} N {}",
                                              damped.elastic, still.normal, words({penetration, rate, 0.4}));
                         });
      }
      // Powers are exact to 1e-6; logarithms of the penetration cost two digits in the piece that starts at zero.
      energy += integral(from, penetration);
      from = penetration;
      findings_.expect("potential", std::abs(still.potential - energy) <= 1e-4 * energy + rounding, [&] {
        return fmt::format("the stored energy is {:.9g} J, the integral of the elastic force {:.9g} J {}",
                           still.potential, energy, words({penetration, 0.0, 0.0}));
      });
    }
  }

  /// Integral of the elastic force: x = low + (high - low) u^2 takes the root out of the start.
  double integral(double low, double high) {
    constexpr int pieces = 40;
    const auto value = [&](double u) {
      const double x = low + (high - low) * u * u;
      return x > 0.0 ? ask({x, 0.0, 0.0}).normal * 2.0 * u * (high - low) : 0.0;
    };
    double sum = value(0.0) + value(1.0);
    for (int i = 1; i < pieces; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * value(static_cast<double>(i) / pieces);
    return sum / (3.0 * pieces);
  }

  /// Loading from v0 to rest and unloading to `rebound` v0: the sum of F d(penetration) is what the contact takes up.
  void check_cycle(double v0, double rebound) {
    const double deepest = 0.05 * subject_.clearance;
    constexpr int pieces = 2000;
    double taken = 0.0, moved = 0.0;
    for (int i = 0; i < pieces; ++i) {
      const double x = (i + 0.5) / pieces, speed = std::sqrt(1.0 - x * x);
      const double step = deepest / pieces;
      const double in = ask({x * deepest, v0 * speed, v0}).normal;
      const double out = ask({x * deepest, -rebound * v0 * speed, v0}).normal;
      taken += (in - out) * step;
      moved += (in + out) * step;
    }
    // Both ways use the same points, so that an elastic law sums to rounding.
    findings_.expect("passive", taken >= -1e-9 * moved, [&] {
      return fmt::format("a contact that begins with {} m/s gives back {:.6g} J more than it takes", v0, -taken);
    });
  }

  void check_memory() {
    for (const double penetration : penetrations()) {
      const ContactState s{penetration, 0.05, 0.1}, other{0.3 * penetration, -0.07, 0.2};
      const auto numbers = [](const ContactForce& f) {
        return std::vector<double>{f.normal, f.d_penetration, f.d_rate, f.potential};
      };
      const std::vector<double> first = numbers(ask(s));
      ask(other);
      findings_.expect("no-hidden-state", same_bits(first, numbers(ask(s))), [&] {
        return "the same state gives another force after a call with another state " + words(s);
      });
      findings_.expect("same-twin", same_bits(first, numbers(ask(subject_.twin, s))),
                       [&] { return "two objects with equal parameters differ " + words(s); });
    }
  }

  const ContactLawSubject& subject_;
  const Conditions& conditions_;
  Findings findings_;
};

}  // namespace

Findings check_contact_law(const ContactLawSubject& subject, const Conditions& conditions) {
  return ContactLawCheck(subject, conditions).run();
}

}  // namespace freeplay
