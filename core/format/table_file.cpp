#include "format/table_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/input_text.h"
#include "base/kept_input.h"
#include "base/text.h"

namespace freeplay {
namespace {

constexpr std::size_t most_bytes = 2 * largest_input;  // of all tables of a model
constexpr int most_mistakes = 100;                     // that are reported of one table

/// The name, or NAME-2 and so on when it is taken.
std::string free_name(const std::vector<InputFile>& inputs, const std::filesystem::path& path) {
  const auto taken = [&](const std::string& name) {
    return std::ranges::find(inputs, name, &InputFile::name) != inputs.end();
  };
  std::string name = path.filename().string();
  for (int i = 2; taken(name); ++i) {
    name = fmt::format("{}-{}{}", path.stem().string(), i, path.extension().string());
  }
  return name;
}

}  // namespace

std::string TableFile::path_of(const Draft& draft, const std::string& name) {
  return (std::filesystem::path(draft.model.file).parent_path() / name).lexically_normal().string();
}

bool TableFile::open(std::size_t least) {
  text_ = find();
  if (text_ == nullptr) return false;
  if (text_->too_large()) {
    file_.fail("too-large",
               fmt::format("a table has at most {} columns and {} rows", CsvText::most_columns, CsvText::most_rows));
    return false;
  }
  return has_header(least);
}

const CsvText* TableFile::find() const {
  const auto name = file_.string();
  if (!name) return nullptr;
  const std::filesystem::path path = path_of(draft_, *name);
  const auto known = draft_.tables.find(path.string());
  if (known != draft_.tables.end()) return known->second.get();
  std::string text;
  const std::string place = kept_input(draft_.model.file, path.string(), free_name(draft_.model.inputs, path));
  if (const std::string fault = read_input(place, text); !fault.empty()) {
    file_.fail("file-not-found", fmt::format("cannot read '{}': {}", path.string(), fault));
    return nullptr;
  }
  if (text.size() > largest_input) {
    file_.fail("too-large", fmt::format("the table '{}' is larger than 16 MiB", path.string()));
    return nullptr;
  }
  draft_.table_bytes += text.size();
  if (draft_.table_bytes > most_bytes) {
    file_.fail("too-large", "the tables of the model are larger than 32 MiB together");
    return nullptr;
  }
  draft_.model.inputs.push_back({free_name(draft_.model.inputs, path), text});
  auto table = std::make_unique<CsvText>(path.string(), std::move(text));
  draft_.diagnostics.add_source(path.string(), table->text());
  return draft_.tables.emplace(path.string(), std::move(table)).first->second.get();
}

/// Is the first row one of names, each of which stands for one column?
bool TableFile::has_header(std::size_t least) const {
  const CsvText& text = *text_;
  if (const auto foreign = text.foreign_byte()) {
    const bool zero = foreign->text.starts_with('\0');
    draft_.diagnostics.error(foreign->location, 1, "bad-table",
                             zero ? "a control character cannot stand in the file" : "this byte is not UTF-8", "",
                             zero ? "" : "save the file as UTF-8");
    return false;
  }
  const std::vector<std::string>& names = text.names();
  if (names.size() < least) {
    bad(text.header(0), "a table needs two columns and a header row", "fields are separated by commas");
    return false;
  }
  if (std::ranges::all_of(names, [](const std::string& name) { return csv_number(name).has_value(); })) {
    bad(text.header(0), fmt::format("the first row must name the columns: '{}' is a number", names[0]));
    return false;
  }
  std::map<std::string_view, std::size_t> known;
  bool good = true;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto [first, fresh] = known.emplace(names[i], i);
    if (fresh || names[i].empty()) continue;
    bad(text.header(i), fmt::format("column {} has the name '{}' already", first->second + 1, printable(names[i])));
    good = false;
  }
  return good;
}

std::optional<std::size_t> TableFile::column(const std::optional<CheckedValue>& value, std::size_t standard) const {
  const std::vector<std::string>& names = text_->names();
  if (value) {
    const auto name = value->string();
    if (!name) return std::nullopt;
    const auto found = std::ranges::find(names, *name);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    value->fail("unknown-name", fmt::format("'{}' has no column '{}'", file_.node().text, *name),
                nearest(*name, names));
    return std::nullopt;
  }
  const bool named = !csv_number(names[standard]);
  if (named) return standard;
  bad(text_->header(standard), fmt::format("a column needs a name: '{}' is a number", names[standard]));
  return std::nullopt;
}

// Goes on after a mistake, so that all are reported, up to a number that is no longer mended by hand.
bool TableFile::read(const Column& times, const std::vector<Column>& others, std::vector<double>& t,
                     std::vector<std::vector<double>>& values, Rising rising) const {
  const std::size_t columns = text_->names().size();
  values.resize(others.size());
  std::optional<double> last;
  int mistakes = 0;
  for (std::size_t row = 0; row < text_->rows(); ++row) {
    if (mistakes >= most_mistakes) {
      bad(text_->field(row, 0), fmt::format("after {} mistakes the table is not read from here on", mistakes));
      break;
    }
    if (const std::size_t fields = text_->fields(row); fields > columns) {
      bad(text_->field(row, columns), fmt::format("this row has {} fields, the header {}", fields, columns),
          "a decimal mark is a point: 1.5");
      ++mistakes;
      continue;
    }
    const auto time = number(row, times);
    mistakes += time ? 0 : 1;
    for (std::size_t i = 0; i < others.size(); ++i) {
      const auto x = number(row, others[i]);
      mistakes += x ? 0 : 1;
      if (time) values[i].push_back(x.value_or(0.0));
    }
    if (!time) continue;
    if (rising != Rising::none && last && !(*time > *last)) {
      bad(text_->field(row, times.index),
          rising == Rising::times
              ? fmt::format("times must increase: {} s follows {} s", *time, *last)
              : fmt::format("the first numbers of points must increase: {} follows {}", *time, *last));
      ++mistakes;
    }
    last = time;
    t.push_back(*time);
  }
  return mistakes == 0;
}

// In SI.
std::optional<double> TableFile::number(std::size_t row, const Column& column) const {
  const CsvText::Field field = text_->field(row, column.index);
  const auto number = csv_number(field.text);
  if (number && std::isfinite(*number * column.factor)) return *number * column.factor;
  bad(field, field.text.empty() ? "a number is missing"
             : number           ? fmt::format("the number '{}' is too large", printable(field.text))
                                : fmt::format("'{}' is not a number", printable(field.text)));
  return std::nullopt;
}

void TableFile::bad(const CsvText::Field& field, const std::string& message, const std::string& hint) const {
  draft_.diagnostics.error(field.location, std::max(1, character_count(field.text)), "bad-table", message, "", hint);
}

}  // namespace freeplay
