#include "analysis/table.h"

#include <cmath>
#include <utility>

#include "base/number_text.h"

namespace freeplay {

void AnalysisTable::add_column(std::string name, std::string unit) {
  columns.push_back(std::move(name));
  units.push_back(std::move(unit));
}

std::string AnalysisTable::csv(const std::function<void()>& beat) const {
  std::string text;
  for (std::size_t c = 0; c < columns.size(); ++c) text += (c > 0 ? "," : "") + columns[c];
  text += '\n';
  for (const std::vector<AnalysisCell>& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c > 0) text += ',';
      if (const double* number = std::get_if<double>(&row[c])) {
        if (std::isfinite(*number)) append_number(text, *number);
      } else {
        text += std::get<std::string>(row[c]);
      }
    }
    text += '\n';
    if (beat) beat();
  }
  return text;
}

Json AnalysisTable::json(const std::string& kind) const {
  Json list = Json::array();
  for (const std::vector<AnalysisCell>& row : rows) {
    Json cells = Json::array();
    for (const AnalysisCell& cell : row) {
      const double* number = std::get_if<double>(&cell);
      cells.push_back(number != nullptr ? json_number(*number) : Json(std::get<std::string>(cell)));
    }
    list.push_back(std::move(cells));
  }
  return {{"kind", kind}, {"columns", columns}, {"rows", std::move(list)}, {"summary", summary}};
}

}  // namespace freeplay
