#include <algorithm>
#include <cmath>
#include <exception>
#include <vector>

#include <fmt/format.h>

#include "contract/guarded_numbers.h"
#include "contract/law_contract.h"
#include "contract/slope.h"

namespace freeplay {
namespace {

constexpr double speeds[] = {1e-6, 3e-5, 2.3e-4, 7e-4, 3e-3, 0.02, 0.13, 1.1, 9.0, 33.0};
constexpr double loads[] = {0.0, 0.7, 25.0, 900.0};

class FrictionLawCheck {
 public:
  FrictionLawCheck(const FrictionLawSubject& subject, const Conditions& conditions)
      : subject_(subject), conditions_(conditions), findings_(conditions.found) {
    WatchedCall watched(conditions_, "internal_variables");
    try {
      const int count = subject.law.internal_variables();
      findings_.expect("answers", count >= 0, [&] { return fmt::format("{} internal variables", count); });
      count_ = static_cast<std::size_t>(std::max(count, 0));
      for (const double speed : subject.law.kinks()) {
        findings_.expect("answers", speed >= 0.0 && std::isfinite(speed),
                         [&] { return fmt::format("kinks() has a slip speed of {} m/s", speed); });
      }
    } catch (const std::exception& e) {
      const std::string text = e.what();
      findings_.expect("answers", false, [&] { return "internal_variables() or kinks() fails: " + text; });
    }
    watched.end();
    look_at_memory();
  }

  Findings run() {
    for (const double load : loads) {
      for (const double speed : speeds) ask(load, -speed, settled(load, speed));
    }
    // What follows would only say the same in other words.
    if (findings_.broken("answers") || findings_.broken("finite")) return std::move(findings_);
    for (const double load : loads) {
      for (const double speed : speeds) {
        check_sign(load, speed);
        for (const double sign : {-1.0, 1.0}) check_derivatives(load, sign * speed);
        check_memory(load, speed);
      }
    }
    for (const double fastest : {0.02, 12.0}) check_cycle(25.0, fastest);
    if (count_ > 0) check_stored();
    return std::move(findings_);
  }

 private:
  struct Answer {
    FrictionForce force{};
    std::vector<double> z_rate;
  };

  Answer ask(const FrictionLawRef& law, double load, double slip, const std::vector<double>& z) {
    GuardedNumbers internal(z), rate(count_);
    Answer answer;
    std::string text;
    WatchedCall watched(conditions_, "evaluate");
    try {
      answer.force = law.evaluate({load, slip, internal.span()}, rate.span());
    } catch (const std::exception& e) {
      text = e.what();
    }
    const long allocated = watched.end();
    answer.z_rate = rate.values();
    const auto where = [&] { return fmt::format("at {:.3g} N, {:.3g} m/s", load, slip); };
    findings_.expect("answers", text.empty(), [&] { return "evaluate() fails " + where() + ": " + text; });
    if (conditions_.allocations && text.empty()) {
      findings_.expect("allocation", allocated == 0,
                       [&] { return fmt::format("evaluate() allocates {}: {} in one call", where(), allocated); });
    }
    findings_.expect("stays-in-span", rate.intact() && internal.intact(),
                     [&] { return "evaluate() writes beside the rates of the internal variables"; });
    bool finite = std::isfinite(answer.force.tangential) && std::isfinite(answer.force.d_normal) &&
                  std::isfinite(answer.force.d_slip);
    for (const double r : answer.z_rate) finite = finite && std::isfinite(r);
    findings_.expect("finite", finite, [&] { return "a result is not finite " + where(); });
    return answer;
  }
  Answer ask(double load, double slip, const std::vector<double>& z) { return ask(subject_.law, load, slip, z); }

