#include <fstream>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/json_text.h"
#include "results/mat_table.h"
#include "results/reader.h"

namespace freeplay {
namespace {

/// A table of rows that was read as a whole.
class TableReader : public ResultReader {
 public:
  /// `numbers`: row after row.
  TableReader(std::string file, std::vector<RecordColumn> columns, std::vector<double> numbers)
      : ResultReader(std::move(file)), numbers_(std::move(numbers)) {
    layout_.columns = std::move(columns);
    const std::size_t width = layout_.columns.size();
    if (width == 0 || layout_.columns.front().name != "time")
      unreadable_result(file_, "its first column is not 'time'");
    for (std::size_t i = width; i < numbers_.size(); i += width) {
      if (!(numbers_[i] > numbers_[i - width])) {
        unreadable_result(file_, fmt::format("row {}: time does not grow", i / width + 1));
      }
    }
  }

  std::unique_ptr<RowSource> open_rows(std::span<const std::size_t> columns) override {
    std::vector<double> picked;
    for (std::size_t row = 0; row < numbers_.size(); row += layout_.columns.size()) {
      for (const std::size_t column : columns) picked.push_back(numbers_[row + column]);
    }
    return std::make_unique<Picked>(std::move(picked));
  }
  void events(const Take&) override { unreadable_result(file_, "it has no events"); }

 private:
  struct Picked : RowSource {
    explicit Picked(std::vector<double> given) : numbers(std::move(given)) {}
    std::span<const double> next() override {
      return std::exchange(given, true) ? std::span<const double>() : std::span<const double>(numbers);
    }
    std::vector<double> numbers;
    bool given = false;
  };

  std::vector<double> numbers_;
};

/// Texts of a list; empty for anything else.
std::vector<std::string> texts(const Json& json, const char* name) {
  std::vector<std::string> all;
  for (const Json& text : json.value(name, Json::array()))
    all.push_back(text.is_string() ? text.get<std::string>() : "");
  return all;
}

std::vector<RecordColumn> columns_of(const std::vector<std::string>& names, const std::vector<std::string>& units) {
  std::vector<RecordColumn> columns;
  for (std::size_t i = 0; i < names.size(); ++i)
    columns.push_back({names[i], i < units.size() ? units[i] : "", "", ""});
  return columns;
}

}  // namespace

std::unique_ptr<ResultReader> open_mat(const std::filesystem::path& path) {
  const MatTable table = read_mat(path);
  const std::size_t rows = table.time.size(), width = table.channels.size();
  if (rows == 0 || table.data.size() != rows * width) unreadable_result(path.string(), "it holds no table of rows");
  std::vector<RecordColumn> columns = columns_of(table.channels, table.units);
  columns.insert(columns.begin(), {"time", "s", "", ""});
  std::vector<double> numbers;
  for (std::size_t row = 0; row < rows; ++row) {
    numbers.push_back(table.time[row]);
    for (std::size_t column = 0; column < width; ++column) numbers.push_back(table.data[column * rows + row]);
  }
  return std::make_unique<TableReader>(path.string(), std::move(columns), std::move(numbers));
}

std::unique_ptr<ResultReader> open_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  const Json json = Json::parse(file, nullptr, false);
  const auto refuse = [&] { unreadable_result(path.string(), "it holds no table of rows"); };
  if (!json.is_object() || !json.contains("columns") || !json.contains("rows")) refuse();
  std::vector<RecordColumn> columns = columns_of(texts(json, "columns"), texts(json, "units"));
  std::vector<double> numbers;
  for (const Json& row : json["rows"]) {
    if (!row.is_array() || row.size() != columns.size()) refuse();
    for (const Json& number : row) {
      if (!number.is_number() && !number.is_null()) refuse();
      numbers.push_back(number.is_null() ? std::numeric_limits<double>::quiet_NaN() : number.get<double>());
    }
  }
  return std::make_unique<TableReader>(path.string(), std::move(columns), std::move(numbers));
}

}  // namespace freeplay
