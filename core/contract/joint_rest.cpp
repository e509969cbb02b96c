// The rule of free_distance(): what a joint promises to leave alone.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "component/joint_roles.h"
#include "contract/joint_contract.h"
#include "contract/joint_words.h"

namespace freeplay {
namespace {

/// Play between walls: a elsewhere, and b moved by `way` at most, shared between a shift across and a turn; along the
/// walls by any way.
MarkerPair strayed_between_walls(const MarkerPair& from, double way, double reach, RandomNumbers& random) {
  const double *h = from.a.rotation, *x = from.b.rotation, share = random.between(-1.0, 1.0);
  const double d[2] = {from.b.position[0] - from.a.position[0], from.b.position[1] - from.a.position[1]};
  const double rest = (1.0 - std::abs(share)) * way, most = reach > 0.0 ? rest / reach : 3.0;
  const double angle =
      std::atan2(h[0] * x[3] - h[3] * x[0], h[0] * x[0] + h[3] * x[3]) + std::copysign(most, random.between(-1.0, 1.0));
  const double c = std::cos(angle), s = std::sin(angle);
  const Pose pose{{h[0] * d[0] + h[3] * d[1] + random.between(-1.0, 1.0), h[0] * d[1] - h[3] * d[0] + share * way, 0.0},
                  {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0}};
  const MarkerPair elsewhere = moved(from, random_twelve(Space::planar, random, 0.3));
  return with_twists(placed_pair(elsewhere, pose), random_twelve(Space::planar, random, 2.0));
}

/// The markers elsewhere, turned and moving otherwise, with their origins moved against each other by `way` at most.
MarkerPair strayed(const MarkerPair& from, Space space, double way, RandomNumbers& random) {
  Twelve by = random_twelve(space, random, 0.3);
  const Twelve direction = random_twelve(space, random, 1.0);
  const double size = random.between(0.0, way) / std::hypot(direction[0], direction[1], direction[2]);
  for (std::size_t i = 0; i < 3; ++i) by[6 + i] = by[i] + size * direction[i];
  return with_twists(moved(from, by), random_twelve(space, random, 2.0));
}

bool all_zero(const std::vector<double>& numbers) {
  return std::ranges::all_of(numbers, [](double x) { return x == 0.0; });
}

}  // namespace

void check_rest(const JointProbe& probe, const std::vector<JointMoment>& moments, RandomNumbers& random,
                Findings& findings) {
  constexpr int tries = 4;
  constexpr double inside = 1.0 - 1e-6;  // rounding of where the markers are put
  const JointLayout& layout = probe.layout();
  const bool walls = probe.space() == Space::planar && layout.clearance > 0.0 && plays_between_walls(layout);
  for (const JointMoment& moment : moments) {
    const double distance = probe.free_distance(moment);
    if (!(distance > 0.0)) continue;
    for (int i = 0; i < tries; ++i) {
      JointMoment there = moment;
      there.markers = walls ? strayed_between_walls(moment.markers, inside * distance, layout.contact_reach, random)
                            : strayed(moment.markers, probe.space(), inside * distance, random);
      const auto expect = [&](bool held, const char* what) {
        findings.expect("free-distance", held, [&] {
          return fmt::format("within the {:.6g} m that free_distance() gives {}, {}", distance, what, words_of(there));
        });
      };
      const ProbedForces f = probe.forces(there);
      const bool stores = f.potential != 0.0 || (!std::isnan(f.potential_rate) && f.potential_rate != 0.0);
      expect(all_zero(f.wrench) && all_zero(f.z_rate) && !stores, "it exerts or stores something");
      const ProbedEvents events = probe.events(there);
      for (std::size_t e = 0; e < events.g.size(); ++e) {
        const double sign = probe.layout().events[e].crossing == Crossing::rising ? 1.0 : -1.0;
        expect(!(sign * events.g[e] > 0.0), "an event is past its zero");
      }
      expect(!probe.warns(there), "it warns");
      JointMoment later = there;
      probe.begin_step(there, random_twelve(probe.space(), random, 10.0), 1e-4, later);
      probe.commit(later);
      expect(same_bits(probe.all(there), probe.all(later)), "begin_step() and commit() change what it answers");
    }
  }
}

}  // namespace freeplay
