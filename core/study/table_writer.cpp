#include "study/table_writer.h"

#include <algorithm>
#include <limits>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/growing_file.h"
#include "base/json_text.h"
#include "base/staged_file.h"
#include "results/column_file.h"
#include "study/fields.h"

namespace freeplay {
namespace {

using Kind = ColumnFile::Kind;
constexpr std::uint64_t any_number_of_samples = std::uint64_t{1} << 62;

/// A field of a table without quotes.
void append_cell(std::string& line, std::string_view cell) {
  for (const char c : cell) line += c == ',' ? ';' : c == '"' || c == '\n' || c == '\r' ? ' ' : c;
  line += ',';
}

/// Of the column of reasons; a reducer may be called `error`, too.
std::string error_name(const MergePlan& plan) {
  const bool taken = std::ranges::find(plan.layout.columns, "error", &StudyColumn::name) != plan.layout.columns.end();
  return taken ? "error_of_point" : "error";
}

}  // namespace

struct TableWriter::Files {
  Files(const std::filesystem::path& folder, const MergePlan& plan);

  StagedFile table_place, samples_place, failures_place, timing_place, columns_place;
  GrowingFile table, samples, failures, timing;
  ColumnFile columns;
  std::size_t point = 0, value = 0;                 // dimensions
  std::size_t index = 0, exit_code = 0, error = 0;  // columns of points
  std::vector<std::size_t> keys, values;
  std::size_t row_size = 0, reducer = 0, time = 0, sample = 0;  // where there are reducers with many values

 private:
  void declare(const MergePlan& plan);
};

TableWriter::Files::Files(const std::filesystem::path& folder, const MergePlan& plan)
    : table_place(folder / "study.csv", true),
      samples_place(folder / "samples.csv", true),
      failures_place(folder / "failures.jsonl", true),
      timing_place(folder / "timing.csv", true),
      columns_place(folder / "study.h5", true),
      table(table_place.temporary()),
      samples(samples_place.temporary()),
      failures(failures_place.temporary()),
      timing(timing_place.temporary()),
      columns(columns_place.temporary(), {{"title", plan.title}, {"Conventions", "CF-1.8"}}) {
  table.line() += "index,";
  for (const KeyColumn& key : plan.keys) append_cell(table.line(), key.name);
  for (const StudyColumn& column : plan.layout.columns) append_cell(table.line(), column.name);
  table.line() += "exit_code," + error_name(plan);
  table.end_line();
  samples.line() += "index,reducer,k,time,value";
  samples.end_line();
  timing.line() += "index,host,wall_seconds,cpu_seconds,run_seconds";
  timing.end_line();
  declare(plan);
}

void TableWriter::Files::declare(const MergePlan& plan) {
  point = columns.add_dimension("point", plan.points);
  index = columns.add_column(point, {"index", "1", "number of the point", "the study"}, Kind::whole);
  for (const KeyColumn& key : plan.keys) {
    keys.push_back(columns.add_column(point, {key.name, key.words ? "" : key.unit, "", "the study"},
                                      key.words ? Kind::words : Kind::number));
  }
  for (const StudyColumn& column : plan.layout.columns) {
    values.push_back(columns.add_column(point, {column.name, column.unit, "", "a reducer"}, Kind::number));
  }
  exit_code = columns.add_column(point, {"exit_code", "1", "how the point ended", "the study"}, Kind::whole);
  error = columns.add_column(point, {error_name(plan), "", "why the point failed", "the study"}, Kind::words);
  if (plan.layout.samples.empty()) return;
  row_size = columns.add_column(point, {"row_size", "1", "values of the point", "the study"}, Kind::whole, "value");
  value = columns.add_dimension("value", any_number_of_samples);
  reducer = columns.add_column(value, {"sample_reducer", "", "reducer of the value", "the study"}, Kind::words);
  time = columns.add_column(value, {"sample_time", "s", "time of the value", "the study"}, Kind::number);
  sample = columns.add_column(value, {"sample_value", "", "value", "a reducer"}, Kind::number);
}

TableWriter::TableWriter(const std::filesystem::path& folder, const MergePlan& plan)
    : plan_(plan), folder_(folder), files_(std::make_unique<Files>(folder, plan)) {}

TableWriter::~TableWriter() = default;

void TableWriter::put(const SortedRow& row, const std::string& host) {
  cells_.clear();
  plan_.cells(row.index, cells_);
  std::string& line = files_->table.line();
  line += fmt::format("{},", row.index);
  if (plan_.start_cell) cells_[*plan_.start_cell] = row.start;
  for (const std::string& cell : cells_) append_cell(line, cell);
  std::string_view rest = row.values;
  for (std::size_t i = 0; i < plan_.layout.columns.size(); ++i) append_cell(line, cut_field(rest, '\t'));
  line += fmt::format("{},", row.exit_code);
  append_cell(line, row.error);
  line.pop_back();
  files_->table.end_line();
  files_->timing.line() += fmt::format("{},{},{},{},{}", row.index, host, row.wall, row.cpu, row.run);
  files_->timing.end_line();
  if (!row.good()) {
    const Json failure{
        {"index", row.index}, {"exit_code", row.exit_code}, {"error", row.error}, {"message", row.message}};
    files_->failures.line() += failure.dump(-1, ' ', false, Json::error_handler_t::replace);
    files_->failures.end_line();
  }
  put_columns(row);
  if (!plan_.layout.samples.empty()) put_samples(row);
  files_->columns.end_row(files_->point);
}

void TableWriter::put_columns(const SortedRow& row) {
  ColumnFile& columns = files_->columns;
  columns.put_whole(files_->index, static_cast<std::int64_t>(row.index));
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (plan_.keys[i].words) {
      columns.put_word(files_->keys[i], cells_[i]);
    } else {
      columns.put(files_->keys[i], number_in(cells_[i]));
    }
  }
  std::string_view rest = row.values;
  for (const std::size_t column : files_->values) columns.put(column, number_in(cut_field(rest, '\t')));
  columns.put_whole(files_->exit_code, row.exit_code);
  columns.put_word(files_->error, row.error);
}

void TableWriter::put_samples(const SortedRow& row) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < row.samples.size(); ++i) {
    std::string_view rest = row.samples[i];
    for (std::int64_t k = 0; !rest.empty(); ++k, ++count) {
      std::string_view value = cut_field(rest, '\t');
      const std::string_view time = cut_field(value, ':');
      files_->samples.line() += fmt::format("{},{},{},{},{}", row.index, plan_.layout.samples[i], k, time, value);
      files_->samples.end_line();
      files_->columns.put_word(files_->reducer, plan_.layout.samples[i]);
      files_->columns.put(files_->time, number_in(time));
      files_->columns.put(files_->sample, number_in(value));
      files_->columns.end_row(files_->value);
    }
  }
  files_->columns.put_whole(files_->row_size, count);
}

/// The table comes last: where it is, the others are.
void TableWriter::close() {
  files_->columns.close();
  for (GrowingFile* file : {&files_->samples, &files_->failures, &files_->timing, &files_->table}) file->close();
  std::error_code ignored;
  std::filesystem::remove(folder_ / "study.csv", ignored);
  if (plan_.layout.samples.empty()) {
    std::filesystem::remove(folder_ / "samples.csv", ignored);
  } else {
    files_->samples_place.commit();
  }
  files_->failures_place.commit();
  files_->timing_place.commit();
  files_->columns_place.commit();
  files_->table_place.commit();
}

}  // namespace freeplay
