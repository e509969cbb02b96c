#include "results/table.h"

#include <algorithm>

#include "base/name_pattern.h"
#include "results/reader.h"

namespace freeplay {

int ResultTable::find(std::string_view name) const {
  const auto hit = std::ranges::find(names, name);
  return hit == names.end() ? -1 : static_cast<int>(hit - names.begin());
}

ResultTable read_result(const std::filesystem::path& path, std::span<const std::string> patterns) {
  const std::unique_ptr<ResultReader> reader = ResultReader::open(path);
  ResultTable table{.file = reader->file(), .names = {}, .values = {}};
  std::vector<std::size_t> columns;
  const std::vector<RecordColumn>& all = reader->layout().columns;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto fits = [&](const std::string& pattern) { return matches(pattern, all[i].name); };
    if (i > 0 && std::ranges::none_of(patterns, fits)) continue;
    columns.push_back(i);
    table.names.push_back(all[i].name);
  }
  table.values.resize(columns.size());
  reader->rows(columns, {}, [&](std::span<const double> rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) table.values[i % columns.size()].push_back(rows[i]);
  });
  return table;
}

}  // namespace freeplay
