#include "contract/contact_poses.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "component/joint_roles.h"
#include "freeplay/eigen.h"

namespace freeplay {
namespace {

constexpr int tries_for_each = 16, most_of_one = 2;
constexpr double stride = 0.15, farthest_place = 6.0;  // of the way in the middle
constexpr double largest_turn = 0.1;                   // [rad] for each way

using Three = Eigen::Map<const Eigen::Vector3d>;

Eigen::Vector3d normal_of(const ContactPose& pose) { return Three(pose.by_twist.data()); }

/// The events of each contact.
std::vector<ContactPose> contacts_of(const JointProbe& probe) {
  std::vector<ContactPose> all;
  const JointLayout& layout = probe.layout();
  for (std::size_t i = 0; i < layout.events.size; ++i) {
    if (event_role(layout, i) != EventRole::contact_begin) continue;
    ContactPose one;
    one.contact = all.size();
    one.begin = static_cast<int>(i);
    all.push_back(one);
  }
  for (std::size_t i = 0; i < layout.events.size; ++i) {
    if (event_role(layout, i) != EventRole::contact_end) continue;
    if (const std::size_t which = contact_of(layout, i); which < all.size()) all[which].end = static_cast<int>(i);
  }
  return all;
}

/// Not in the very middle, where an eccentricity has no direction.
MarkerPair middle_of_play(const JointProbe& probe, RandomNumbers& random) {
  MarkerPair pair = with_twists(random_pair(probe.space(), random), {});
  Pose pose{};
  if (!probe.place(0.2, pose)) pose = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
  pair = placed_pair(pair, pose);
  for (const std::size_t i : moving_components(probe.space())) {
    if (i < 3) pair.b.position[i] += 0.01 * probe.layout().clearance * random.between(-1.0, 1.0);
  }
  return pair;
}

/// b moved by a displacement and a rotation vector, six numbers, times `s`.
MarkerPair moved_by(const MarkerPair& from, const std::array<double, 6>& way, double s) {
  Twelve by{};
  for (std::size_t i = 0; i < 6; ++i) by[6 + i] = s * way[i];
  return moved(from, by);
}

class Search {
 public:
  Search(const JointProbe& probe, RandomNumbers& random)
      : probe_(probe),
        random_(random),
        contacts_(contacts_of(probe)),
        middle_(probe.start(middle_of_play(probe, random), 0.0)) {}

  std::vector<ContactPose> run() {
    std::vector<ContactPose> found;
    if (contacts_.empty() || !measure()) return found;
    for (std::size_t i = 0; i < tries_for_each * contacts_.size(); ++i) {
      std::optional<ContactPose> pose = toward(direction());
      if (!pose) continue;
      const auto same = [&](const ContactPose& other) { return other.contact == pose->contact; };
      if (std::ranges::count_if(found, same) < most_of_one) found.push_back(*pose);
    }
    return found;
  }

