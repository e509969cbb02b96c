// StateBytes: a saved state of a run as bytes, for files.
//
// All numbers are 8 bytes, little endian; integers two's complement, reals IEEE 754 with all bits.
//
//   offset  what
//   0       "FPSTATE\n"
//   8       version of this form, 1
//   16      bytes in all
//   24      time [s], steps, rows (RunState)
//   48      four lists, each its length and its numbers: reals and integers of RunState::features, then of
//           RunState::numbers
//   at the end, 64 bytes: SHA-256 of all bytes before, as hexadecimal digits
//
// The order of the numbers themselves is that of the program that wrote them: a version of Freeplay reads its own.
#pragma once

#include <string>
#include <string_view>

#include "run/saved_state.h"

namespace freeplay {

[[gnu::cold]] std::string bytes_of(const RunState& state);

/// Throws Error{input}: "state-format" where the bytes are no saved state, or one of another version of this form;
/// "state-damaged" where some are missing, more than there should be, or changed.
[[gnu::cold]] RunState state_of(std::string_view bytes);

}  // namespace freeplay
