// PlayStart: starts of one model that differ by where its loose bodies stand in their play.
#pragma once

#include <cstdint>

#include "assembly/assembly.h"

namespace freeplay {

/// By how much of its clearance a loose body is moved at most.
inline constexpr double moved_in_play = 0.01;
/// By how much of the speed of the mechanism bodies are pushed at most where no joint has play.
inline constexpr double pushed = 1e-3;

/// What is changed of a start: by how much of the play, or of the speed; the other is 0.
struct StartChange {
  double moved = 0.0, pushed = 0.0;
};
StartChange start_change(const Model& model);

/// Whether chance has a part in other starts than the model's own: a joint has play, or something can touch.
bool can_be_repeated(const Model& model);

/// The start of run `number` of a repeated run: 0 is the model's own. In the others every joint with play begins at
///
///   (1 - s) e + s c b,    s = moved_in_play, e: its start in the file, c: its clearance [m]
///
/// with b drawn evenly from the unit disc (in space the unit ball), and the rest of the mechanism follows as in any
/// start. A joint that begins in contact stays in it, at the same distance, and is moved along the surface: e + s c b
/// without the part of b along e, made as long as e. One that would come into contact is moved towards the middle of
/// its play until it does not. The draw depends on `seed`, `number` and the place of the joint in the file alone:
/// Philox with the key (seed, 0x706c6179) and the counter (number, joint, 0, 0).
///
/// In a model without play, in which bodies touch in slots, cams and stops, they are pushed instead: every velocity is
/// changed by up to s V (of a turn s V over the model's size), s = pushed, evenly drawn with the counter (number, index
/// of the velocity, 1, 0), and the least change of kinetic energy then makes joints and drivers hold. V is the speed
/// that all masses would have at the kinetic energy of the start, or that of crossing the model's size within the run,
/// if that is larger [m/s]. Throws Error{numerical} "no-free-start" where joints and drivers leave nothing to push or
/// no play to move in, and what assemble() throws.
Start assemble_in_play(System& system, std::uint64_t seed, std::uint64_t number);
/// The same as assemble_bare() makes it: for one run of many.
Start assemble_bare_in_play(System& system, std::uint64_t seed, std::uint64_t number);

}  // namespace freeplay
