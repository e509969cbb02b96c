#include "format/point_parameters.h"

#include <optional>
#include <vector>

#include <fmt/format.h>

namespace freeplay {
namespace {

Range bounds_of(const Parameter& parameter, const Unit& unit) {
  return {parameter.minimum * unit.factor, parameter.maximum * unit.factor, parameter.open};
}

/// The items of a list whose length the parameter takes; each gets its place.
std::optional<std::vector<CheckedValue>> items_of(const Parameter& parameter, const CheckedValue& written,
                                                  const char* what, std::map<std::string, CheckedValue>& places) {
  if (!written.node().is_list()) {
    written.wrong_type(fmt::format("a list of {}", what));
    return std::nullopt;
  }
  const std::size_t length = written.node().items.size();
  if (length < parameter.least || length > parameter.most) {
    const std::string wanted = parameter.least == parameter.most
                                   ? fmt::format("{}", parameter.least)
                                   : fmt::format("{} to {}", parameter.least, parameter.most);
    written.fail("wrong-length", fmt::format("'{}' must have {} {}, not {}", written.path(), wanted, what, length));
    return std::nullopt;
  }
  auto items = written.list();
  for (std::size_t i = 0; i < length; ++i) places.emplace(fmt::format("{}.{}", parameter.name, i), (*items)[i]);
  return items;
}

}  // namespace

std::shared_ptr<const ParameterPoints> read_list(const Parameter& parameter, const Unit& unit,
                                                 const CheckedValue& written,
                                                 std::map<std::string, CheckedValue>& places) {
  const auto items = items_of(parameter, written, "numbers", places);
  if (!items) return nullptr;
  auto points = std::make_shared<ParameterPoints>();
  for (const CheckedValue& item : *items) {
    if (const auto number = item.quantity(unit.dimension, bounds_of(parameter, unit))) points->y.push_back(*number);
  }
  return points->y.size() == items->size() ? points : nullptr;
}

std::shared_ptr<const ParameterPoints> read_table(const Parameter& parameter, const Dimension& of_x, const Unit& unit,
                                                  const CheckedValue& written,
                                                  std::map<std::string, CheckedValue>& places) {
  const auto items = items_of(parameter, written, "points [x, y]", places);
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
