#include "results/table.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <limits>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"

namespace freeplay {
namespace {

[[noreturn]] void unreadable(const std::string& file, const std::string& why, int line = 0,
                             const std::string& hint = {}) {
  throw Error(Error::Category::file, "unreadable-result", fmt::format("result '{}' cannot be read: {}", file, why),
              {file, line, line > 0 ? 1 : 0}, hint);
}

std::string read_text(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) unreadable(file, "it cannot be opened");
  return text;
}

std::string_view next_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

template <class Take>
void for_each_field(std::string_view line, Take&& take) {
  for (;;) {
    const std::size_t comma = line.find(',');
    take(line.substr(0, comma));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

double number(std::string_view field, const std::string& file, int line) {
  if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size()) {
    unreadable(file, fmt::format("line {}: '{}' is not a number", line, field.substr(0, 40)), line);
  }
  return value;
}

}  // namespace

int ResultTable::find(std::string_view name) const {
  const auto hit = std::ranges::find(names, name);
  return hit == names.end() ? -1 : static_cast<int>(hit - names.begin());
}

ResultTable read_result(const std::filesystem::path& path) {
  std::error_code ignored;
  const bool folder = std::filesystem::is_directory(path, ignored);
  ResultTable table;
  table.file = (folder ? path / "results.csv" : path).string();
  if (!std::filesystem::exists(table.file, ignored)) {
    unreadable(path.string(), folder ? "it holds no results.csv" : "there is no such file or directory");
  }
  if (path.extension() == ".h5") unreadable(path.string(), "HDF5 is not in this release", 0, "give the CSV file");
  const std::string text = read_text(table.file);
  std::string_view rest = text;
  for_each_field(next_line(rest), [&](std::string_view name) { table.names.emplace_back(name); });
  if (table.names.front() != "time") unreadable(table.file, "its first column is not 'time'", 1);
  table.values.resize(table.names.size());
  for (int line = 2; !rest.empty(); ++line) {
    std::size_t column = 0;
    for_each_field(next_line(rest), [&](std::string_view field) {
      const double value = number(field, table.file, line);
      if (column < table.values.size()) table.values[column].push_back(value);
      ++column;
    });
    if (column != table.names.size()) {
      unreadable(table.file, fmt::format("line {} has {} fields, the header {}", line, column, table.names.size()),
                 line);
    }
    const std::vector<double>& time = table.time();
    if (!(time.size() == 1 || time.back() > time[time.size() - 2])) {
      unreadable(table.file, fmt::format("line {}: time does not grow", line), line);
    }
  }
  return table;
}

}  // namespace freeplay