 private:
  std::vector<double> functions(const JointMoment& moment) const {
    const std::vector<double> g = probe_.events(moment).g;
    std::vector<double> all;
    for (const ContactPose& one : contacts_) {
      const auto i = static_cast<std::size_t>(one.begin);
      all.push_back(i < g.size() ? g[i] : std::numeric_limits<double>::quiet_NaN());
    }
    return all;
  }
  std::array<double, 6> gradient(const JointMoment& at, int event) const {
    std::array<double, 6> result{};
    for (const std::size_t i : moving_components(probe_.space())) {
      if (i < 6) continue;
      JointMoment there = at;
      Twelve twist{};
      twist[i] = 1.0;
      there.markers = with_twists(at.markers, twist);
      const std::vector<double> rate = probe_.events(there).rate;
      if (static_cast<std::size_t>(event) < rate.size()) result[i - 6] = rate[static_cast<std::size_t>(event)];
    }
    return result;
  }
  /// How far the nearest contact is, and how much a turn brings; false when one is on.
  bool measure() {
    const std::vector<double> g = functions(middle_);
    for (std::size_t i = 0; i < g.size(); ++i) {
      if (std::isnan(g[i])) continue;
      if (!(g[i] < 0.0)) return false;
      way_ = std::min(way_, -g[i]);
      const std::array<double, 6> by = gradient(middle_, contacts_[i].begin);
      for (std::size_t k = 3; k < 6; ++k) reach_ = std::max(reach_, std::abs(by[k]));
    }
    return way_ < unbounded;
  }
  std::array<double, 6> direction() {
    std::array<double, 6> result{};
    const double turn = reach_ > 0.0 ? std::min(way_ / reach_, largest_turn) : largest_turn;
    for (const std::size_t i : moving_components(probe_.space())) {
      if (i >= 6) result[i - 6] = random_.between(-1.0, 1.0) * (i < 9 ? way_ : turn);
    }
    return result;
  }
  std::optional<ContactPose> toward(const std::array<double, 6>& way) {
    JointMoment there = middle_;
    const auto deepest = [&](double s, std::size_t& which) {
      there.markers = moved_by(middle_.markers, way, s);
      const std::vector<double> g = functions(there);
      double most = -unbounded;
      for (std::size_t i = 0; i < g.size(); ++i) {
        if (g[i] > most) most = g[i], which = i;
      }
      return most;
    };
    std::size_t which = 0;
    double low = 0.0, high = stride;
    while (high < farthest_place && !(deepest(high, which) > 0.0)) low = high, high += stride;
    if (!(high < farthest_place)) return std::nullopt;
    for (int i = 0; i < 52; ++i) {
      const double between = 0.5 * (low + high);
      std::size_t here = 0;
      if (deepest(between, here) > 0.0) {
        high = between;
        which = here;
      } else {
        low = between;
      }
    }
    there.markers = moved_by(middle_.markers, way, low);
    ContactPose pose = contacts_[which];
    pose.markers = there.markers;
    pose.way = way_;
    pose.by_twist = gradient(there, pose.begin);
    // Others that close soon would be part of the same impact.
    const std::vector<double> g = functions(there);
    for (std::size_t i = 0; i < g.size(); ++i) {
      if (i != which && g[i] > -0.05 * way_) return std::nullopt;
    }
    if (!(normal_of(pose).norm() > 1e-6)) return std::nullopt;
    return pose;
  }

  const JointProbe& probe_;
  RandomNumbers& random_;
  std::vector<ContactPose> contacts_;
  JointMoment middle_;
  double way_ = unbounded, reach_ = 0.0;
};

}  // namespace

MarkerPair ContactPose::at(double depth) const {
  const Eigen::Vector3d shift = normal_of(*this) * (depth / normal_of(*this).squaredNorm());
  MarkerPair pair = markers;
  for (int i = 0; i < 3; ++i) pair.b.position[i] += shift[i];
  return pair;
}

double ContactPose::lever() const { return Three(&by_twist[3]).norm() / normal_of(*this).norm(); }

double ContactPose::push(const std::vector<double>& wrench) const {
  return wrench.size() < 12 ? 0.0 : -Three(&wrench[6]).dot(normal_of(*this)) / normal_of(*this).squaredNorm();
}

Twelve ContactPose::closing(Twelve twist, double rate) const {
  double now = 0.0;
  for (std::size_t i = 0; i < 6; ++i) now += by_twist[i] * twist[6 + i];
  const double square = normal_of(*this).squaredNorm();
  for (std::size_t i = 0; i < 3; ++i) twist[6 + i] += by_twist[i] * (rate - now) / square;
  return twist;
}

std::vector<ContactPose> contact_poses(const JointProbe& probe, RandomNumbers& random) {
  return Search(probe, random).run();
}

std::string contact_word(const JointProbe& probe, const ContactPose& pose) {
  return fmt::format("the contact of '{}'", probe.layout().events[static_cast<std::size_t>(pose.begin)].name);
}

}  // namespace freeplay
