// OpenStudy: a study that is ready to be run or looked at.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "study/folder.h"
#include "study/plan.h"
#include "study/planned_work.h"
#include "study/row_text.h"
#include "study/stop_rule.h"

namespace freeplay {

/// A plan with what runs its points; nothing where they are only to be looked at (StudyPlanOptions::look). Rows of a
/// study that reads its own `mark` fit one table.
class OpenStudy {
 public:
  /// Null after errors in the study, its models or its reducers. Throws as StudyPlan::read() does.
  static std::unique_ptr<OpenStudy> open(const std::string& file, const StudyPlanOptions& options,
                                         Diagnostics& diagnostics);

  const StudyPlan& plan() const { return *plan_; }
  PlannedWork& work() { return *work_; }
  const RowLayout& layout() const { return layout_; }
  MergePlan merge_plan() const { return freeplay::merge_plan(*plan_, columns_); }
  const StudyColumns& columns() const { return columns_; }
  /// Reads the program and its plugins.
  StudyMark mark() const;

  /// The rule for the end of sampling, if there is one, with the column that it looks at.
  std::optional<StopRule> stop_rule() const;
  std::size_t stop_column() const;

 private:
  OpenStudy() = default;

  std::unique_ptr<StudyPlan> plan_;
  std::unique_ptr<PointRunner> runner_;
  StudyColumns columns_;
  std::unique_ptr<PlannedWork> work_;
  RowLayout layout_;
};

}  // namespace freeplay
