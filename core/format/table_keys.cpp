#include "format/table_keys.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/input_text.h"
#include "base/kept_input.h"
#include "base/text.h"

namespace freeplay {
namespace {

constexpr std::size_t most_bytes = 2 * largest_input, most_points = CsvText::most_rows;  // of all tables of a model
constexpr int most_mistakes = 100;  // that are reported of one table

/// Times and values in SI.
struct Points {
  std::vector<double> times, values;
};

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

class TableReader {
 public:
  TableReader(Draft& draft, const CheckedValue& value, const Dimension& dimension, TableSource* source)
      : draft_(draft), value_(value), dimension_(dimension), source_(source) {}

  std::shared_ptr<const TimeTable> read() {
    const bool short_form = value_.node().is_scalar();
    if (!short_form && !value_.node().is_map()) {
      value_.wrong_type("the path of a file or a map");
      return nullptr;
    }
    MapReader map = short_form ? MapReader::empty(value_) : MapReader(value_, "table");
    const auto file = short_form ? std::optional<CheckedValue>(value_) : map.find("file");
    const auto points = map.find("points");
    time_unit_ = unit(map.find("time_unit"), dimension::time);
    unit_ = unit(map.find("unit"), dimension_);
    const auto interpolation = word(map.find("interpolation"), {"cubic", "linear"});
    const auto ends = word(map.find("ends"), {"natural", "clamped", "periodic"});
    const auto outside = word(map.find("outside"), {"hold", "repeat", "error"});
    const auto time_column = map.find("time"), value_column = map.find("value");
    if (source_ != nullptr) {
      note_source(map, file, {interpolation.value_or(0), ends.value_or(0), outside.value_or(0)});
    }
    map.conflict("file", "points");
    if (!file) {
      for (const char* of_a_file : {"time", "value"}) map.conflict("points", of_a_file);
    }
    if (!file && !points && map.good()) map.report_missing("file");
    map.finish();
    if (file.has_value() == points.has_value()) return nullptr;
    const bool good_keys = time_unit_ && unit_ && interpolation && ends && outside;
    const bool periodic = good_keys && *interpolation == 0 && *ends == 2;
    if (!good_keys) {
      // For the mistakes in them.
      Points table;
      if (!time_unit_) time_unit_ = 1.0;
      if (!unit_) unit_ = 1.0;
      if (points) read_points(*points, periodic, table);
      return nullptr;
    }
    const std::string key = file ? key_of(*file, time_column, value_column, {*interpolation, *ends, *outside}) : "";
    if (const auto known = draft_.time_tables.find(key); known != draft_.time_tables.end()) {
      return tried(*known->second) ? known->second : nullptr;
    }
    Points table;
    const bool good =
        file ? read_file(*file, time_column, value_column, periodic, table) : read_points(*points, periodic, table);
    if (!good) return nullptr;
    draft_.table_points += table.times.size();
    if (draft_.table_points > most_points) {
      value_.fail("too-large", fmt::format("the tables of the model have more than {} rows", most_points));
      return nullptr;
    }
    auto made = std::make_shared<const TimeTable>(std::move(table.times), std::move(table.values),
                                                  static_cast<Interpolation>(*interpolation),
                                                  static_cast<SplineEnds>(*ends), static_cast<Outside>(*outside));
    if (file) draft_.time_tables.emplace(key, made);
    return tried(*made) ? made : nullptr;
  }

 private:
  /// `words`: places of interpolation, ends and outside in their lists.
  void note_source(MapReader& map, const std::optional<CheckedValue>& file, const std::array<int, 3>& words) {
    const auto text = [](const std::optional<CheckedValue>& key) { return key ? key->node().text : std::string(); };
    *source_ = {text(file),
                text(map.find("time")),
                text(map.find("value")),
                text(map.find("time_unit")),
                text(map.find("unit")),
                static_cast<Interpolation>(words[0]),
                static_cast<SplineEnds>(words[1]),
                static_cast<Outside>(words[2])};
  }

  std::filesystem::path path_of(const std::string& name) const {
    return (std::filesystem::path(draft_.model.file).parent_path() / name).lexically_normal();
  }

  std::string key_of(const CheckedValue& file, const std::optional<CheckedValue>& time_column,
                     const std::optional<CheckedValue>& value_column, const std::array<int, 3>& words) const {
    const auto word = [](const std::optional<CheckedValue>& value) {
      return value ? "=" + value->string().value_or("") : std::string();
    };
    return fmt::format("{}\n{}\n{}\n{} {} {} {} {}", path_of(file.string().value_or("")).string(), word(time_column),
                       word(value_column), *time_unit_, *unit_, words[0], words[1], words[2]);
  }