  /// What the law declares of its internal variables.
  void look_at_memory() {
    start_.assign(count_, 0.0);
    if (count_ == 0) return;
    GuardedNumbers start(count_);
    std::vector<MemoryReset> resets(count_ + 8, MemoryReset::each_contact);
    WatchedCall watched(conditions_, "memory");
    std::string text;
    try {
      subject_.law.memory(start.span(), {resets.data(), count_});
    } catch (const std::exception& e) {
      text = e.what();
    }
    watched.end();
    findings_.expect("answers", text.empty(), [&] { return "memory() fails: " + text; });
    findings_.expect("stays-in-span", start.intact(), [] { return std::string("memory() writes beside its numbers"); });
    start_ = start.values();
    resets.resize(count_);
    resets_ = resets;
    for (std::size_t k = 0; k < count_; ++k) {
      findings_.expect("memory", std::isfinite(start_[k]) && resets_[k] <= MemoryReset::never, [&] {
        return fmt::format("internal variable {} starts with {} and has the reset {}", k + 1, start_[k],
                           static_cast<unsigned>(resets_[k]));
      });
    }
  }

  double stored(const std::vector<double>& z, std::vector<double>& slopes) {
    GuardedNumbers internal(z), by(count_);
    double energy = 0.0;
    std::string text;
    WatchedCall watched(conditions_, "stored");
    try {
      energy = subject_.law.stored(internal.span(), by.span());
    } catch (const std::exception& e) {
      text = e.what();
    }
    const long allocated = watched.end();
    findings_.expect("answers", text.empty(), [&] { return "stored() fails: " + text; });
    if (conditions_.allocations && text.empty()) {
      findings_.expect("allocation", allocated == 0,
                       [&] { return fmt::format("stored() allocates: {} in one call", allocated); });
    }
    findings_.expect("stays-in-span", by.intact() && internal.intact(),
                     [] { return std::string("stored() writes beside its slopes"); });
    slopes = by.values();
    return energy;
  }

  void check_stored() {
    std::vector<double> slopes, unused;
    const double at_start = stored(start_, slopes);
    findings_.expect("stored-energy", at_start == 0.0,
                     [&] { return fmt::format("{:.6g} J are stored at the start values", at_start); });
    for (const double load : {25.0, 900.0}) {
      const std::vector<double> z = settled(load, 0.02);
      const double here = stored(z, slopes);
      findings_.expect("stored-energy", std::isfinite(here), [&] { return fmt::format("{} J are stored", here); });
      for (std::size_t k = 0; k < count_; ++k) {
        const double scale = std::max(std::abs(z[k]), 1e-9);
        const Slope d = slope(
            [&](double x) {
              std::vector<double> there = z;
              there[k] += x;
              return std::vector<double>{stored(there, unused)};
            },
            0.05 * scale);
        const bool kept = resets_[k] == MemoryReset::never;
        findings_.expect("stored-energy", agrees(slopes[k], d.value[0], d.error[0], 10.0 * std::abs(d.value[0])), [&] {
          return fmt::format("its slope by internal variable {} is {:.9g}, differences give {:.9g}", k + 1, slopes[k],
                             d.value[0]);
        });
        findings_.expect("stored-energy", !kept || slopes[k] == 0.0, [&] {
          return fmt::format("it depends on internal variable {}, which outlives its contact", k + 1);
        });
      }
    }
  }

  /// z <- z + dz with a rule that is implicit in each variable by itself: bristles are stiff and do not couple.
  std::vector<double> advanced(double load, double slip, std::vector<double> z, double dt) {
    const std::vector<double> rate = ask(load, slip, z).z_rate;
    std::vector<double> next = z;
    for (std::size_t k = 0; k < count_; ++k) {
      std::vector<double> there = z;
      const double small = 1e-6 * std::max(std::abs(z[k]), 1e-9);
      there[k] += small;
      const double decay = (ask(load, slip, there).z_rate[k] - rate[k]) / small;
      next[k] += dt * rate[k] / (1.0 - dt * std::min(decay, 0.0));
    }
    return next;
  }
  std::vector<double> settled(double load, double slip) {
    std::vector<double> z = start_;
    for (int i = 0; count_ > 0 && i < 400; ++i) z = advanced(load, slip, z, 1e-2);
    return z;
  }

