// Structure: what the joints of an assembled model leave free, hold twice, or hold past each other.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "assembly/dead_point.h"
#include "assembly/unstable_start.h"
#include "system/system.h"

namespace freeplay {

/// Something that is likely wrong, though the model can be run; a warning of section 17 of the model format.
struct StructureDoubt {
  std::string id, message;
  Location location;
  int length = 1;  ///< of what stands there [characters]
};

/// Ranks are those of constraint rows at the start. Beyond most_examined velocities only what needs no rank of the
/// whole model is looked at.
struct Structure {
  static constexpr int most_examined = 300;

  std::vector<std::string> undetermined;  ///< joints whose forces redundant rows leave open
  std::vector<std::string> left_free;     ///< bodies that move when all drivers of the ideal mechanism stand still
  int free_motions = 0;                   ///< of those, without spins of single bodies about their centres of mass
  std::vector<StructureDoubt> doubts;     ///< at most most_doubts of them

  static constexpr std::size_t most_doubts = 20;
};

/// Both systems stand at the start: `released` as it runs, `closed` with every clearance closed; their evaluations hold
/// positions and coordinates, `start` the state of the released one. `dead`: a driver that starts at a dead point,
/// where ranks say little of what is free. Doubts: `locked`, `not-connected`, `duplicate-joint`, `play-bypassed`,
/// `left-free`, `dead-point`, `unstable-start`, and those of doubt_forces().
Structure examine_structure(const System& released, const Evaluation& at_start, const State& start,
                            const System& closed, const Evaluation& closed_at_start,
                            const std::optional<DeadStart>& dead, const std::optional<UnstableStart>& unstable);

}  // namespace freeplay