  std::optional<double> unit(const std::optional<CheckedValue>& value, const Dimension& wanted) const {
    if (!value) return 1.0;
    const auto text = value->string();
    if (!text) return std::nullopt;
    try {
      const Unit unit = parse_unit(*text);
      if (unit.dimension == wanted) return unit.factor;
      value->fail("dimension-mismatch", fmt::format("'{}' must be a unit of {}, not of {}", value->path(),
                                                    dimension_name(wanted), dimension_name(unit.dimension)));
    } catch (const ExpressionError& error) {
      value->fail(error.id, error.message, error.suggestion, error.hint);
    }
    return std::nullopt;
  }

  static std::optional<int> word(const std::optional<CheckedValue>& value, const std::vector<std::string>& words) {
    return value ? value->word(words) : std::optional<int>(0);
  }

  // --- in the model ----------------------------------------------------------------------------------------------

  bool read_points(const CheckedValue& value, bool periodic, Points& table) const {
    const auto items = value.list();
    if (!items) return false;
    bool good = true;
    for (const CheckedValue& item : *items) {
      const auto pair = item.list(2);
      const auto time = pair ? number((*pair)[0], dimension::time, *time_unit_) : std::nullopt;
      const auto number_there = pair ? number((*pair)[1], dimension_, *unit_) : std::nullopt;
      good = good && time && number_there;
      if (!good) continue;
      if (!table.times.empty() && !(*time > table.times.back())) {
        (*pair)[0].fail("bad-table", fmt::format("times must increase: {} s follows {} s", *time, table.times.back()));
        return false;
      }
      table.times.push_back(*time);
      table.values.push_back(*number_there);
    }
    if (!good) return false;
    const std::string fault = fault_of(table, periodic);
    if (fault.empty()) return true;
    value.fail("bad-table", fault);
    return false;
  }

  /// A number without a unit of its own has that of its column.
  static std::optional<double> number(const CheckedValue& value, const Dimension& dimension, double factor) {
    const auto quantity = value.quantity(dimension);
    if (!quantity) return std::nullopt;
    const bool bare = value.any_quantity()->kind != DimensionKind::dimensioned;
    return bare ? *quantity * factor : *quantity;
  }

  static std::string fault_of(const Points& table, bool periodic) {
    const std::size_t least = periodic ? 3 : 2;
    if (table.times.size() < least) return fmt::format("a table needs at least {} rows", least);
    if (!periodic) return {};
    double largest = 0.0;
    for (const double value : table.values) largest = std::max(largest, std::abs(value));
    if (std::abs(table.values.front() - table.values.back()) <= 1e-9 * largest) return {};
    return fmt::format("first and last value of a periodic table must agree: {} and {}", table.values.front(),
                       table.values.back());
  }

  // --- in a file -------------------------------------------------------------------------------------------------

  bool read_file(const CheckedValue& file, const std::optional<CheckedValue>& time_column,
                 const std::optional<CheckedValue>& value_column, bool periodic, Points& table) {
    const CsvText* text = open(file);
    if (text == nullptr) return false;
    if (text->too_large()) {
      file.fail("too-large",
                fmt::format("a table has at most {} columns and {} rows", CsvText::most_columns, CsvText::most_rows));
      return false;
    }
    if (!has_header(*text)) return false;
    const auto time = column(*text, file, time_column, 0), values = column(*text, file, value_column, 1);
    if (!time || !values || !read_rows(*text, *time, *values, table)) return false;
    const std::string fault = fault_of(table, periodic);
    if (fault.empty()) return true;
    draft_.diagnostics.error(text->body_location(), 1, "bad-table", fault);
    return false;
  }

