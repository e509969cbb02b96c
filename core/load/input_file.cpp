#include "load/input_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "base/input_text.h"
#include "base/kept_input.h"
#include "base/number_text.h"
#include "base/text.h"
#include "format/checked_value.h"
#include "format/csv_text.h"

namespace freeplay {
namespace {

constexpr int most_mistakes = 100;  // that are reported of one file

class InputFileReader {
 public:
  InputFileReader(const Model& model, const CsvText& table, Diagnostics& diagnostics)
      : model_(model), table_(table), diagnostics_(diagnostics), inputs_(inputs_of(model)) {
    for (const int driver : inputs_) names_.push_back(model.drivers[static_cast<std::size_t>(driver)].name);
  }

  InputCourse read() {
    if (!read_header()) return {};
    InputCourse course;
    for (std::size_t row = 0; row < table_.rows() && mistakes_ < most_mistakes; ++row) read_row(row, course);
    return mistakes_ == 0 ? course : InputCourse{};
  }

 private:
  void bad(const CsvText::Field& field, const char* id, const std::string& message,
           const std::string& suggestion = {}) {
    ++mistakes_;
    diagnostics_.error(field.location, std::max(1, character_count(field.text)), id, message, suggestion);
  }

  /// Finds the place of every column among the inputs; that of `time` has none.
  bool read_header() {
    if (const auto foreign = table_.foreign_byte()) {
      bad(*foreign, "bad-table", "this byte is not one of a text in UTF-8");
      return false;
    }
    if (table_.too_large()) {
      bad(table_.header(0), "too-large", fmt::format("a table has at most {} rows", CsvText::most_rows));
      return false;
    }
    const std::vector<std::string>& columns = table_.names();
    if (columns.empty() || columns[0] != "time") {
      bad(table_.header(0), "bad-table", "the first column must be 'time', those after it inputs of the model");
      return false;
    }
    for (std::size_t column = 1; column < columns.size(); ++column) {
      const auto found = std::ranges::find(names_, columns[column]);
      const std::size_t place = static_cast<std::size_t>(found - names_.begin());
      if (found == names_.end()) {
        bad(table_.header(column), "unknown-name",
            fmt::format("the model has no input '{}'", printable(columns[column])), nearest(columns[column], names_));
      } else if (std::ranges::find(places_, place) != places_.end()) {
        bad(table_.header(column), "bad-table", fmt::format("there is a column '{}' already", columns[column]));
      }
      places_.push_back(place);
    }
    return mistakes_ == 0;
  }

  void read_row(std::size_t row, InputCourse& course) {
    const std::size_t columns = places_.size() + 1;
    if (table_.fields(row) > columns) {
      bad(table_.field(row, columns), "bad-table",
          fmt::format("this row has {} fields, the header {}", table_.fields(row), columns));
      return;
    }
    const std::optional<double> time = number(row, 0);
    if (time) check_time(row, *time);
    InputCourse::Row read{time.value_or(last_), {}};
    for (const int driver : inputs_)
      read.efforts.push_back(model_.drivers[static_cast<std::size_t>(driver)].value.constant().value);
    for (std::size_t i = 0; i < places_.size(); ++i) read.efforts[places_[i]] = number(row, i + 1).value_or(0.0);
    last_ = read.time;
    course.rows.push_back(std::move(read));
  }

  void check_time(std::size_t row, double time) {
    const double start = model_.settings.start;
    if (row == 0 && time < start) {
      bad(table_.field(row, 0), "bad-table", fmt::format("the run begins at {} s, after {} s", start, time));
    } else if (row > 0 && !(time > last_)) {
      bad(table_.field(row, 0), "bad-table", fmt::format("times must increase: {} s follows {} s", time, last_));
    }
  }

  std::optional<double> number(std::size_t row, std::size_t column) {
    const CsvText::Field field = table_.field(row, column);
    const std::optional<double> number = csv_number(field.text);
    if (number && std::isfinite(*number)) return number;
    bad(field, "bad-table",
        field.text.empty() ? "a number is missing"
        : number           ? fmt::format("the number '{}' is too large", printable(field.text))
                           : fmt::format("'{}' is not a number", printable(field.text)));
    return std::nullopt;
  }

  const Model& model_;
  const CsvText& table_;
  Diagnostics& diagnostics_;
  std::vector<int> inputs_;
  std::vector<std::string> names_;
  std::vector<std::size_t> places_;  // among the inputs, by column after the first
  double last_ = 0.0;
  int mistakes_ = 0;
};

}  // namespace

InputCourse read_inputs(const std::string& path, const Model& model, Diagnostics& diagnostics, InputFile& file) {
  if (inputs_of(model).empty()) {
    throw Error(Error::Category::usage, "usage", "--inputs: the model has no inputs", {},
                "an input is a driver by torque or force with 'input' in place of 'value'");
  }
  std::string name = std::filesystem::path(path).filename().string(), text;
  while (std::ranges::find(model.inputs, name, &InputFile::name) != model.inputs.end()) name = "run-" + name;
  if (const std::string fault = read_input(kept_input(model.file, path, name), text); !fault.empty()) {
    throw Error(Error::Category::input, "file-not-found", fmt::format("cannot read '{}': {}", path, fault));
  }
  if (text.size() > largest_input) {
    throw Error(Error::Category::input, "too-large", fmt::format("the table '{}' is larger than 16 MiB", path));
  }
  file = {name, text};
  diagnostics.add_source(path, text);
  const CsvText table(path, std::move(text));
  return InputFileReader(model, table, diagnostics).read();
}

std::string input_text(const Model& model, const InputCourse& course) {
  std::string text = "time";
  for (const int driver : inputs_of(model)) text += "," + model.drivers[static_cast<std::size_t>(driver)].name;
  text += '\n';
  for (const InputCourse::Row& row : course.rows) {
    append_number(text, row.time);
    for (const double effort : row.efforts) {
      text += ',';
      append_number(text, effort);
    }
    text += '\n';
  }
  return text;
}

}  // namespace freeplay
