#include "study/table_rows.h"

#include <charconv>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"

namespace freeplay {

void split_cells(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == line.npos) return;
    line.remove_prefix(comma + 1);
  }
}

double number_of_cell(std::string_view cell) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return value;
}

TableRows::TableRows(const std::filesystem::path& folder) : file_(folder / "study.csv", std::ios::binary) {
  if (!file_ || !std::getline(file_, line_)) {
    throw Error(Error::Category::input, "file-not-found", fmt::format("'{}' has no table yet", folder.string()), {},
                "freeplay study run or study merge makes it");
  }
  split_cells(line_, cells_);
  for (const std::string_view cell : cells_) columns_.emplace_back(cell);
  after_ = line_.size() + 1;
}

bool TableRows::next() {
  while (std::getline(file_, line_)) {
    place_ = after_;
    after_ += line_.size() + 1;
    split_cells(line_, cells_);
    if (cells_.size() == columns_.size()) return true;
  }
  return false;
}

bool TableRows::read(std::uint64_t place) {
  if (place != after_) {
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(place));
    after_ = place;
  }
  return next();
}

std::uint64_t TableRows::index() const {
  std::uint64_t index = 0;
  std::from_chars(cells_.front().data(), cells_.front().data() + cells_.front().size(), index);
  return index;
}

}  // namespace freeplay
