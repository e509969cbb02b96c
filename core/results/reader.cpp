#include "results/reader.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "model/channel.h"
#include "results/schema.h"

namespace freeplay {

namespace fs = std::filesystem;

void unreadable_result(const std::string& file, const std::string& why, int line, const std::string& hint) {
  throw Error(Error::Category::file, "unreadable-result", fmt::format("result '{}' cannot be read: {}", file, why),
              {file, line, line > 0 ? 1 : 0}, hint);
}

std::size_t ResultReader::find(std::string_view name) const {
  return static_cast<std::size_t>(std::ranges::find(layout_.columns, name, &RecordColumn::name) -
                                  layout_.columns.begin());
}

void ResultReader::know_units(const Model& model) {
  const Channels channels(model);
  for (RecordColumn& column : layout_.columns) {
    const int index = column.unit.empty() ? channels.find(column.name) : -1;
    if (index >= 0) column.unit = channels.all()[static_cast<std::size_t>(index)].unit;
  }
}

fs::path whole_result(const fs::path& path) {
  std::error_code ignored;
  const fs::path real = fs::weakly_canonical(path, ignored), name = real.filename();
  const bool part = (name == "results.csv" || name == "results.h5") && !fs::is_directory(real, ignored);
  return part ? real.parent_path() : name.empty() ? real.parent_path() : real;
}

namespace {

constexpr std::size_t first_column[] = {0};

/// By its first bytes, whatever its name; by its name where these are damaged.
bool is_hdf5(const fs::path& path) {
  constexpr std::string_view mark = "\x89HDF\r\n\x1a\n";
  constexpr const char* endings[] = {".h5", ".hdf5", ".hdf", ".nc"};
  std::string head(mark.size(), '\0');
  std::ifstream(path, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  return head == mark || std::ranges::find(endings, path.extension()) != std::end(endings);
}

/// The record in the file says of which schema it is, whatever stands beside it.
std::unique_ptr<ResultReader> open_known_hdf5(const fs::path& path) {
  auto reader = open_hdf5(path);
  for (const auto& [name, text] : reader->layout().attributes) {
    const Json record = name == "provenance" ? Json::parse(text, nullptr, false) : Json();
    if (record.is_object() && record.contains("schema"))
      require_known_schema(reader->file(), record["schema"], record.value("freeplay", Json()));
  }
  return reader;
}

}  // namespace

std::unique_ptr<ResultReader> ResultReader::open(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) unreadable_result(path.string(), "there is no such file or directory");
  if (!fs::is_directory(path, ignored)) {
    const fs::path ending = path.extension();
    return is_hdf5(path)       ? open_known_hdf5(path)
           : ending == ".mat"  ? open_mat(path)
           : ending == ".json" ? open_json(path)
                               : open_csv(path);
  }
  const bool text = fs::exists(path / "results.csv", ignored);
  std::string passed_over;
  if (fs::exists(path / "results.h5", ignored)) {
    try {
      auto reader = open_known_hdf5(path / "results.h5");
      // Of a run that was killed early the text may hold rows when the other file has none yet.
      if (!text || reader->sealed() || !reader->open_rows(first_column)->next().empty()) return reader;
    } catch (const Error& error) {
      if (!text) throw;
      passed_over = error.message();
    }
  }
  if (!text) unreadable_result(path.string(), "it holds neither results.h5 nor results.csv");
  auto reader = open_csv(path / "results.csv");
  reader->passed_over_ = passed_over;
  return reader;
}

void ResultReader::rows(std::span<const std::size_t> columns, const RowWindow& window, const Take& take) {
  RowPicker picker(window, columns.size(), take);
  const std::unique_ptr<RowSource> source = open_rows(columns);
  while (!picker.over()) {
    const std::span<const double> block = source->next();
    if (block.empty()) break;
    picker.add(block);
  }
  picker.finish();
}

bool RowPicker::inside(double time) const { return time >= window_.from - same_ && time <= window_.until + same_; }

void RowPicker::add(std::span<const double> rows) {
  picked_.clear();
  const auto look_at = [&](std::span<const double> row) {
    if (!inside(row[0])) {
      over_ = over_ || row[0] > window_.until + same_;
      return;
    }
    if (met_++ % window_.every == 0) picked_.insert(picked_.end(), row.begin(), row.end());
  };
  for (; !rows.empty(); rows = rows.subspan(width_)) {
    const auto row = rows.first(width_);
    if (++seen_ == 1) {
      held_.assign(row.begin(), row.end());
      continue;
    }
    if (seen_ == 2) {
      same_ = 1e-9 * (row[0] - held_[0]);
      look_at(held_);
    }
    look_at(row);
  }
  if (!picked_.empty()) take_(picked_);
}

void RowPicker::finish() {
  if (seen_ == 1 && inside(held_[0])) take_(held_);
}

}  // namespace freeplay
