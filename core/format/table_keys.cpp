#include "format/table_keys.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "format/table_file.h"

namespace freeplay {
namespace {

constexpr std::size_t most_points = CsvText::most_rows;  // of all tables of a model

/// Times and values in SI.
struct Points {
  std::vector<double> times, values;
};

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
    time_unit_ = unit_factor(map.find("time_unit"), dimension::time);
    unit_ = unit_factor(map.find("unit"), dimension_);
    const auto interpolation = word_place(map.find("interpolation"), {"cubic", "linear"});
    const auto ends = word_place(map.find("ends"), {"natural", "clamped", "periodic"});
    const auto outside = word_place(map.find("outside"), {"hold", "repeat", "error"});
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

  std::string key_of(const CheckedValue& file, const std::optional<CheckedValue>& time_column,
                     const std::optional<CheckedValue>& value_column, const std::array<int, 3>& words) const {
    const auto word = [](const std::optional<CheckedValue>& value) {
      return value ? "=" + value->string().value_or("") : std::string();
    };
    return fmt::format("{}\n{}\n{}\n{} {} {} {} {}", TableFile::path_of(draft_, file.string().value_or("")),
                       word(time_column), word(value_column), *time_unit_, *unit_, words[0], words[1], words[2]);
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
    TableFile opened(draft_, file);
    if (!opened.open()) return false;
    const auto time = opened.column(time_column, 0), value = opened.column(value_column, 1);
    std::vector<std::vector<double>> values;
    if (!time || !value || !opened.read({*time, *time_unit_}, {{*value, *unit_}}, table.times, values)) return false;
    table.values = std::move(values.front());
    const std::string fault = fault_of(table, periodic);
    if (fault.empty()) return true;
    draft_.diagnostics.error(opened.text().body_location(), 1, "bad-table", fault);
    return false;
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

std::optional<double> unit_factor(const std::optional<CheckedValue>& value, const Dimension& wanted) {
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

std::optional<int> word_place(const std::optional<CheckedValue>& value, const std::vector<std::string>& words) {
  return value ? value->word(words) : std::optional<int>(0);
}

std::shared_ptr<const TimeTable> read_table(Draft& draft, const CheckedValue& value, const Dimension& dimension,
                                            TableSource* source) {
  return TableReader(draft, value, dimension, source).read();
}

}  // namespace freeplay
