#include "contract/integrator_contract.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "contract/integrator_drive.h"

namespace freeplay {
namespace {

using Kind = ReferenceSystem::Kind;

/// Tight enough that the error of a stage stays below that of the step.
constexpr double tight = 1e-13;

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// Largest errors over a run: position, velocity, multipliers, internal variables.
struct RunErrors {
  double value[4] = {0.0, 0.0, 0.0, 0.0};
  bool complete = false;
};

class IntegratorCheck {
 public:
  IntegratorCheck(const IntegratorSubject& subject, const Conditions& conditions)
      : subject_(subject), conditions_(conditions), findings_(conditions.found) {}

  Findings run() {
    for (const Kind kind : {Kind::oscillator, Kind::pendulum}) {
      const ReferenceSystem reference(kind);
      check_order(reference);
      check_estimate(reference);
      if (findings_.broken("stays-in-span") || findings_.broken("declares-sanely")) return std::move(findings_);
      check_repeatable(reference);
    }
    check_energy();
    check_rest();
    return std::move(findings_);
  }

 private:
  RunErrors run_errors(const ReferenceSystem& reference, const std::vector<KnownState>& known, int steps) {
    IntegratorDrive drive(subject_.integrator, reference, tight, conditions_, findings_);
    RunErrors errors;
    const std::size_t stride = (known.size() - 1) / static_cast<std::size_t>(steps);
    if (!findings_.held() && findings_.broken("declares-sanely")) return errors;
    if (!drive.start()) return errors;
    for (int i = 1; i <= steps; ++i) {
      if (!drive.step(1.0 / steps)) return errors;
      const KnownState& there = known[static_cast<std::size_t>(i) * stride];
      const GuardedState& state = drive.accepted();
      const double now[4] = {distance(there.q, state.q.values()), distance(there.v, state.v.values()),
                             distance(there.lambda, state.lambda.values()), distance(there.z, state.z.values())};
      for (int k = 0; k < 4; ++k) errors.value[k] = std::max(errors.value[k], now[k]);
      check_residuals(drive);
    }
    errors.complete = true;
    return errors;
  }

  /// The stages leave what they were asked for; velocities must have been brought back to the constraints.
  void check_residuals(IntegratorDrive& drive) {
    double position = 0.0, velocity = 0.0;
    drive.residuals(position, velocity);
    findings_.expect("constraints", position <= 1e-10 && velocity <= 1e-8, [&] {
      return fmt::format("a step leaves {:.3g} model sizes in position and {:.3g} m/s in velocity", position, velocity);
    });
  }

  void check_order(const ReferenceSystem& reference) {
    constexpr int counts[] = {20, 40, 80, 160, 320};
    constexpr int finest = 320;
    const std::vector<KnownState> known = reference.motion(1.0 / finest, finest);
    std::vector<RunErrors> runs;
    for (const int count : counts) {
      runs.push_back(run_errors(reference, known, count));
      const bool explained =
          findings_.broken("answers") || findings_.broken("finite") || findings_.broken("stays-in-span");
      findings_.expect("converges", runs.back().complete || explained,
                       [&] { return fmt::format("{} in {} steps stops half-way", reference.name(), count); });
      if (!runs.back().complete) return;
    }
    IntegratorLayout layout;
    layout.sizes = {3, 3, 0, 0};
    Message message;
    if (!subject_.integrator.declare(layout, message)) return;
    constexpr const char* rules[] = {"order-position", "order-velocity", "order-multiplier", "order-internal"};
    for (int k = 0; k < 4; ++k) {
      if (runs[0].value[k] == 0.0) continue;  // the system has none of these
      check_order_of(rules[k], reference, runs, k, layout.order);
    }
  }

  void check_order_of(const char* rule, const ReferenceSystem& reference, const std::vector<RunErrors>& runs, int kind,
                      int declared) {
    // Errors below this are rounding and what the stages leave; values are of order 1, multipliers of order 10.
    const double floor = kind == 2 ? 1e-9 : 1e-10;
    double observed = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < runs.size(); ++i) {
      if (runs[i].value[kind] > floor) observed = std::log2(runs[i - 1].value[kind] / runs[i].value[kind]);
    }
    findings_.expect(rule, observed >= declared - 0.2, [&] {
      return fmt::format("{}: order {:.2f}, declared {}; errors {:.3g} and {:.3g} at steps of 1/160 and 1/320 s",
                         reference.name(), observed, declared, runs[3].value[kind], runs[4].value[kind]);
    });
  }

