#include "model/grid.h"

#include "model/map_reader.h"

namespace freeplay {
namespace {

/// `dimension`, when it is open, becomes that of the first point that has one.
bool check_point(const CheckedValue& value, std::optional<Dimension>& dimension, const Range& range = {}) {
  if (dimension) return value.quantity(*dimension, range).has_value();
  const std::optional<Quantity> quantity = value.any_quantity();
  if (quantity && quantity->kind == DimensionKind::dimensioned) dimension = quantity->dimension;
  if (!quantity || range.contains(quantity->value)) return quantity.has_value();
  value.fail("out-of-range", "'" + value.path() + "' must be " + range.text("1"));
  return false;
}

/// `[from, to, count]`; end points of a logarithmic grid are positive.
std::optional<long> check_space(const CheckedValue& value, std::optional<Dimension> dimension, const Range& range) {
  const auto items = value.list(3);
  if (!items) return std::nullopt;
  const bool from = check_point((*items)[0], dimension, range);
  const bool to = check_point((*items)[1], dimension, range);
  const std::optional<double> count = (*items)[2].quantity(dimension::none);
  if (count && *count > static_cast<double>(largest_grid)) {
    (*items)[2].fail("too-large", "a grid has at most 10^8 points");
    return std::nullopt;
  }
  const std::optional<long> points = count ? (*items)[2].integer(1, largest_grid) : std::nullopt;
  return from && to ? points : std::nullopt;
}

std::optional<long> check_list(const CheckedValue& value, std::optional<Dimension> dimension) {
  const auto items = value.list();
  if (!items) return std::nullopt;
  if (items->empty()) {
    value.fail("wrong-length", "'" + value.path() + "' must have at least 1 item");
    return std::nullopt;
  }
  bool good = true;
  for (const CheckedValue& item : *items) good = check_point(item, dimension) && good;
  return good ? std::optional<long>(static_cast<long>(items->size())) : std::nullopt;
}

}  // namespace

std::optional<long> check_grid(const CheckedValue& value, std::optional<Dimension> dimension) {
  if (value.node().is_scalar()) return check_point(value, dimension) ? std::optional<long>(1) : std::nullopt;
  if (value.node().is_list()) return check_list(value, dimension);
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
  if (linear) return check_space(*linear, dimension, {});
  if (logarithmic) return check_space(*logarithmic, dimension, positive);
  if (list) return check_list(*list, dimension);
  map.report_missing("linspace");
  return std::nullopt;
}

}  // namespace freeplay
