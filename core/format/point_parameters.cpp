#include "format/point_parameters.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "format/table_file.h"
#include "format/table_keys.h"

namespace freeplay {
namespace {

Range bounds_of(const Parameter& parameter, const Unit& unit) {
  return {parameter.minimum * unit.factor, parameter.maximum * unit.factor, parameter.open};
}

/// A path alone, `angles.csv`, or a map that names it.
bool is_from_file(const Node& node) { return node.is_map() || (node.is_scalar() && node.text.ends_with(".csv")); }

bool has_length(const Parameter& parameter, const CheckedValue& written, const char* what, std::size_t length) {
  if (length >= parameter.least && length <= parameter.most) return true;
  const std::string wanted = parameter.least == parameter.most
                                 ? fmt::format("{}", parameter.least)
                                 : fmt::format("{} to {}", parameter.least, parameter.most);
  written.fail("wrong-length", fmt::format("'{}' must have {} {}, not {}", written.path(), wanted, what, length));
  return false;
}

/// The items of a list whose length the parameter takes; each gets its place.
std::optional<std::vector<CheckedValue>> items_of(const Parameter& parameter, const CheckedValue& written,
                                                  const char* what, CheckedParameters& checked) {
  if (!written.node().is_list()) {
    written.wrong_type(fmt::format("a list of {}, or a CSV file", what));
    return std::nullopt;
  }
  const std::size_t length = written.node().items.size();
  if (!has_length(parameter, written, what, length)) return std::nullopt;
  auto items = written.list();
  for (std::size_t i = 0; i < length; ++i) checked.places.emplace(fmt::format("{}.{}", parameter.name, i), (*items)[i]);
  return items;
}

/// Numbers of a parameter from a file beside the model.
class PointFile {
 public:
  PointFile(Draft& draft, const Parameter& parameter, const Unit& unit, const CheckedValue& written,
            CheckedParameters& checked)
      : draft_(draft), parameter_(parameter), unit_(unit), written_(written), checked_(checked) {}

  /// With the dimension of x for points; a list has none.
  std::shared_ptr<const ParameterPoints> read(const Dimension* of_x) {
    const bool short_form = written_.node().is_scalar();
    MapReader map = short_form ? MapReader::empty(written_) : MapReader(written_, of_x ? "column points" : "column");
    const auto file = short_form ? std::optional<CheckedValue>(written_) : map.require("file");
    const auto x_unit = of_x ? unit_factor(map.find("x_unit"), *of_x) : std::optional<double>(1.0);
    const auto x = of_x ? map.find("x") : std::nullopt, value = map.find("value");
    const auto factor = unit_factor(map.find("unit"), unit_.dimension);
    map.finish();
    if (!file || !x_unit || !factor) return nullptr;
    TableFile table(draft_, *file);
    const std::size_t columns = of_x ? 2 : 1;
    if (!table.open(columns)) return nullptr;
    const auto x_column = of_x ? table.column(x, 0) : std::nullopt, y_column = table.column(value, columns - 1);
    if ((of_x && !x_column) || !y_column) return nullptr;
    auto points = std::make_shared<ParameterPoints>();
    std::vector<std::vector<double>> values;
    const bool good =
        of_x ? table.read({*x_column, *x_unit}, {{*y_column, *factor}}, points->x, values, TableFile::Rising::numbers)
             : table.read({*y_column, *factor}, {}, points->y, values, TableFile::Rising::none);
    if (!good) return nullptr;
    if (of_x) points->y = std::move(values.front());
    const char* what = of_x ? "points [x, y]" : "numbers";
    return has_length(parameter_, *file, what, points->y.size()) && is_bounded(table, *y_column, *points) ? points
                                                                                                          : nullptr;
  }

 private:
  bool is_bounded(const TableFile& table, std::size_t column, const ParameterPoints& points) {
    const Range range = bounds_of(parameter_, unit_);
    bool good = true;
    for (std::size_t i = 0; i < points.y.size(); ++i) {
      const CsvText::Field field = table.text().field(i, column);
      checked_.fields.emplace(fmt::format("{}.{}", parameter_.name, i), FieldPlace{field.location, length_of(field)});
      if (range.contains(points.y[i])) continue;
      const std::string unit = si_unit(unit_.dimension);
      draft_.diagnostics.error(field.location, length_of(field), "out-of-range",
                               fmt::format("a number of '{}' must be {}, not {}", written_.path(), range.text(unit),
                                           with_unit(points.y[i], unit)));
      good = false;
    }
    return good;
  }
  static int length_of(const CsvText::Field& field) { return std::max(1, character_count(field.text)); }

  Draft& draft_;
  const Parameter& parameter_;
  const Unit& unit_;
  const CheckedValue& written_;
  CheckedParameters& checked_;
};

}  // namespace

std::shared_ptr<const ParameterPoints> read_list(Draft& draft, const Parameter& parameter, const Unit& unit,
                                                 const CheckedValue& written, CheckedParameters& checked) {
  if (is_from_file(written.node())) return PointFile(draft, parameter, unit, written, checked).read(nullptr);
  const auto items = items_of(parameter, written, "numbers", checked);
  if (!items) return nullptr;
  auto points = std::make_shared<ParameterPoints>();
  for (const CheckedValue& item : *items) {
    if (const auto number = item.quantity(unit.dimension, bounds_of(parameter, unit))) points->y.push_back(*number);
  }
  return points->y.size() == items->size() ? points : nullptr;
}

std::shared_ptr<const ParameterPoints> read_table(Draft& draft, const Parameter& parameter, const Dimension& of_x,
                                                  const Unit& unit, const CheckedValue& written,
                                                  CheckedParameters& checked) {
  if (is_from_file(written.node())) return PointFile(draft, parameter, unit, written, checked).read(&of_x);
  const auto items = items_of(parameter, written, "points [x, y]", checked);
  if (!items) return nullptr;
  auto points = std::make_shared<ParameterPoints>();
  bool good = true;
  for (const CheckedValue& item : *items) {
    const auto pair = item.list(2);
    const auto x = pair ? (*pair)[0].quantity(of_x) : std::nullopt;
    const auto y = pair ? (*pair)[1].quantity(unit.dimension, bounds_of(parameter, unit)) : std::nullopt;
    if (x && !points->x.empty() && !(*x > points->x.back())) {
      (*pair)[0].fail("bad-table", fmt::format("the first numbers of points must increase: '{}' is {} and follows {}",
                                               (*pair)[0].path(), *x, points->x.back()));
      good = false;
    }
    good = good && x && y;
    if (x) points->x.push_back(*x);
    if (y) points->y.push_back(*y);
  }
  return good ? points : nullptr;
}

}  // namespace freeplay
