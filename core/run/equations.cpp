#include "run/equations.h"

namespace freeplay {
namespace {

// Multipliers that are not determined come out with efforts of drivers as small as can be: these must be among the
// unknowns.
Unknowns unknowns_of(const ModelFacts& facts) {
  const bool determined = facts.actual.redundant == 0 && facts.actual.driver_redundant == 0;
  return determined ? Unknowns::free_bodies : Unknowns::all_bodies;
}

}  // namespace

RunEquations::RunEquations(const System& whole, const Start& start)
    : whole_(whole),
      start_(start),
      system_(whole.model(), Variant::released, unknowns_of(start.facts)),
      first_state_(system_.layout(), 0) {
  system_.begin_at(whole, start.state, first_state_);
}

}  // namespace freeplay
