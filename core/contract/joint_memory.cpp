// Rules about what a joint remembers, and about work over a closed motion.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "contract/joint_contract.h"
#include "contract/joint_walk.h"
#include "contract/joint_words.h"
#include "contract/slope.h"

namespace freeplay {
namespace {

/// The numbers that a walk of `steps` steps leaves.
std::vector<double> trace(const JointProbe& probe, const ClosedPath& path, JointMoment& moment, int from, int steps) {
  constexpr int around = 60;
  const double dt = path.period() / around;
  std::vector<double> numbers;
  JointWalk walk(probe, moment);
  for (int i = from; i < from + steps; ++i) {
    walk.step(path.at((i + 1) * dt), path.acceleration(i * dt), dt);
    const std::vector<double> all = probe.all(walk.now());
    numbers.insert(numbers.end(), all.begin(), all.end());
    numbers.insert(numbers.end(), walk.now().z.begin(), walk.now().z.end());
    numbers.insert(numbers.end(), walk.now().h.begin(), walk.now().h.end());
  }
  moment = walk.now();
  return numbers;
}

void check_rollback(const JointProbe& probe, const JointProbe& twin, RandomNumbers& random, Findings& findings) {
  const ClosedPath path(probe, random);
  JointMoment moment = probe.start(path.at(0.0), 0.0);
  trace(probe, path, moment, 0, 25);
  const JointMoment saved = moment;
  const std::vector<double> straight = trace(probe, path, moment, 25, 30);
  const auto again = [&](const JointProbe& object) {
    JointMoment restored = saved;
    return same_bits(straight, trace(object, path, restored, 25, 30));
  };
  findings.expect("rollback", again(probe) && again(twin),
                  [] { return std::string("a walk that starts from saved z and h differs from the first one"); });
  // The host begins a step again after a failed attempt.
  JointMoment first = saved, second = saved;
  const double dt = path.period() / 60.0;
  probe.begin_step(saved, path.acceleration(0.0), dt, first);
  JointMoment failed = saved;
  probe.begin_step(saved, path.acceleration(0.0), 0.5 * dt, failed);
  probe.begin_step(saved, path.acceleration(0.0), dt, second);
  findings.expect("rollback", same_bits(first.h, second.h),
                  [] { return std::string("a repeated begin_step() prepares another history"); });
}

/// What a joint that gives potential_rate stores may jump only by what it says that it dissipated.
void check_history_loss(const JointProbe& probe, RandomNumbers random, Findings& findings) {
  constexpr int around = 150;
  const ClosedPath path(probe, random);
  const double dt = path.period() / around;
  JointWalk walk(probe, probe.start(path.at(0.0), 0.0));
  double largest = 0.0;
  for (int i = 0; i < 2 * around; ++i) {
    walk.step(path.at((i + 1) * dt), path.acceleration(i * dt), dt);
    const ProbedForces before = probe.forces(walk.tried()), after = probe.forces(walk.now());
    if (std::isnan(before.potential_rate) || std::isnan(after.potential_rate)) return;
    largest = std::max({largest, std::abs(before.potential), std::abs(after.potential)});
    const double fell = before.potential - after.potential, said = walk.now().lost - walk.tried().lost;
    findings.expect("history-loss", std::abs(fell - said) <= 1e-9 * largest, [&] {
      return fmt::format("events and commit() take {:.6g} J out of what is stored and say {:.6g} J, {}", fell, said,
                         words_of(walk.now()));
    });
  }
}

/// Event functions of position alone: their rates against differences along the present twists.
void check_event_rates(const JointProbe& probe, const JointMoment& moment, Findings& findings) {
  const ProbedEvents here = probe.events(moment);
  const auto g_of = [&](double x, bool turn_twists) {
    JointMoment there = moment;
    there.markers = MarkerPath{moment.markers, {}}.at(x);
    if (turn_twists) there.markers = with_twists(moment.markers, {});
    return probe.events(there).g;
  };
  const std::vector<double> at_rest = g_of(0.0, true);
  const Slope d = slope([&](double x) { return g_of(x, false); }, 0.01);
  for (std::size_t i = 0; i < std::min(here.g.size(), d.value.size()); ++i) {
    // A function of speed has a rate that depends on accelerations, which the joint does not get.
    if (std::isnan(here.g[i]) || here.g[i] != at_rest[i]) continue;
    findings.expect("event-rate", agrees(here.rate[i], d.value[i], d.error[i], std::max(1.0, std::abs(here.rate[i]))),
                    [&] {
                      return fmt::format("event '{}' changes at {:.9g} per second, differences give {:.9g}, {}",
                                         probe.layout().events[i].name, here.rate[i], d.value[i], words_of(moment));
                    });
  }
}

/// Energy of the second time around a closed path in `around` steps; the first lets internal variables settle.
struct CycleEnergy {
  double come_out = 0.0, moved = 0.0;  ///< [J]
  double terms = 0.0;                  ///< what work and stored energy are differences of [J]
  // Sums over so many points: the step in which a contact begins is known to one part in a thousand of the work.
  bool is_passive() const { return come_out <= 1e-3 * moved + 1e-13 * terms; }
};
CycleEnergy cycle_energy(const JointProbe& probe, const ClosedPath& path, int around) {
  const double dt = path.period() / around;
  JointWalk walk(probe, probe.start(path.at(0.0), 0.0));
  CycleEnergy energy;
  const auto power_of = [&](const ProbedForces& f, const MarkerPair& markers) {
    const Twelve v = twists(markers);
    double power = 0.0;
    for (std::size_t i = 0; i < 12 && i < f.wrench.size(); ++i) {
      power += f.wrench[i] * v[i];
      energy.terms += dt * std::abs(f.wrench[i] * v[i]);
    }
    return power;
  };
  double before = 0.0;
  for (int i = 0; i < 2 * around; ++i) {
    walk.step(path.at((i + 1) * dt), path.acceleration(i * dt), dt);
    const ProbedForces f = probe.forces(walk.now());
    const double power = power_of(f, walk.now().markers);
    energy.terms = std::max(energy.terms, std::abs(f.potential));
    if (i + 1 == around) energy.come_out -= f.potential;
    if (i >= around) {
      energy.come_out += 0.5 * dt * (before + power);
      energy.moved += dt * std::abs(power);
    }
    before = power;
    if (i + 1 == 2 * around) energy.come_out += f.potential;
  }
  return energy;
}

}  // namespace

void check_cycle(const JointProbe& probe, const JointSubject& subject, RandomNumbers& random, Findings& findings) {
  if (!subject.passive || probe.layout().forces == 0) return;
  const int around = subject.thorough ? 4000 : 1000, finest = 16 * around;
  const ClosedPath path(probe, random);
  CycleEnergy energy = cycle_energy(probe, path, around);
  // A touch of few steps may seem to give what the sum over them errs by: that falls with the steps, a true gain stays.
  for (int steps = 4 * around; !energy.is_passive() && steps <= finest; steps *= 4)
    energy = cycle_energy(probe, path, steps);
  findings.expect("energy-cycle", energy.is_passive(), [&] {
    return fmt::format("{:.6g} J come out of a closed motion in which {:.6g} J are moved", energy.come_out,
                       energy.moved);
  });
}

void check_memory(const JointProbe& probe, const JointProbe& twin, const std::vector<JointMoment>& moments,
                  RandomNumbers& random, Findings& findings) {
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const JointMoment& here = moments[i];
    const JointMoment& elsewhere = moments[(i + 1) % moments.size()];
    const std::vector<double> first = probe.all(here);
    probe.all(elsewhere);
    const std::vector<double> second = probe.all(here);
    findings.expect("no-hidden-state", same_bits(first, second), [&] {
      return "the same input gives other numbers after a call with another input, " + words_of(here);
    });
    findings.expect("same-twin", same_bits(first, twin.all(here)),
                    [&] { return "two objects with equal parameters give different numbers, " + words_of(here); });
    if (probe.layout().events.size > 0) check_event_rates(probe, here, findings);
  }
  check_rollback(probe, twin, random, findings);
  if (probe.layout().forces != 0 && probe.layout().history > 0) check_history_loss(probe, random, findings);
}

}  // namespace freeplay
