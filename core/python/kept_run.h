// KeptRun: a run whose rows stay in memory, with files or without.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "python/kept_rows.h"
#include "python/opened_model.h"
#include "results/hdf5_writer.h"

namespace freeplay {

struct RunRequest {
  std::optional<std::filesystem::path> out;  ///< result directory; without it nothing is written
  bool force = false, profile = false;
  std::string call;  ///< how the caller asked, for the record of its making
};

/// How a run ended, with everything that was kept of it.
struct KeptRun {
  std::shared_ptr<const OpenedModel> model;
  std::unique_ptr<const KeptRows> rows;
  BearingTables bearings;
  Json summary;
  std::string status, reason;
  int exit_code = 0;
  std::vector<std::string> warnings;
  struct PhaseTime {
    std::string phase;
    double seconds;
    long count;
  };
  std::vector<PhaseTime> profile;
};

/// Runs to the end. `tick` is called at most ten times a second with the time [s] and the steps so far; where it
/// returns false the step in hand is the last. Throws Refusal and Error for what keeps the run from beginning.
std::shared_ptr<KeptRun> run_model(const std::shared_ptr<const OpenedModel>& model, const RunRequest& request,
                                   const std::function<bool(double, long)>& tick);

/// Writes a run that was kept as a result directory. Throws Error{file}.
void save_run(const KeptRun& run, const std::filesystem::path& path, bool force, ResultFormat format);

}  // namespace freeplay
