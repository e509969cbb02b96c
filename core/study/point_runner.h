// PointRunner: runs single points of a study.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "load/options.h"
#include "study/outcome.h"
#include "study/plan.h"
#include "study/point.h"

namespace freeplay {

/// Of which points whole result directories are written.
enum class KeepResults { none, failed, all };

struct PointRunnerOptions {
  LoadOptions load{};  ///< `warn` and `note` are not called while points run
  KeepResults keep = KeepResults::none;
  std::filesystem::path folder{};  ///< that results are kept in: `folder`/NNNN/INDEX
  std::string build{};             ///< of the program, for the records of kept results
};

/// Made before workers are forked: loads the plugins of every model and checks `set`, `do` and reducers against every
/// model. A point builds its model, system and start anew from the parsed document. One thread at a time.
class PointRunner {
 public:
  /// `plan` outlives it. Where `diagnostics` has errors afterwards no point may run. Throws what loading plugins
  /// throws.
  PointRunner(const StudyPlan& plan, PointRunnerOptions options, Diagnostics& diagnostics);
  ~PointRunner();
  PointRunner(PointRunner&&) noexcept;

  /// Of the table, in the order of the reducers; those of a set have a column for each joint and quantity.
  const std::vector<StudyColumn>& columns() const;
  /// Of the reducers that give many values, whose number stands in the column of the same name.
  const std::vector<StudyColumn>& sample_columns() const;

  /// Throws nothing for what is wrong at the point. `state_before`: the state after the point before it in its chain,
  /// empty at the beginning of one and after a failed point.
  StudyOutcome run(const StudyPoint& point, const std::string& state_before);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace freeplay
