#include "assembly/loop_sides.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "base/index.h"
#include "system/joint_freedom.h"

namespace freeplay {
namespace {

constexpr std::size_t most_joints_of_loop = 12;
constexpr int most_passages = 50000;  // that are tried: a tenth of a second
constexpr double no_side = 1e-9;      // [m]

struct Side {
  BodyId body = ground;
  double length = 0.0;  ///< [m]
};

/// A way through a joint, from the marker where it comes to that where it goes on.
struct Passage {
  int joint = -1, from = 0, to = 0;
};

/// All loops of joints that hold two points together, each begun at one of its joints.
class PinLoops {
 public:
  explicit PinLoops(const Model& model) : model_(model), from_(model.bodies.size() + 1) {
    for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
      const JointElement& joint = model.joints[at(j)];
      if (!holds_origins(joint, model.space)) continue;
      pins_.push_back(j);
      from_[place(body_of(joint.marker_a))].push_back({j, joint.marker_a, joint.marker_b});
      from_[place(body_of(joint.marker_b))].push_back({j, joint.marker_b, joint.marker_a});
    }
  }

  std::span<const int> pins() const { return pins_; }

  void look_through(int joint) {
    const JointElement& first = model_.joints[at(joint)];
    if (body_of(first.marker_a) == body_of(first.marker_b)) return;
    way_.assign(1, {joint, first.marker_a, first.marker_b});
    seen_.assign(from_.size(), 0);
    go_on(body_of(first.marker_a));
  }

  std::optional<OverlongLoop> best() const {
    if (best_.empty()) return std::nullopt;
    OverlongLoop loop;
    std::vector<std::string> joints, lengths;
    for (const Passage& passage : best_) {
      loop.joints.push_back(passage.joint);
      joints.push_back(fmt::format("'{}'", model_.joints[at(passage.joint)].name));
    }
    const std::vector<Side> sides = sides_of(best_);
    for (const Side& side : sides) lengths.push_back(fmt::format("{} {:.4g} m", name_of(side.body), side.length));
    loop.one_side = sides.size() == 1;
    loop.text = enumerated(lengths);
    if (!loop.one_side)
      loop.text += fmt::format(", and that of {} is longer than the others together",
                               name_of(std::ranges::max_element(sides, {}, &Side::length)->body));
    loop.text += fmt::format(" (joints {})", enumerated(joints));
    return loop;
  }

 private:
  BodyId body_of(int marker) const { return model_.markers[at(marker)].body; }
  std::size_t place(BodyId body) const { return at(body + 1); }  // ground first
  std::string name_of(BodyId body) const {
    return body == ground ? "ground" : fmt::format("'{}'", model_.bodies[at(body)].name);
  }

  void go_on(BodyId end) {
    const BodyId here = body_of(way_.back().to);
    if (here == end) return judge();
    if (way_.size() == most_joints_of_loop) return;
    seen_[place(here)] = 1;
    for (const Passage& passage : from_[place(here)]) {
      if (++tried_ > most_passages) break;
      if (passage.joint == way_.front().joint || seen_[place(body_of(passage.to))]) continue;
      way_.push_back(passage);
      go_on(end);
      way_.pop_back();
    }
    seen_[place(here)] = 0;
  }

  std::vector<Side> sides_of(std::span<const Passage> way) const {
    std::vector<Side> sides;
    for (std::size_t i = 0; i < way.size(); ++i) {
      const Passage &in = way[i], &out = way[(i + 1) % way.size()];
      const Vector3 &a = model_.markers[at(in.to)].position, &b = model_.markers[at(out.from)].position;
      const double length = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
      if (length > no_side) sides.push_back({body_of(in.to), length});
    }
    return sides;
  }

  void judge() {
    const std::vector<Side> sides = sides_of(way_);
    if (!best_.empty() && sides.size() >= best_sides_) return;
    double sum = 0.0, longest = 0.0;
    for (const Side& side : sides) sum += side.length, longest = std::max(longest, side.length);
    // Of a loop that is stretched out roundings may say that it is too short.
    if (longest - (sum - longest) <= std::max(model_.settings.assembly_tolerance, no_side * longest)) return;
    best_ = way_;
    best_sides_ = sides.size();
  }

  const Model& model_;
  std::vector<std::vector<Passage>> from_;
  std::vector<int> pins_;
  std::vector<Passage> way_, best_;
  std::size_t best_sides_ = 0;
  std::vector<char> seen_;
  int tried_ = 0;
};

}  // namespace

std::optional<OverlongLoop> overlong_loop(const Model& model, int joint) {
  PinLoops loops(model);
  for (const int pin : loops.pins()) {
    if (joint < 0 || pin == joint) loops.look_through(pin);
  }
  return loops.best();
}

std::string enumerated(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  }
  return text;
}

}  // namespace freeplay