  void check_sign(double load, double speed) {
    const double there = ask(load, speed, settled(load, speed)).force.tangential;
    const double back = ask(load, -speed, settled(load, -speed)).force.tangential;
    findings_.expect("opposes-slip", there <= 0.0 && back >= 0.0, [&] {
      return fmt::format("the force is {:.6g} N for a slip of {:.3g} m/s and {:.6g} N for its opposite", there, speed,
                         back);
    });
    if (load == 0.0) {
      findings_.expect("unloaded", there == 0.0 && back == 0.0,
                       [&] { return fmt::format("without normal force the friction is {:.6g} N", there); });
    }
  }

  /// Whether differences about this speed reach across one of the kinks that the law declares.
  bool has_kink_near(double slip) const {
    return std::ranges::any_of(subject_.law.kinks(),
                               [&](double speed) { return std::abs(std::abs(slip) - speed) <= 0.15 * std::abs(slip); });
  }

  void check_derivatives(double load, double slip) {
    std::vector<double> z = settled(load, slip);
    for (double& x : z) x *= 0.6;  // off the steady state, where more terms count
    const FrictionForce f = ask(load, slip, z).force;
    const auto compare = [&](const char* name, double given, const Slope& d) {
      findings_.expect("derivatives", agrees(given, d.value[0], d.error[0], 10.0 * std::abs(d.value[0])), [&] {
        return fmt::format("{} is {:.9g}, differences give {:.9g} at {:.3g} N, {:.3g} m/s", name, given, d.value[0],
                           load, slip);
      });
    };
    if (!has_kink_near(slip))
      compare("d_slip", f.d_slip,
              slope([&](double x) { return std::vector<double>{ask(load, slip + x, z).force.tangential}; },
                    0.05 * std::abs(slip)));
    if (load == 0.0) return;
    compare("d_normal", f.d_normal,
            slope([&](double x) { return std::vector<double>{ask(load + x, slip, z).force.tangential}; }, 0.05 * load));
  }

  void check_memory(double load, double speed) {
    const std::vector<double> z(count_, 1e-7);
    const auto numbers = [&](const FrictionLawRef& law) {
      const Answer a = ask(law, load, speed, z);
      std::vector<double> all{a.force.tangential, a.force.d_normal, a.force.d_slip};
      all.insert(all.end(), a.z_rate.begin(), a.z_rate.end());
      return all;
    };
    const std::vector<double> first = numbers(subject_.law);
    ask(2.0 * load + 1.0, -3.0 * speed, z);
    findings_.expect("no-hidden-state", same_bits(first, numbers(subject_.law)),
                     [] { return std::string("the same state gives another force after a call with another state"); });
    findings_.expect("same-twin", same_bits(first, numbers(subject_.twin)),
                     [] { return std::string("two objects with equal parameters differ"); });
  }

  /// Slip to and fro, up to `fastest` [m/s]; the first time lets internal variables settle.
  void check_cycle(double load, double fastest) {
    constexpr int around = 2000;
    const double dt = 0.1 / around;
    std::vector<double> z = start_;
    double work = 0.0, moved = 0.0;
    for (int i = 0; i < 2 * around; ++i) {
      const double slip = fastest * std::sin(2.0 * M_PI * (i + 0.5) / around);
      z = advanced(load, slip, z, dt);
      const double power = ask(load, slip, z).force.tangential * slip;
      if (i < around) continue;
      work += power * dt;
      moved += std::abs(power) * dt;
    }
    findings_.expect("passive", work <= 1e-9 * moved,
                     [&] { return fmt::format("{:.6g} J come out of a cycle of slip", work); });
  }

  const FrictionLawSubject& subject_;
  const Conditions& conditions_;
  std::size_t count_ = 0;
  std::vector<double> start_;
  std::vector<MemoryReset> resets_;
  Findings findings_;
};

}  // namespace

Findings check_friction_law(const FrictionLawSubject& subject, const Conditions& conditions) {
  return FrictionLawCheck(subject, conditions).run();
}

}  // namespace freeplay