  /// Is the first row one of names, each of which stands for one column?
  bool has_header(const CsvText& text) const {
    if (const auto foreign = text.foreign_byte()) {
      const bool zero = foreign->text.starts_with('\0');
      draft_.diagnostics.error(foreign->location, 1, "bad-table",
                               zero ? "a control character cannot stand in the file" : "this byte is not UTF-8", "",
                               zero ? "" : "save the file as UTF-8");
      return false;
    }
    const std::vector<std::string>& names = text.names();
    if (names.size() < 2) {
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

  /// Goes on after a mistake, so that all are reported, up to a number that is no longer mended by hand.
  bool read_rows(const CsvText& text, std::size_t time, std::size_t values, Points& table) const {
    const std::size_t columns = text.names().size();
    std::optional<double> last;
    int mistakes = 0;
    for (std::size_t row = 0; row < text.rows(); ++row) {
      if (mistakes >= most_mistakes) {
        bad(text.field(row, 0), fmt::format("after {} mistakes the table is not read from here on", mistakes));
        break;
      }
      if (const std::size_t fields = text.fields(row); fields > columns) {
        bad(text.field(row, columns), fmt::format("this row has {} fields, the header {}", fields, columns),
            "a decimal mark is a point: 1.5");
        ++mistakes;
        continue;
      }
      const auto t = field(text, row, time, *time_unit_), x = field(text, row, values, *unit_);
      mistakes += (t ? 0 : 1) + (x ? 0 : 1);
      if (!t) continue;
      if (last && !(*t > *last)) {
        bad(text.field(row, time), fmt::format("times must increase: {} s follows {} s", *t, *last));
        ++mistakes;
      }
      last = t;
      table.times.push_back(*t);
      table.values.push_back(x.value_or(0.0));
    }
    return mistakes == 0;
  }

  const CsvText* open(const CheckedValue& file) const {
    const auto name = file.string();
    if (!name) return nullptr;
    const std::filesystem::path path = path_of(*name);
    const auto known = draft_.tables.find(path.string());
    if (known != draft_.tables.end()) return known->second.get();
    std::string text;
    const std::string place = kept_input(draft_.model.file, path.string(), free_name(draft_.model.inputs, path));
    if (const std::string fault = read_input(place, text); !fault.empty()) {
      file.fail("file-not-found", fmt::format("cannot read '{}': {}", path.string(), fault));
      return nullptr;
    }
    if (text.size() > largest_input) {
      file.fail("too-large", fmt::format("the table '{}' is larger than 16 MiB", path.string()));
      return nullptr;
    }
    draft_.table_bytes += text.size();
    if (draft_.table_bytes > most_bytes) {
      file.fail("too-large", "the tables of the model are larger than 32 MiB together");
      return nullptr;
    }
    draft_.model.inputs.push_back({free_name(draft_.model.inputs, path), text});
    auto table = std::make_unique<CsvText>(path.string(), std::move(text));
    draft_.diagnostics.add_source(path.string(), table->text());
    return draft_.tables.emplace(path.string(), std::move(table)).first->second.get();
  }

  std::optional<std::size_t> column(const CsvText& text, const CheckedValue& file,
                                    const std::optional<CheckedValue>& value, std::size_t standard) const {
    const std::vector<std::string>& names = text.names();
    if (value) {
      const auto name = value->string();
      if (!name) return std::nullopt;
      const auto found = std::ranges::find(names, *name);
      if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
      value->fail("unknown-name", fmt::format("'{}' has no column '{}'", file.node().text, *name),
                  nearest(*name, names));
      return std::nullopt;
    }
    const bool named = !csv_number(names[standard]);
    if (named) return standard;
    bad(text.header(standard), fmt::format("a column needs a name: '{}' is a number", names[standard]));
    return std::nullopt;
  }

  /// In SI; `factor` is that of the unit of the column.
  std::optional<double> field(const CsvText& text, std::size_t row, std::size_t column, double factor) const {
    const CsvText::Field field = text.field(row, column);
    const auto number = csv_number(field.text);
    if (number && std::isfinite(*number * factor)) return *number * factor;
    bad(field, field.text.empty() ? "a number is missing"
               : number           ? fmt::format("the number '{}' is too large", printable(field.text))
                                  : fmt::format("'{}' is not a number", printable(field.text)));
    return std::nullopt;
  }

  void bad(const CsvText::Field& field, const std::string& message, const std::string& hint = {}) const {
    draft_.diagnostics.error(field.location, std::max(1, character_count(field.text)), "bad-table", message, "", hint);
  }

  // ---------------------------------------------------------------------------------------------------------------

  bool tried(const TimeTable& table) const {
    Jet jet;
    EvaluationFailure failure;
    const double start = value_.reading().start_time;
    if (table.evaluate(start, jet, failure)) return true;
    value_.fail(failure.id, fmt::format("{}: {} s", failure.reason, start));
    return false;
  }

  Draft& draft_;
  const CheckedValue& value_;
  Dimension dimension_;
  TableSource* source_;                     ///< may be null
  std::optional<double> time_unit_, unit_;  ///< factors to SI
};

}  // namespace

std::shared_ptr<const TimeTable> read_table(Draft& draft, const CheckedValue& value, const Dimension& dimension,
                                            TableSource* source) {
  return TableReader(draft, value, dimension, source).read();
}

}  // namespace freeplay
