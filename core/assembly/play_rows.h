// PlayRows: how far rows of joints with play give way where constraints are redundant. A mechanism with more
// constraints than it needs leaves journals fewer places than they have directions: what moves one moves others.
#pragma once

#include <functional>
#include <vector>

#include "assembly/closed_mechanism.h"

namespace freeplay {

/// What holds first where not all rows can.
enum class PlayRank { constraint, given, implied };

/// Whether the block of a joint with play gives the eccentricity or the velocity of its journal, be it zero.
bool gives_eccentricity(const JointElement& joint);
bool gives_velocity(const JointElement& joint);
bool gives_tilt(const JointElement& joint);
/// Whether its block leaves the start to the type by another word than the one that stands for the middle: at rest
/// under its load.
bool starts_by_its_load(const JointElement& joint);
/// Whether its block has the key by which it would, and does not.
bool could_start_by_its_load(const JointElement& joint);
/// Throws `assembly-failed` for a journal that its load presses so deep into its bearing that it stands off by more
/// than twice its clearance: its loop need not close then.
void require_borne_loads(const Model& model, const std::vector<InitialOffset>& offsets);

/// By row of the closed mechanism: rows of joints with play that hold shifts are `given` where gives(joint); those that
/// hold turns alone, as of the tilts of a journal whose block gives none, and all others of these joints are `implied`;
/// the rest are constraints.
std::vector<PlayRank> play_ranks(ClosedMechanism& mechanism, const std::function<bool(const JointElement&)>& gives);

/// Moves the mechanism, which stands with all journals centred, to where constraints hold and journals are as near to
/// their offsets as these allow, in parts of their clearances; those that are `given` first. Offsets that leave the
/// play on this way are shortened, all by the same factor. The rows of joints with play keep what they miss. False
/// where that comes to nothing, as always in large models (most_dense_columns).
bool yield_in_play(ClosedMechanism& mechanism, std::vector<InitialOffset> offsets, const std::vector<PlayRank>& ranks);

}  // namespace freeplay
