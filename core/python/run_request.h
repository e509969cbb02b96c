// RunRequest: what a script wants of one run.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "job/resumption.h"
#include "python/opened_model.h"
#include "run/sink.h"

namespace freeplay {

struct RunRequest {
  std::optional<std::filesystem::path> out{};  ///< result directory; without it nothing is written
  bool force = false, profile = false, verify = false, twin = false, report = false;
  std::string call{};                          ///< how the caller asked, for the record of its making
  std::string inputs{};                        ///< a table of them, for run_to_end(); empty: none
  std::string repeat{}, seed{}, checkpoint{};  ///< as on the command line
  bool stepped = false;                        ///< the caller sets efforts and instants; no other can continue it
  const Resumption* resumed = nullptr;         ///< what goes on
  std::optional<std::string> state{};          ///< checkpoint() of a simulation that goes on; none: from the start
  Sink* also = nullptr;                        ///< gets rows, too
};

/// Called at most ten times a second with the time [s] and the steps so far; where it returns false the step in hand is
/// the last.
using RunTick = std::function<bool(double, long)>;

/// What makes the same run on the command line.
KeptWords kept_words(const OpenedModel& opened, const RunRequest& request);

}  // namespace freeplay
