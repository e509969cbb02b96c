#include "study/planned_work.h"

#include <utility>

#include <fmt/format.h>

namespace freeplay {

RowLayout row_layout(const StudyPlan& plan, const StudyColumns& columns) {
  RowLayout layout{columns.table, {}, plan.chained()};
  for (const StudyColumn& column : columns.samples) layout.samples.push_back(column.name);
  return layout;
}

MergePlan merge_plan(const StudyPlan& plan, const StudyColumns& columns) {
  MergePlan merge;
  merge.points = plan.points();
  merge.layout = row_layout(plan, columns);
  merge.title = plan.name();
  if (plan.has_model_column()) merge.keys.push_back({"model", "", true});
  for (const AxisColumn& column : plan.axis_columns()) merge.keys.push_back({column.name, column.unit, column.words});
  if (plan.has_direction_column()) merge.keys.push_back({"direction", "", true});
  if (plan.has_sample_column()) merge.keys.push_back({"sample", "1", false});
  if (plan.chained()) {
    merge.start_cell = merge.keys.size();
    merge.keys.push_back({"start", "", true});
  }
  merge.cells = [&plan](std::uint64_t index, std::vector<std::string>& cells) {
    StudyPoint point = plan.point(index);
    if (plan.has_model_column()) cells.push_back(plan.models()[point.model].name);
    for (std::string& cell : point.cells) cells.push_back(std::move(cell));
    if (plan.has_direction_column()) cells.push_back(std::move(point.direction));
    if (plan.has_sample_column()) cells.push_back(fmt::format("{}", point.sample));
    if (plan.chained()) cells.emplace_back();
  };
  return merge;
}

}  // namespace freeplay
