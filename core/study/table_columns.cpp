#include "study/table_columns.h"

#include <algorithm>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"
#include "base/suggestion.h"
#include "study/table_rows.h"

namespace freeplay {
TableColumns::TableColumns(const std::filesystem::path& file, std::span<const std::string> names)
    : names_(names.begin(), names.end()), cells_(names.size()) {
  std::ifstream stream(file);
  std::string line;
  if (!stream || !std::getline(stream, line)) {
    throw Error(Error::Category::input, "file-not-found", fmt::format("there is no table '{}'", file.string()), {},
                "freeplay study run or study merge makes it");
  }
  std::vector<std::string> header;
  std::vector<std::string_view> cells;
  split_cells(line, cells);
  for (const std::string_view cell : cells) header.emplace_back(cell);
  std::vector<std::size_t> places;
  for (const std::string& name : names_) {
    const auto found = std::ranges::find(header, name);
    if (found == header.end()) {
      const auto nearest = suggestion(name, header);
      throw Error(Error::Category::input, "unknown-name",
                  fmt::format("the table '{}' has no column '{}'", file.string(), name), {},
                  nearest ? fmt::format("did you mean '{}'?", *nearest) : "");
    }
    places.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  while (std::getline(stream, line)) {
    split_cells(line, cells);
    if (cells.size() != header.size()) continue;
    for (std::size_t i = 0; i < places.size(); ++i) cells_[i].emplace_back(cells[places[i]]);
    ++rows_;
  }
}

const std::vector<std::string>& TableColumns::words(const std::string& name) const {
  return cells_[static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin())];
}

std::vector<double> TableColumns::numbers(const std::string& name) const {
  std::vector<double> numbers;
  numbers.reserve(rows_);
  for (const std::string& text : words(name)) numbers.push_back(number_of_cell(text));
  return numbers;
}

}  // namespace freeplay
