#include "run/fast_motion.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace freeplay {
namespace {
constexpr double carries_energy = 1e-2;  // of the largest mean kinetic energy of a part of the run
}

FastMotion::FastMotion(const System& system)
    : system_(system), bodies_(at(system.layout().free_bodies())), counts_(parts, 0), sums_(parts * bodies_) {}

void FastMotion::add(double t, double dt, std::span<const double> start, std::span<const double> end,
                     std::span<const double> v) {
  const Settings& settings = system_.model().settings;
  const double passed = (t - settings.start) / (settings.end - settings.start) * static_cast<double>(parts);
  const auto part = static_cast<std::size_t>(std::clamp(passed, 0.0, static_cast<double>(parts - 1)));
  const std::span<const double> mass = system_.inertia().mass();
  ++counts_[part];
  Sums* sums = &sums_[part * bodies_];
  by_space(system_.model().space, [&]<class Bodies>(Bodies) {
    const double *m = mass.data(), *from = start.data(), *to = end.data(), *speed = v.data();
    for (std::size_t b = 0; b < bodies_; ++b, ++sums) {
      double kinetic = 0.0, change = 0.0, turn = 0.0;
      for (int i = 0; i < Bodies::velocities; ++i, ++m, ++from, ++to, ++speed) {
        const double by = *to - *from;
        kinetic += *m * *speed * *speed;
        change += *m * *to * *to;
        turn += *m * by * by;
      }
      sums->kinetic += kinetic;
      sums->change += dt * dt * change;
      sums->turn += dt * dt * turn;
    }
  });
}

FastMotion::Fewest FastMotion::fewest() const {
  double largest = 0.0;
  for (std::size_t part = 0; part < parts; ++part) {
    double kinetic = 0.0;
    for (std::size_t b = 0; b < bodies_; ++b) kinetic += sums_[part * bodies_ + b].kinetic;
    if (counts_[part] > 0) largest = std::max(largest, kinetic / static_cast<double>(counts_[part]));
  }
  Fewest out;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const Sums& sums = sums_[i];
    if (!(sums.change > 0.0) || !(sums.turn > 0.0)) continue;
    const double angle = 2.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(sums.turn / sums.change)));
    const double carried = sums.change / (angle * angle * static_cast<double>(counts_[i / bodies_]));
    const double steps = 2.0 * M_PI / angle;
    if (!(carried > carries_energy * largest) || !(steps < out.steps)) continue;
    out = {steps, -1, 0.5 * carried};
    for (int body = 0; body < static_cast<int>(system_.model().bodies.size()); ++body) {
      if (system_.layout().place(body) == static_cast<int>(i % bodies_)) out.body = body;
    }
  }
  return out;
}

}  // namespace freeplay