  /// The estimate falls with the power of the step that is declared, and is not much less than the error itself.
  /// Looked at after some steps of the same size, as methods with a memory need them after a restart, and always at the
  /// same instant.
  void check_estimate(const ReferenceSystem& reference) {
    IntegratorLayout layout;
    layout.sizes = {3, 3, 0, 0};
    Message message;
    if (!subject_.integrator.declare(layout, message) || layout.error_estimate == 0) return;
    const int power = layout.error_order > 0 ? layout.error_order : layout.order + 1;
    // Short enough for the power to show, long enough that the error stays above rounding.
    constexpr double longest = 0.04, tolerance = 1e-10;
    constexpr std::size_t halvings = 2, before = 8;
    const std::vector<KnownState> known = reference.motion(longest / (1 << halvings), (before + 1) << halvings);
    double last = 0.0, slope = 0.0, least_ratio = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i <= halvings; ++i) {
      const double dt = longest / static_cast<double>(1 << i);
      IntegratorDrive drive(subject_.integrator, reference, tight, conditions_, findings_);
      if (!drive.start()) return;
      for (std::size_t k = 0; k < before << i; ++k) {
        if (!drive.step(dt)) return;
      }
      const std::size_t now = before << halvings, stride = std::size_t{1} << (halvings - i);
      double truth = 0.0;
      const double estimate = drive.estimate(dt, tolerance, truth, known[now], known[now + stride]);
      if (i > 0) slope = std::log2(last / estimate);
      last = estimate;
      if (truth > 1e-3) least_ratio = std::min(least_ratio, estimate / truth);
    }
    findings_.expect("estimate-order", std::abs(slope - power) <= 0.5, [&] {
      return fmt::format("{}: the error estimate falls with the power {:.2f} of the step, declared {}",
                         reference.name(), slope, power);
    });
    // What the errors of earlier steps grow by in this one counts in the truth, and is of the same power.
    findings_.expect("estimate-size", least_ratio >= 0.05, [&] {
      return fmt::format("{}: the error estimate is {:.2g} times the error", reference.name(), least_ratio);
    });
  }

  void check_repeatable(const ReferenceSystem& reference) {
    IntegratorDrive drive(subject_.integrator, reference, tight, conditions_, findings_);
    IntegratorDrive twin(subject_.twin, reference, tight, conditions_, findings_);
    constexpr double dt = 0.01;
    if (!drive.start() || !twin.start()) return;
    for (int i = 0; i < 3; ++i) {
      if (!drive.step(dt) || !twin.step(dt)) return;
    }
    bool converged = false, unused = false;
    int stages = 0, unused_stages = 0;
    const std::vector<double> first = drive.attempt(dt, 0.0, -1, converged, stages);
    const auto expect_same = [&](const char* rule, const std::vector<double>& again, const char* what) {
      findings_.expect(rule, same_bits(first, again), [&] { return reference.name() + ": " + what; });
    };
    drive.attempt(3.7 * dt, 1.0, -1, unused, unused_stages);
    expect_same("repeatable", drive.attempt(dt, std::numeric_limits<double>::quiet_NaN(), -1, converged, unused_stages),
                "a step differs after another attempt, or with other numbers in the scratch");
    for (int good = 0; good < std::min(stages, 8); ++good) {
      bool gave_result = false;
      drive.attempt(dt, 0.0, good, gave_result, unused_stages);
      findings_.expect("reports-failure", !gave_result,
                       [&] { return fmt::format("stage {} does not converge, but the attempt does", good + 1); });
      expect_same("repeatable", drive.attempt(dt, 0.0, -1, converged, unused_stages),
                  "a step differs after one that failed");
    }
    expect_same("same-twin", twin.attempt(dt, 0.0, -1, converged, unused_stages),
                "two objects with equal parameters give different numbers");
  }

  void check_energy() {
    const ReferenceSystem reference(Kind::pendulum);
    IntegratorDrive drive(subject_.integrator, reference, tight, conditions_, findings_);
    if (!drive.start()) return;
    const auto energy = [&] { return reference.energy(drive.accepted().q.values(), drive.accepted().v.values()); };
    // From the lowest position, so that growth is measured against the motion and not against a choice of zero.
    const ReferenceSystem lowest(Kind::hanging);
    const KnownState bottom = lowest.start();
    const double start = energy(), swing = start - reference.energy(bottom.q, bottom.v);
    double highest = start;
    for (int i = 0; i < 1000; ++i) {
      // A period of 1.5 s.
      if (!drive.step(0.01)) return;
      highest = std::max(highest, energy());
    }
    // Methods of order 2 that swing around the true energy do so by less; growth in every step passes it long before.
    findings_.expect("energy", highest - start <= 1e-2 * swing, [&] {
      return fmt::format("the energy of a free pendulum grows by {:.3g} of its swing in 1000 steps",
                         (highest - start) / swing);
    });
  }

  void check_rest() {
    const ReferenceSystem reference(Kind::hanging);
    IntegratorDrive drive(subject_.integrator, reference, tight, conditions_, findings_);
    if (!drive.start()) return;
    const KnownState still = reference.start();
    double off = 0.0;
    for (int i = 0; i < 100; ++i) {
      if (!drive.step(0.01)) return;
      off = std::max(
          {off, distance(still.q, drive.accepted().q.values()), distance(still.v, drive.accepted().v.values())});
    }
    // 100 steps of rounding.
    findings_.expect("rest", off <= 1e-12,
                     [&] { return fmt::format("a body at rest has moved by {:.3g} m or m/s after 100 steps", off); });
  }

  const IntegratorSubject& subject_;
  const Conditions& conditions_;
  Findings findings_;
};

}  // namespace

Findings check_integrator(const IntegratorSubject& subject, const Conditions& conditions) {
  return IntegratorCheck(subject, conditions).run();
}

}  // namespace freeplay
