#include "assembly/gear_turns.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "model/model.h"

namespace freeplay {

GearTurns::GearTurns(const Model& model, const Layout& layout, std::vector<bool> counted, bool from_slides)
    : counted_as_(model.joints.size()) {
  const auto known = [&](int j) { return counted[static_cast<std::size_t>(j)]; };
  const auto know = [&](int j) { counted[static_cast<std::size_t>(j)] = true; };
  const auto slides = [&](int j) { return layout.turn(j) < 0; };
  const auto link = [&](int from, int to, double ratio, double offset) {
    if (!slides(to)) links_.push_back({from, to, layout.turn(to), ratio, offset});
    know(to);
  };
  const auto follow = [&] {
    for (bool more = true; std::exchange(more, false);) {
      for (const Gear& gear : model.gears) {
        if (!gear.offset || known(gear.first) == known(gear.second)) continue;
        if (known(gear.first)) {
          link(gear.first, gear.second, gear.ratio, *gear.offset);
        } else {
          link(gear.second, gear.first, 1.0 / gear.ratio, -*gear.offset / gear.ratio);
        }
        more = true;
      }
    }
  };
  follow();
  for (const bool choose_slides : {from_slides, !from_slides}) {
    for (const Gear& gear : model.gears) {
      for (const int joint : {gear.first, gear.second}) {
        if (!gear.offset || known(joint) || slides(joint) != choose_slides) continue;
        know(joint);
        follow();
      }
    }
  }
}

bool GearTurns::recount(std::span<const double> coordinate, std::span<double> h) {
  for (std::size_t j = 0; j < counted_as_.size(); ++j) counted_as_[j] = coordinate[j];
  constexpr double turn = 2.0 * std::numbers::pi;
  bool changed = false;
  for (const Link& link : links_) {
    const double near = link.ratio * counted_as_[static_cast<std::size_t>(link.from)] + link.offset;
    double& to = counted_as_[static_cast<std::size_t>(link.to)];
    const double turns = std::round((near - to) / turn);
    to += turns * turn;
    changed = changed || turns != 0.0;
    h[static_cast<std::size_t>(link.turn)] = near;
  }
  return changed;
}

}  // namespace freeplay
