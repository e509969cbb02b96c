// Checkpoint: from where a run that was killed or interrupted goes on: checkpoint.bin of a result directory.
//
//   offset  what
//   0       "FPCHECK\n"
//   8       version of this form, 1
//   16      bytes in all
//   24      length of the text, then the text, filled with blanks to a multiple of 8
//           events, length of the state, then the state as in run/state_bytes.h (0: before the first step)
//           two lists, each its length and its numbers: reals and integers of Checkpoint::files
//   at the end, 64 bytes: SHA-256 of all bytes before, as hexadecimal digits
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/archive.h"
#include "base/json_text.h"
#include "run/saved_state.h"

namespace freeplay {

/// A run at the end of an accepted step, and how far its files go there.
struct Checkpoint {
  Json made;                        ///< what the run was made from and with (Recording::provenance)
  std::optional<RunState> state{};  ///< none: the run had not begun
  std::int64_t events = 0;          ///< rows of events.csv
  Archive files{};                  ///< what waits to be written, and what is counted besides (Recording::save)

  std::int64_t rows() const { return state ? state->rows : 0; }
};

std::string bytes_of(const Checkpoint& checkpoint);

/// Throws Error{file} "bad-checkpoint" where the bytes are no checkpoint of this form, or damaged. `file` is for the
/// message.
Checkpoint checkpoint_of(std::string_view bytes, const std::string& file);

/// Of a result directory. Throws Error{file} "unreadable-result" where there is none, "no-checkpoint",
/// "bad-checkpoint".
Checkpoint read_checkpoint(const std::filesystem::path& directory);

inline constexpr const char* checkpoint_name = "checkpoint.bin";

}  // namespace freeplay
