#include "study/row_outcome.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>

namespace freeplay {
namespace {

double number_in(std::string_view text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

std::string_view cut_field(std::string_view& rest, char separator) {
  const std::size_t end = std::min(rest.find(separator), rest.size());
  const std::string_view field = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return field;
}

}  // namespace

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
