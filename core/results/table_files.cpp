#include "results/table_files.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <matio.h>

#include "base/error.h"
#include "base/number_text.h"
#include "results/hdf5_writer.h"
#include "results/mat_table.h"

namespace freeplay {
namespace {

constexpr std::size_t piece = 1 << 16;                     // characters given at a time
constexpr std::size_t most_of_mat = std::size_t{1} << 31;  // bytes of a variable

[[noreturn]] void cannot_write(const std::filesystem::path& path, const std::string& reason) {
  throw Error(Error::Category::file, "cannot-write", fmt::format("cannot write '{}': {}", path.string(), reason));
}

using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

Variable variable(const char* name, matio_classes kind, matio_types type, std::size_t rows, std::size_t columns,
                  const void* data, int options = 0) {
  std::size_t size[] = {rows, columns};
  // The library's interface does without const; what it is given it copies or only reads.
  return {Mat_VarCreate(name, kind, type, 2, size, const_cast<void*>(data), options), Mat_VarFree};
}

Variable text_variable(const char* name, const std::string& text) {
  return variable(name, MAT_C_CHAR, MAT_T_UTF8, text.empty() ? 0 : 1, text.size(), text.data());
}

Variable words_variable(const char* name, const std::vector<std::string>& words) {
  std::vector<matvar_t*> cells;
  for (const std::string& word : words) cells.push_back(text_variable(nullptr, word).release());
  return variable(name, MAT_C_CELL, MAT_T_CELL, words.size(), 1, cells.data());
}

/// Whether the last variable of a MAT-file is there as it was written.
bool ends_with_record(const std::filesystem::path& path, const std::string& record) {
  try {
    return read_mat(path).provenance == record;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

void give_csv(TableView& table, const TakeText& take) {
  std::string text;
  for (const RecordColumn& column : table.columns()) (text += column.name) += ',';
  text.back() = '\n';
  const std::size_t width = table.columns().size();
  table.rows([&](std::span<const double> rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (const std::string* word = table.word(i % width, rows[i])) {
        text += *word;
      } else {
        append_number(text, rows[i]);
      }
      text += (i + 1) % width == 0 ? '\n' : ',';
      if (text.size() < piece || (i + 1) % width != 0) continue;
      take(text);
      text.clear();
    }
  });
  take(text);
}

void give_json(TableView& table, const std::string& name, const Json& summary, const Json& provenance,
               const TakeText& take) {
  Json columns = Json::array(), units = Json::array();
  for (const RecordColumn& column : table.columns()) {
    columns.push_back(column.name);
    units.push_back(column.unit);
  }
  const auto compact = [](const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); };
  std::string text = fmt::format("{{\n  \"table\": {},\n  \"columns\": {},\n  \"units\": {},\n  \"rows\": [",
                                 compact(name), compact(columns), compact(units));
  const std::size_t width = table.columns().size();
  bool first = true;
  table.rows([&](std::span<const double> rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (i % width == 0) text += std::exchange(first, false) ? "\n    [" : ",\n    [";
      if (const std::string* word = table.word(i % width, rows[i])) {
        text += compact(*word);
      } else if (std::isfinite(rows[i])) {
        append_number(text, rows[i]);
      } else {
        text += "null";
      }
      text += (i + 1) % width == 0 ? "]" : ", ";
      if (text.size() < piece) continue;
      take(text);
      text.clear();
    }
  });
  text += fmt::format("{}],\n  \"summary\": {},\n  \"provenance\": {}\n}}\n", first ? "" : "\n  ", compact(summary),
                      compact(provenance));
  take(text);
}

void write_hdf5(TableView& table, ResultReader& reader, const Json& provenance, const std::filesystem::path& path) {
  RecordLayout layout = reader.layout();
  layout.columns = table.columns();
  std::erase_if(layout.attributes, [](const auto& attribute) { return attribute.first == "provenance"; });
  layout.attributes.emplace_back("provenance", provenance.dump(-1, ' ', false, Json::error_handler_t::replace));
  Hdf5Writer writer(path, layout, {.expected_rows = 1024, .grows = false});
  table.rows([&](std::span<const double> rows) {
    writer.write({.rows = rows, .events = {}});
    writer.flush();
  });
  if (!layout.events.empty()) {
    reader.events([&](std::span<const double> events) { writer.write({.rows = {}, .events = events}); });
  }
  writer.finish({}, "");
  if (!writer.failure().empty()) throw Error(Error::Category::file, "cannot-write", writer.failure());
}

void write_mat(TableView& table, const Json& provenance, const std::filesystem::path& path) {
  const std::size_t width = table.columns().size();
  std::vector<std::vector<double>> columns(width);
  table.rows([&](std::span<const double> rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) columns[i % width].push_back(rows[i]);
    if (columns[0].size() * width * sizeof(double) < most_of_mat) return;
    throw Error(Error::Category::usage, "too-large", "a MAT-file holds at most 2 GiB in one variable", {},
                "take fewer rows with --every, or some channels with --channels");
  });
  const std::size_t rows = columns[0].size();
  const auto first = std::ranges::find(table.columns(), "time", &RecordColumn::name);
  const auto time_column = static_cast<std::size_t>(first - table.columns().begin()) % width;
  std::vector<double> data;
  std::vector<std::string> names, units;
  data.reserve(rows * width);
  for (std::size_t c = 0; c < width; ++c) {
    if (c == time_column) continue;
    data.insert(data.end(), columns[c].begin(), columns[c].end());
    std::vector<double>().swap(columns[c]);
    names.push_back(table.columns()[c].name);
    units.push_back(table.columns()[c].unit);
  }
  std::unique_ptr<mat_t, decltype(&Mat_Close)> file(Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5), Mat_Close);
  if (file == nullptr) cannot_write(path, std::strerror(errno));
  const auto put = [&](const Variable& one) {
    if (one == nullptr || Mat_VarWrite(file.get(), one.get(), MAT_COMPRESSION_NONE) != 0) {
      cannot_write(path, errno != 0 ? std::strerror(errno) : "the MAT library refuses it");
    }
  };
  const std::vector<double>& time = columns[time_column];
  put(variable("time", MAT_C_DOUBLE, MAT_T_DOUBLE, rows, 1, time.data(), MAT_F_DONT_COPY_DATA));
  put(variable("data", MAT_C_DOUBLE, MAT_T_DOUBLE, rows, width - 1, data.data(), MAT_F_DONT_COPY_DATA));
  put(words_variable("channels", names));
  put(words_variable("units", units));
  const std::string record = provenance.dump(-1, ' ', false, Json::error_handler_t::replace);
  put(text_variable("provenance", record));
  file.reset();
  // The library does not say that the disk is full: what was written last is there if all is.
  if (!ends_with_record(path, record)) cannot_write(path, "it is not complete, as where the disk is full");
}

}  // namespace freeplay
