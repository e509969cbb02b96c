// PlayStart: starts of one model that differ by where its loose bodies stand in their play.
#pragma once

#include <cstdint>

#include "assembly/assembly.h"

namespace freeplay {

/// By how much of its clearance a loose body is moved at most.
inline constexpr double moved_in_play = 0.01;

/// The start of run `number` of a repeated run: 0 is the model's own. In the others every joint with play begins at
///
///   (1 - s) e + s c b,    s = moved_in_play, e: its start in the file, c: its clearance [m]
///
/// with b drawn evenly from the unit disc (in space the unit ball), and the rest of the mechanism follows as in any
/// start. A joint that begins in contact stays in it, at the same distance, and is moved along the surface: e + s c b
/// without the part of b along e, made as long as e. One that would come into contact is moved towards the middle of
/// its play until it does not. The draw depends on `seed`, `number` and the place of the joint in the file alone:
/// Philox with the key (seed, 0x706c6179) and the counter (number, joint, 0, 0).
/// Throws Error{numerical} "no-free-start" where that fails, and what assemble() throws.
Start assemble_in_play(System& system, std::uint64_t seed, std::uint64_t number);
/// The same as assemble_bare() makes it: for one run of many.
Start assemble_bare_in_play(System& system, std::uint64_t seed, std::uint64_t number);

}  // namespace freeplay
