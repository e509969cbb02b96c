// MappedPoints: many runs of one model that a script asked for.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "python/opened_model.h"
#include "study/plan.h"
#include "study/point_threads.h"
#include "workers/outcome.h"

namespace freeplay {

/// Points and the numbers that are taken of each, checked.
class MappedPoints {
 public:
  struct Column {
    std::string name, unit;
    bool words = false;
  };

  /// Points of `model`, each with a text for every target, or "" where it sets none. `reducers`: a YAML map. Throws
  /// Refusal, Error{usage}.
  MappedPoints(std::shared_ptr<const OpenedModel> model, const std::string& reducers,
               const std::vector<std::string>& targets, const std::vector<std::vector<std::string>>& points);
  /// Those of the section `study` of a file, of which `request` changes the models; its reducers or those of the file.
  MappedPoints(const OpenRequest& request, const std::string& reducers);

  /// Runs all. False where `beat` ended it: what was done is kept.
  bool run(int workers, const std::function<bool(std::size_t)>& beat);

  std::size_t points() const { return cells_.size(); }
  /// After `index`: what a point sets; and what is taken of it.
  const std::vector<Column>& keys() const { return keys_; }
  const std::vector<StudyColumn>& columns() const { return columns_; }
  /// Of a point: as the table shows what it sets, and what it came to.
  const std::vector<std::string>& cells(std::size_t point) const { return cells_[point]; }
  const std::vector<std::optional<StudyOutcome>>& outcomes() const { return outcomes_; }

 private:
  void read_reducers(const std::string& text);
  void check();
  void add_plan();

  std::shared_ptr<const OpenedModel> model_;  // null: of a plan
  LoadOptions options_;
  std::optional<Document> reducers_;
  std::unique_ptr<StudyPlan> plan_;
  PointSource source_;
  std::size_t start_cell_ = 0;  // of chains
  std::vector<Column> keys_;
  std::vector<StudyColumn> columns_;
  std::vector<PointUnit> units_;
  std::vector<std::vector<std::string>> cells_;
  std::vector<std::optional<StudyOutcome>> outcomes_;
};

}  // namespace freeplay
