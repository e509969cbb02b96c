#include "study/row_outcome.h"

#include <string_view>

#include "study/fields.h"

namespace freeplay {
StudyOutcome outcome_of(const SegmentRow& row, const RowLayout& layout) {
  StudyOutcome outcome;
  outcome.exit_code = row.exit_code;
  outcome.error = row.error;
  outcome.message = row.message;
  outcome.wall = number_in(row.wall);
  outcome.cpu = number_in(row.cpu);
  outcome.run = number_in(row.run);
  outcome.start = row.start;
  outcome.state = row.state;
  std::string_view rest = row.values;
  for (std::size_t i = 0; i < layout.columns.size(); ++i) outcome.values.push_back(number_in(cut_field(rest, '\t')));
  for (std::string_view list : row.samples) {
    auto& samples = outcome.samples.emplace_back();
    while (!list.empty()) {
      std::string_view value = cut_field(list, '\t');
      const double time = number_in(cut_field(value, ':'));
      samples.emplace_back(time, number_in(value));
    }
  }
  outcome.samples.resize(layout.samples.size());
  return outcome;
}

}  // namespace freeplay
