#include "assembly/loop_sides.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "base/index.h"
#include "model/force_element.h"
#include "system/joint_freedom.h"

namespace freeplay {
namespace {

constexpr std::size_t most_sides = 8;
constexpr double no_side = 1e-9;  // [m]

struct Side {
  BodyId body = ground;
  double length = 0.0;  ///< [m]
};

/// A way through a joint, from the marker where it comes to that where it goes on.
struct Passage {
  int joint = -1, from = 0, to = 0;
};

class Loop {
 public:
  Loop(const Model& model, int joint) : model_(model) {
    const JointElement& open = model.joints[at(joint)];
    if (open.gear >= 0 || !find(joint, body_of(open.marker_b), body_of(open.marker_a))) return;
    way_.push_back({joint, open.marker_a, open.marker_b});
    for (std::size_t i = 0; i < way_.size(); ++i) {
      const Passage &in = way_[(i + way_.size() - 1) % way_.size()], &out = way_[i];
      const Vector3 &a = model.markers[at(in.to)].position, &b = model.markers[at(out.from)].position;
      const double length = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
      if (length > no_side) sides_.push_back({body_of(in.to), length});
    }
  }

  const std::vector<Side>& sides() const { return sides_; }
  bool holds_points_together() const {
    return std::ranges::all_of(way_, [&](const Passage& passage) {
      const JointElement& joint = model_.joints[at(passage.joint)];
      return !joint.has_play && holds_origins(joint, model_.space);
    });
  }

 private:
  BodyId body_of(int marker) const { return model_.markers[at(marker)].body; }

  /// The shortest way from one body to another without the joint.
  bool find(int without, BodyId from, BodyId to) {
    std::vector<Passage> came(model_.bodies.size() + 1);  // ground first
    const auto place = [](BodyId body) { return at(body + 1); };
    std::deque<BodyId> due{from};
    std::vector<char> seen(came.size(), 0);
    for (seen[place(from)] = 1; !due.empty() && !seen[place(to)]; due.pop_front()) {
      for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
        const JointElement& joint = model_.joints[at(j)];
        if (j == without || joint.gear >= 0 || is_force_element(joint)) continue;
        for (const Passage& passage :
             {Passage{j, joint.marker_a, joint.marker_b}, {j, joint.marker_b, joint.marker_a}}) {
          const BodyId next = body_of(passage.to);
          if (body_of(passage.from) != due.front() || seen[place(next)]) continue;
          seen[place(next)] = 1;
          came[place(next)] = passage;
          due.push_back(next);
        }
      }
    }
    if (!seen[place(to)] || from == to) return false;
    for (BodyId body = to; body != from; body = body_of(came[place(body)].from)) way_.push_back(came[place(body)]);
    std::ranges::reverse(way_);
    return true;
  }

  const Model& model_;
  std::vector<Passage> way_;
  std::vector<Side> sides_;
};

std::string name_of(BodyId body, const Model& model) {
  return body == ground ? "ground" : fmt::format("'{}'", model.bodies[at(body)].name);
}

}  // namespace

std::string sides_of_loop(const Model& model, int joint) {
  const Loop loop(model, joint);
  const std::vector<Side>& sides = loop.sides();
  if (sides.size() < 2 || sides.size() > most_sides) return {};
  std::string text = "; the sides of its loop are ";
  for (std::size_t i = 0; i < sides.size(); ++i) {
    text += fmt::format("{}{} {:.4g} m",
                        i == 0                  ? ""
                        : i + 1 == sides.size() ? " and "
                                                : ", ",
                        name_of(sides[i].body, model), sides[i].length);
  }
  const Side& longest = *std::ranges::max_element(sides, {}, &Side::length);
  const double all =
      std::accumulate(sides.begin(), sides.end(), 0.0, [](double sum, const Side& side) { return sum + side.length; });
  if (loop.holds_points_together() && longest.length > all - longest.length)
    text += fmt::format(", and that of {} is longer than the others together", name_of(longest.body, model));
  return text;
}

}  // namespace freeplay
