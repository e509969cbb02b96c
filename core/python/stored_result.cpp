#include "python/stored_result.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "results/channel_choice.h"
#include "results/provenance.h"
#include "results/reader.h"
#include "results/result_copy.h"
#include "results/result_record.h"
#include "results/whole_result.h"

namespace freeplay {
namespace {

/// Those asked for in the order of the file, time first.
std::vector<std::size_t> columns_of(const ResultReader& reader, const std::vector<std::string>& patterns) {
  std::vector<std::size_t> columns = chosen_channels(reader, patterns);
  std::ranges::sort(columns);
  if (columns.empty() || columns.front() != 0) columns.insert(columns.begin(), 0);
  return columns;
}

void append_block(std::vector<double>& to, std::span<const double> numbers) {
  to.insert(to.end(), numbers.begin(), numbers.end());
}

}  // namespace

StoredResult read_result(const std::filesystem::path& path, const std::vector<std::string>& patterns) {
  const std::unique_ptr<ResultReader> reader = ResultReader::open(path);
  const std::vector<std::size_t> columns = columns_of(*reader, patterns);
  StoredResult result;
  std::vector<double> rows;
  reader->rows(columns, {}, [&](std::span<const double> numbers) { append_block(rows, numbers); });
  const std::size_t width = columns.size();
  result.block = std::make_unique<ColumnBlock>(width, rows.size() / width);
  for (std::size_t at = 0; at < rows.size(); at += width) {
    result.block->add(std::span<const double>(rows).subspan(at, width));
  }
  const std::filesystem::path whole = whole_result(path);
  std::error_code ignored;
  const bool in_directory = std::filesystem::is_directory(whole, ignored);
  if (in_directory || !reader->layout().events.empty()) {  // a table of rows may stand alone
    reader->events([&](std::span<const double> numbers) { append_block(result.events, numbers); });
  }
  result.file = reader->file();
  result.whole = columns.size() == reader->layout().columns.size();
  result.layout = reader->layout();
  result.layout.columns.clear();
  for (const std::size_t column : columns) result.layout.columns.push_back(reader->layout().columns[column]);
  if (in_directory) {
    result.directory = whole.string();
    result.summary = read_summary(whole);
  } else if (const std::string text = reader->summary(); !text.empty()) {
    result.summary = Json::parse(text, nullptr, false);
  }
  return result;
}

void save_stored(const StoredResult& result, const std::filesystem::path& path, bool force,
                 std::optional<ResultFormat> format) {
  const auto refuse = [&](const char* why) {
    throw Error(Error::Category::usage, "usage", fmt::format("save(): '{}' {}", result.file, why));
  };
  if (result.directory.empty()) refuse("stands alone: a result directory has the model and the summary, too");
  if (!result.summary.is_object()) refuse("is of a run that has not ended: `freeplay seal` ends its files");
  if (!result.whole) refuse("was opened with some of its channels: open it with all");
  copy_result(result.directory, result.summary, path, force, format);
}

Comparison compare_results(const std::filesystem::path& a, const std::filesystem::path& b, const ComparisonRules& rules,
                           std::vector<std::string>& notes) {
  const auto first = ResultReader::open(a), second = ResultReader::open(b);
  for (ResultReader* const reader : {first.get(), second.get()}) {
    if (std::string missing = missing_part(*reader); !missing.empty()) notes.push_back(std::move(missing));
  }
  Comparison comparison = compare(*first, *second, rules);
  notes.insert(notes.end(), comparison.missing.begin(), comparison.missing.end());
  if (comparison.interpolated) {
    notes.push_back(fmt::format("times differ: {} is interpolated linearly", second->file()));
  }
  return comparison;
}

}  // namespace freeplay
