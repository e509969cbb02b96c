// The rules of free_distance() and of the bounds of play: where a joint leaves its bodies alone.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "component/joint_roles.h"
#include "contract/joint_contract.h"
#include "contract/joint_words.h"
#include "freeplay/eigen.h"

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

/// With turns that count: a elsewhere, and b moved by `way` at most as seen from it, shared between a shift and a turn;
/// turned as it likes about an axis of its own beside which no lever stands.
MarkerPair strayed_with_turns(const MarkerPair& from, double way, const std::array<double, 3>& levers,
                              RandomNumbers& random) {
  using Eigen::Matrix3d;
  using Eigen::Vector3d;
  const auto direction = [&] {
    const Vector3d any(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0));
    return Vector3d(any.normalized());
  };
  const double share = random.between(0.0, 1.0), sum = levers[0] + levers[1] + levers[2];
  const Matrix3d to_a = rotation(from.a).transpose();
  const Vector3d shift = to_a * (vector3(from.b.position) - vector3(from.a.position)) + share * way * direction();
  // The tip of a unit axis moves by no more than the angle.
  const double angle = sum > 0.0 ? (1.0 - share) * way / sum : random.between(0.0, 3.0);
  Matrix3d turned = Eigen::AngleAxisd(angle, direction()) * to_a * rotation(from.b);
  for (std::size_t k = 0; k < 3; ++k) {
    if (sum > levers[k] || !(sum > 0.0)) continue;
    turned = turned * Eigen::AngleAxisd(random.between(-3.0, 3.0), Vector3d::Unit(static_cast<Eigen::Index>(k)));
  }
  Pose pose;
  Eigen::Map<Vector3d>(pose.position) = shift;
  Eigen::Map<RowMajor3>(pose.rotation) = turned;
  const MarkerPair elsewhere = moved(from, random_twelve(Space::spatial, random, 0.3));
  return with_twists(placed_pair(elsewhere, pose), random_twelve(Space::spatial, random, 2.0));
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
  const bool turns = probe.space() == Space::spatial && layout.free_turns != 0;
  RandomNumbers of_turns = random;  // so that other rules keep their numbers
  const bool walls = probe.space() == Space::planar && layout.clearance > 0.0 && plays_between_walls(layout);
  for (const JointMoment& moment : moments) {
    const double distance = probe.free_distance(moment);
    if (!(distance > 0.0)) continue;
    const std::array<double, 3> levers = turns ? probe.free_levers(moment) : std::array<double, 3>{};
    for (int i = 0; i < tries; ++i) {
      JointMoment there = moment;
      there.markers = walls   ? strayed_between_walls(moment.markers, inside * distance, layout.contact_reach, random)
                      : turns ? strayed_with_turns(moment.markers, inside * distance, levers, of_turns)
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

/// Within half of its bounds a joint leaves b alone, from twice of one on it does not: both leave room for what is of
/// second order.
void check_bounds(const JointProbe& probe, RandomNumbers random, Findings& findings) {
  constexpr int tries = 12;
  constexpr std::size_t each = 7;
  constexpr double most_turn = 0.2;  // beyond is second order
  const Span<const double> bounds = probe.layout().play_bounds;
  if (bounds.empty() || probe.layout().forces == 0) return;
  Pose middle{{}, {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
  if (!probe.place(0.0, middle)) middle = {{}, {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
  for (int i = 0; i < tries; ++i) {
    // A displacement that bounds hold: a sum of their rows, as large as they leave.
    Eigen::Matrix<double, 6, 1> by = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t b = 0; b < bounds.size; b += each)
      by += random.between(-1.0, 1.0) * Eigen::Map<const Eigen::Matrix<double, 6, 1>>(&bounds[b + 1]);
    double gauge = 0.0;
    for (std::size_t b = 0; b < bounds.size; b += each)
      gauge =
          std::max(gauge, std::abs(by.dot(Eigen::Map<const Eigen::Matrix<double, 6, 1>>(&bounds[b + 1]))) / bounds[b]);
    if (!(gauge > 0.0)) continue;
    const bool out = i % 2 == 1;
    by *= (out ? 2.0 : 0.5) / gauge;
    const double angle = by.tail<3>().norm();
    if (angle > most_turn) continue;
    Pose pose = middle;
    Eigen::Map<Eigen::Vector3d>(pose.position) += by.head<3>();
    if (angle > 0.0)
      Eigen::Map<RowMajor3>(pose.rotation) =
          Eigen::AngleAxisd(angle, by.tail<3>() / angle) * Eigen::Map<const RowMajor3>(middle.rotation);
    const MarkerPair markers = with_twists(placed_pair(random_pair(probe.space(), random), pose), {});
    const JointMoment there = probe.start(markers, 0.0);
    const bool acts = !all_zero(probe.forces(there).wrench);
    findings.expect("play-bounds", acts == out, [&] {
      return fmt::format("{} the bounds that it declares it {}, {}", out ? "at twice" : "at half of",
                         acts ? "exerts something" : "exerts nothing", words_of(there));
    });
  }
}

}  // namespace freeplay
