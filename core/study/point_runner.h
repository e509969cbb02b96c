// PointRunner: runs single points of a study.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "format/build_options.h"
#include "format/document.h"
#include "load/options.h"
#include "study/point.h"
#include "workers/outcome.h"

namespace freeplay {

/// What all points of a study have in common. Documents and nodes outlive the runner.
struct PointSource {
  std::vector<const Document*> models;
  std::vector<StudySetting> set{};
  const Node* reducers = nullptr;  ///< a map; null: there are none
  const Node* analysis = nullptr;  ///< the map of `do`; null: points are runs
  bool chained = false;            ///< with `warm_start`
  BuildOptions build{};            ///< of every point, besides what it sets
};

/// Made before workers are forked: loads the plugins of every model, and checks `set`, `do` and reducers against every
/// model. A point builds its model, system and start anew from the parsed document. One thread at a time.
class PointRunner {
 public:
  /// Where `diagnostics` has errors afterwards no point may run. Throws Error{usage} for `set`, and what loading
  /// plugins throws.
  PointRunner(PointSource source, const LoadOptions& options, Diagnostics& diagnostics);
  ~PointRunner();
  PointRunner(PointRunner&&) noexcept;

  /// Of the table, in the order of the reducers; those of a set have a column for each joint and quantity.
  const std::vector<StudyColumn>& columns() const;
  /// Files of the plugins that models are made with, sorted, each once.
  std::vector<std::string> plugin_files() const;
  /// Of the reducers that give many values, whose number stands in the column of the same name.
  const std::vector<StudyColumn>& sample_columns() const;

  /// Throws Error{usage} where the point sets what its model does not have.
  void try_settings(const StudyPoint& point) const;
  /// Throws nothing for what is wrong at the point. `state_before`: the state after the point before it in its chain,
  /// empty at the beginning of one and after a failed point.
  /// `interrupt`: where it is not zero the step in hand is the last; the exit code is then 130.
  StudyOutcome run(const StudyPoint& point, const std::string& state_before,
                   const std::atomic<int>* interrupt = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace freeplay
