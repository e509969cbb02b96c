#include "format/grid.h"

#include "format/map_reader.h"

namespace freeplay {
namespace {

/// `dimension`, when it is open, becomes that of the first point that has one.
std::optional<double> read_point(const CheckedValue& value, std::optional<Dimension>& dimension,
                                 const Range& range = {}) {
  if (dimension) return value.quantity(*dimension, range);
  const std::optional<Quantity> quantity = value.any_quantity();
  if (!quantity) return std::nullopt;
  if (quantity->kind == DimensionKind::dimensioned) dimension = quantity->dimension;
  if (range.contains(quantity->value)) return quantity->value;
  value.fail("out-of-range", "'" + value.path() + "' must be " + range.text("1"));
  return std::nullopt;
}

}  // namespace

// End points of a logarithmic grid are positive.
std::optional<GridValues> read_space(const CheckedValue& value, bool logarithmic, std::optional<Dimension>& dimension) {
  const Range range = logarithmic ? positive : Range{};
  const auto items = value.list(3);
  if (!items) return std::nullopt;
  const std::optional<double> from = read_point((*items)[0], dimension, range);
  const std::optional<double> to = read_point((*items)[1], dimension, range);
  const std::optional<double> count = (*items)[2].quantity(dimension::none);
  if (count && *count > static_cast<double>(largest_grid)) {
    (*items)[2].fail("too-large", "a grid has at most 10^8 points");
    return std::nullopt;
  }
  const std::optional<long> points = count ? (*items)[2].integer(1, largest_grid) : std::nullopt;
  if (!from || !to || !points) return std::nullopt;
  return GridValues{{}, *from, *to, *points, logarithmic};
}

namespace {

std::optional<GridValues> read_list(const CheckedValue& value, std::optional<Dimension>& dimension) {
  const auto items = value.list();
  if (!items) return std::nullopt;
  if (items->empty()) {
    value.fail("wrong-length", "'" + value.path() + "' must have at least 1 item");
    return std::nullopt;
  }
  GridValues grid;
  grid.count = static_cast<long>(items->size());
  for (const CheckedValue& item : *items) {
    if (const std::optional<double> point = read_point(item, dimension)) grid.list.push_back(*point);
  }
  if (grid.list.size() != items->size()) return std::nullopt;
  return grid;
}

}  // namespace

std::optional<GridValues> read_grid(const CheckedValue& value, std::optional<Dimension>& dimension) {
  if (value.node().is_scalar()) {
    const std::optional<double> point = read_point(value, dimension);
    return point ? std::optional<GridValues>(GridValues::one(*point)) : std::nullopt;
  }
  if (value.node().is_list()) return read_list(value, dimension);
  if (!value.node().is_map()) {
    value.wrong_type("a grid: a quantity, a list or a map");
    return std::nullopt;
  }
  MapReader map(value, "grid");
  const auto linear = map.find("linspace");
  const auto logarithmic = map.find("logspace");
  const auto list = map.find("list");
  map.finish();
  if (map.conflict("linspace", "logspace") || map.conflict("linspace", "list") || map.conflict("logspace", "list")) {
    return std::nullopt;
  }
  if (linear) return read_space(*linear, false, dimension);
  if (logarithmic) return read_space(*logarithmic, true, dimension);
  if (list) return read_list(*list, dimension);
  map.report_missing("linspace");
  return std::nullopt;
}

}  // namespace freeplay
