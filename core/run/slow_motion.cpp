#include "run/slow_motion.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace freeplay {
namespace {
constexpr double least_share = 1e-2;      // of the largest energy that one velocity carried
constexpr double still_moves = 0.03;      // of the largest speed, by the amplitude at the end
constexpr double most_uneven_half = 3.0;  // by the other half of a period
}  // namespace

SlowMotion::SlowMotion(const System& system)
    : system_(system), turns_(at(system.layout().free_bodies()) * at(system.layout().body_velocities())) {}

void SlowMotion::add(double t, double dt, std::span<const double> start, std::span<const double> end) {
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    Turns& turns = turns_[i];
    const double before = start[i], now = end[i];
    if (turns.sign == 0.0 && before == 0.0) turns.times[0] = t - dt;
    turns.largest = std::max(turns.largest, std::abs(now));
    if (now == 0.0) continue;
    if (now * turns.sign < 0.0) {
      turns.times[2] = turns.times[1];
      turns.times[1] = turns.times[0];
      turns.times[0] = before * now < 0.0 ? t - dt * now / (now - before) : t - dt;
    }
    turns.sign = now;
  }
}

Swing SlowMotion::slowest(double t, std::span<const double> v, std::span<const double> a) const {
  const std::span<const double> mass = system_.inertia().mass();
  const auto energy = [&](std::size_t i) { return mass[i] * turns_[i].largest * turns_[i].largest; };
  double most = 0.0;
  for (std::size_t i = 0; i < turns_.size(); ++i) most = std::max(most, energy(i));
  Swing out;
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    const double* times = turns_[i].times;
    const double period = times[0] - times[2], half = times[0] - times[1];
    if (!(period > out.period) || !(period < unbounded) || t - times[0] > period || energy(i) < least_share * most)
      continue;
    if (std::max(half, period - half) > most_uneven_half * std::min(half, period - half)) continue;
    if (std::hypot(v[i], a[i] * period / (2.0 * M_PI)) < still_moves * turns_[i].largest) continue;
    out.period = period;
    const int place = static_cast<int>(i / at(system_.layout().body_velocities()));
    for (int body = 0; body < static_cast<int>(system_.model().bodies.size()); ++body) {
      if (system_.layout().place(body) == place) out.body = body;
    }
  }
  return out;
}

}  // namespace freeplay
