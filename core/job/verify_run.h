// VerifyRun: the runs that `--verify` makes besides the one that is asked for.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "load/load.h"
#include "results/summary.h"
#include "results/verification.h"
#include "run/simulation.h"

namespace freeplay {

/// The run to verify.
struct VerifiedRun {
  std::function<LoadedModel(const BuildOptions&)> read;  ///< the model once more, with other options
  const BuildOptions& build;                             ///< as it was read
  const LoadOptions& load;
  const System& system;
  const Outcome& outcome;
  const Statistics& statistics;
  const ResultTable& rows;  ///< every channel
  /// Asked several times a second: whether to end before the other runs do.
  std::function<bool()> interrupted;
};

/// Runs the model again by an integrator of another kind (implicit where the run was explicit, and the other way round)
/// with error control and steps no longer than the output interval: what one method steps over the other meets. Where
/// the two do not agree a third run, of the second's method, shows why. Empty, with `trouble`, when there is no second
/// run.
std::optional<Verification> verify_run(const VerifiedRun& run, std::string& trouble);

/// Adds what the other runs say to the record of this one, and to its verdict.
void add_verification(const Verification& verification, RunRecord& record);

/// Largest values, means and works of the table that a run prints.
std::vector<Peak> peaks_of(const Model& model, const Statistics& statistics);

}  // namespace freeplay
