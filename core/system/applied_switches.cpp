// The switches of formulas of the motion: what decides them, and their sides.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.h"
#include "system/applied_forces.h"
#include "system/evaluation.h"

namespace freeplay {

std::string AppliedForces::words_of_switch(int index) const {
  const auto after = std::ranges::upper_bound(loads_, index, {}, &Load::first_switch);
  const Load& load = *std::prev(after);
  if (load.force >= 0) return "force '" + model_.forces[at(load.force)].name + "'";
  if (load.driver >= 0) return "driver '" + model_.drivers[at(load.driver)].name + "'";
  const JointElement& joint = model_.joints[at(load.joint)];
  return (joint.is_force ? "force '" : "joint '") + joint.name + "'";
}

void AppliedForces::decide(const Point& point, std::span<const double> a, const Evaluation& e, std::span<double> room,
                           std::span<double> values, std::span<double> rates) const {
  std::ranges::fill(values, std::numeric_limits<double>::quiet_NaN());
  std::ranges::fill(rates, std::numeric_limits<double>::quiet_NaN());
  std::size_t next = 0;
  for (const Load& load : loads_) {
    const MotionFormulas& formulas = *load.formulas;
    if (formulas.switches() == 0) continue;
    StateFormula::Input in = input(load, point, e, room);
    const std::span<double> changes = room.subspan(most_channels_, in.variables.size());
    for (std::size_t k = 0; k < changes.size(); ++k) changes[k] = channels_.rate(formulas.channels[k], a, e);
    for (const StateFormula& formula : formulas.formulas) {
      const std::size_t count = at(formula.switches());
      if (count > 0) formula.decide(in, changes, 1.0, values.subspan(next, count), rates.subspan(next, count));
      next += count;
      in.sides += count;
    }
  }
}

void AppliedForces::decide(const Point& point, const Evaluation& e, std::span<double> room,
                           std::span<double> values) const {
  std::ranges::fill(values, std::numeric_limits<double>::quiet_NaN());
  std::size_t next = 0;
  for (const Load& load : loads_) {
    if (load.formulas->switches() == 0) continue;
    StateFormula::Input in = input(load, point, e, room);
    for (const StateFormula& formula : load.formulas->formulas) {
      const std::size_t count = at(formula.switches());
      if (count > 0) formula.decide(in, values.subspan(next, count));
      next += count;
      in.sides += count;
    }
  }
}

void AppliedForces::scale(const Point& point, double size, const Evaluation& e, std::span<double> room,
                          std::span<double> scales) const {
  std::ranges::fill(scales, 0.0);
  const std::span<double> of_one = room.subspan(2 * most_channels_);
  std::size_t first = 0;
  for (const Load& load : loads_) {
    const MotionFormulas& formulas = *load.formulas;
    const StateFormula::Input in = input(load, point, e, room);
    const std::size_t channels = in.variables.size();
    const std::span<double> unit = room.subspan(most_channels_, channels);
    std::ranges::fill(unit, 0.0);
    for (std::size_t k = 0; formulas.switches() > 0 && k <= channels; ++k) {
      if (k < channels) unit[k] = channels_.turns(formulas.channels[k]) ? 1.0 / size : 1.0;
      StateFormula::Input own = in;
      std::size_t next = first;
      for (const StateFormula& formula : formulas.formulas) {
        const std::size_t count = at(formula.switches());
        const std::span<double> values = of_one.first(count), rates = of_one.subspan(count, count);
        std::ranges::fill(rates, 0.0);
        if (count > 0) formula.decide(own, unit, k < channels ? 0.0 : 1.0, values, rates);
        for (const double rate : rates) {
          if (std::isfinite(rate)) scales[next] += std::abs(rate);
          ++next;
        }
        own.sides += count;
      }
      if (k < channels) unit[k] = 0.0;
    }
    first += at(formulas.switches());
  }
}

bool AppliedForces::take_sides(const Point& point, std::span<const double> a, const Evaluation& e,
                               std::span<double> room, std::span<double> sides) const {
  const std::span<double> values = room.subspan(2 * most_channels_, sides.size());
  const std::span<double> rates = room.subspan(2 * most_channels_ + sides.size(), sides.size());
  // Rates are wanted where a switch is zero from the start on.
  decide(point, e, room, values);
  for (std::size_t s = 0; s < values.size(); ++s) {
    if (values[s] == 0.0 && sides[s] == 0.0) {
      decide(point, a, e, room, values, rates);
      break;
    }
  }
  bool changed = false;
  std::size_t next = 0;
  for (const Load& load : loads_) {
    for (const StateFormula& formula : load.formulas->formulas) {
      for (int s = 0; s < formula.switches(); ++s, ++next) {
        const double before = sides[next], value = values[next];
        if (value > 0.0 || value < 0.0) {
          sides[next] = value > 0.0 ? 1.0 : -1.0;
          changed = changed || (before != 0.0 && before != sides[next]);
        } else if (value == 0.0 && before == 0.0) {
          sides[next] = formula.side_at_zero(s, rates[next]);
          changed = true;
        }
      }
    }
  }
  return changed;
}

}  // namespace freeplay
