#include "assembly/continuation.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "assembly/even_spread.h"
#include "base/index.h"

namespace freeplay {
namespace {

constexpr double longest_move =
    0.4;  // of a body in one step, in rad and over the size of the model: beyond, it has leapt

double largest_move(const System& system, std::span<const double> from, std::span<const double> to) {
  std::vector<double> increment(at(system.layout().nv()));
  system.coordinates().difference(from, to, increment);
  double largest = 0.0;
  for (int i = 0; i < static_cast<int>(increment.size()); ++i) {
    largest = std::max(largest, std::abs(increment[at(i)]) / (system.coordinates().is_turn(i) ? 1.0 : system.size()));
  }
  return largest;
}

}  // namespace

bool follow(ClosedMechanism& mechanism, const std::function<void()>& prescribe, std::span<const double> ahead) {
  const std::vector<double> q(mechanism.state.q().begin(), mechanism.state.q().end());
  const std::vector<double> h(mechanism.state.h().begin(), mechanism.state.h().end());
  prescribe();
  if (!ahead.empty()) mechanism.system.coordinates().retract(q, ahead, mechanism.state.q());
  if (mechanism.holds(mechanism.converge()) && largest_move(mechanism.system, q, mechanism.state.q()) <= longest_move) {
    mechanism.keep_turns();
    return true;
  }
  std::ranges::copy(q, mechanism.state.q().begin());
  std::ranges::copy(h, mechanism.state.h().begin());
  return false;
}

// Newton cannot follow from a singular position, where the mechanism may go on in two ways: it is sought from positions
// around, whose turns are spread by the golden ratio.
bool leave_dead_point(ClosedMechanism& mechanism, double sign) {
  ClosedMechanism::Lead& lead = mechanism.leads.back();
  const std::vector<double> q(mechanism.state.q().begin(), mechanism.state.q().end());
  const bool turns = mechanism.system.joints().layout(lead.joint).coordinate == Coordinate::angle;
  const double start = lead.value, unit = turns ? 1.0 : mechanism.system.size();
  for (const double part : {1.0, 0.1, 0.01}) {
    for (const double turn : {0.0, 0.1, -0.1, 0.3, -0.3}) {
      mechanism.system.coordinates().retract(q, spread_turns(mechanism.system, turn), mechanism.state.q());
      lead.value = start + sign * part * first_drive_step * unit;
      if (mechanism.holds(mechanism.converge()) &&
          largest_move(mechanism.system, q, mechanism.state.q()) <= longest_move) {
        return true;
      }
    }
  }
  std::ranges::copy(q, mechanism.state.q().begin());
  lead.value = start;
  mechanism.position_rows();
  return false;
}

}  // namespace freeplay
