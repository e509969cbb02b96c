// KeptRun: a run that is over, whose rows stay in memory.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "python/kept_rows.h"
#include "python/opened_model.h"
#include "results/hdf5_writer.h"

namespace freeplay {

/// How a run ended, with everything that was kept of it.
struct KeptRun {
  std::shared_ptr<const OpenedModel> model;
  KeptRecord record;
  std::string inputs;  ///< text of inputs.csv; empty without inputs
  InputFile asked;     ///< the table of inputs that makes the run again; without a name where there is none
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

/// Writes a run that was kept as a result directory. Throws Error{file}.
void save_run(const KeptRun& run, const std::filesystem::path& path, bool force, ResultFormat format);

}  // namespace freeplay
