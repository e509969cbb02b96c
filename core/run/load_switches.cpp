#include "run/load_switches.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/formula_bounds.h"
#include "base/index.h"
#include "run/load_channels.h"

namespace freeplay {

LoadSwitches::LoadSwitches(const System& system)
    : system_(system),
      slots_(system.layout().switches()),
      events_(at(slots_.size)),
      room_(system.forces().applied().switch_numbers()),
      scale_(events_.size()),
      scale_here_(events_.size()),
      sides_(events_.size()),
      units_(events_.size(), 1.0) {
  const LoadChannels channels(system);
  for (const LoadChannels::Load& load : channels.loads()) {
    for (const StateFormula& formula : load.formulas->formulas) {
      const FormulaBounds bounds(formula);
      for (int i = 0; i < formula.switches(); ++i) even_.push_back(bounds.is_even(i) ? 1 : 0);
    }
  }
  for (Event& event : events_) {
    event = Event{};
    event.name = "switch";
    event.crossing = Crossing::rising;
    event.locate = 1;
  }
}

void LoadSwitches::look_from(const Point& start, const Evaluation& e) {
  system_.forces().applied().scale(start, system_.size(), e, room_, scale_);
}

void LoadSwitches::functions(const Point& point, std::span<const double> a, const Evaluation& e, std::span<double> g,
                             std::span<double> rate) {
  const bool even = std::ranges::find(even_, 0) == even_.end();
  if (!even) system_.forces().applied().scale(point, system_.size(), e, room_, scale_here_);
  system_.forces().applied().decide(point, a, e, room_, g, rate);
  for (std::size_t s = 0; s < g.size(); ++s) {
    const double side = point.h[at(slots_.offset) + s];
    if (side == 0.0 || scale_[s] == 0.0 || !std::isfinite(g[s]) || !std::isfinite(rate[s])) {
      g[s] = rate[s] = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    // Beside its zero it may change by far less than where the step starts.
    units_[s] = even_[s] != 0 ? 1.0 : std::min(1.0, scale_here_[s] / scale_[s]);
    g[s] = -side * g[s] / scale_[s] - units_[s] * band_;
    rate[s] = -side * rate[s] / scale_[s];
  }
}

bool LoadSwitches::renew(State& state, const Evaluation& e) {
  if (events_.empty()) return false;
  // The point has the sides that were.
  const std::span<double> sides = state.h().subspan(at(slots_.offset), events_.size());
  std::ranges::copy(sides, sides_.begin());
  const bool changed = system_.forces().applied().take_sides(point(state), state.a(), e, room_, sides_);
  std::ranges::copy(sides_, sides.begin());
  return changed;
}

}  // namespace freeplay
