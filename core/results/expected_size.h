// ExpectedSize: how much a run will write, and whether there is room.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "model/channel.h"
#include "model/model.h"

namespace freeplay {

/// Rows and what stands for each run; events come on top.
struct ExpectedSize {
  double rows = 0.0, columns = 0.0;
  double bytes = 0.0;  ///< of results.csv and results.h5, as far as the format has them
};

/// Of what is to be written besides the `rows_there` first rows.
ExpectedSize expected_size(const Model& model, const Channels& channels, std::int64_t rows_there);

/// Bytes that a result may take that goes to `directory`, where there may be none yet: what is free, and, where it
/// `replaces` one there, what that gives back. Nothing where the system does not tell.
std::optional<double> room_for_result(const std::filesystem::path& directory, bool replaces);

/// "12 GB"
std::string bytes_text(double bytes);

inline constexpr double worth_a_note = 1e9;   ///< bytes, from which on a run says beforehand how much it will write
inline constexpr double share_of_room = 0.5;  ///< of the room, beyond which it asks first

}  // namespace freeplay
