#include "assembly/gear_turns.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/model.h"

namespace freeplay {
namespace {

constexpr int most_turns = 100;         // of a joint that leads; ratios of few digits repeat themselves before
constexpr double clearly_less = 1e-12;  // [rad^2]

}  // namespace

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
        if (!slides(joint)) leads_.push_back({joint, layout.turn(joint), links_.size()});
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

void GearTurns::turn_leads(std::span<const double> given, std::span<double> h) const {
  constexpr double turn = 2.0 * std::numbers::pi;
  std::vector<double> value(given.size()), gain(given.size());  // of coordinates, and by that of the lead
  for (std::size_t i = 0; i < leads_.size(); ++i) {
    const Lead& lead = leads_[i];
    const std::size_t last = i + 1 < leads_.size() ? leads_[i + 1].first : links_.size();
    const auto joint = static_cast<std::size_t>(lead.joint);
    const double start = std::isnan(given[joint]) ? 0.0 : given[joint];
    const auto misses = [&](double from) {
      std::ranges::fill(value, std::nan(""));
      value[joint] = from, gain[joint] = 1.0;
      double squares = 0.0, along = 0.0, gains = 0.0;
      const auto count = [&](std::size_t j) {
        if (std::isnan(value[j]) || std::isnan(given[j])) return;
        const double miss = std::remainder(given[j] - value[j], turn);
        squares += miss * miss, along += gain[j] * miss, gains += gain[j] * gain[j];
      };
      count(joint);
      for (std::size_t l = lead.first; l < last; ++l) {
        const auto to = static_cast<std::size_t>(links_[l].to), by = static_cast<std::size_t>(links_[l].from);
        value[to] = links_[l].ratio * value[by] + links_[l].offset;
        gain[to] = links_[l].ratio * gain[by];
        count(to);
      }
      return gains > 0.0 ? squares - along * along / gains : 0.0;
    };
    double best = start, least = misses(start);
    for (int turns = 1; turns <= most_turns; ++turns) {
      for (const double other : {start + turns * turn, start - turns * turn}) {
        if (const double now = misses(other); now < least - clearly_less) least = now, best = other;
      }
    }
    h[static_cast<std::size_t>(lead.turn)] = best;
  }
}

}  // namespace freeplay
