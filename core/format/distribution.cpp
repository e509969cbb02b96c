#include "format/distribution.h"

#include <utility>

#include <fmt/format.h>

namespace freeplay {
namespace {

/// The numbers of a list, the first that has a dimension giving it to all.
std::optional<std::vector<double>> read_numbers(const CheckedValue& value, std::size_t count,
                                                std::optional<Dimension>& dimension) {
  const auto items = value.list(count);
  if (!items) return std::nullopt;
  std::vector<double> numbers;
  for (const CheckedValue& item : *items) {
    if (dimension) {
      if (const auto number = item.quantity(*dimension)) numbers.push_back(*number);
    } else if (const auto quantity = item.any_quantity()) {
      if (quantity->kind == DimensionKind::dimensioned) dimension = quantity->dimension;
      numbers.push_back(quantity->value);
    }
  }
  if (numbers.size() != count) return std::nullopt;
  return numbers;
}

std::optional<Distribution> checked(const CheckedValue& value, Distribution::Kind kind,
                                    const std::vector<double>& numbers) {
  Distribution made{kind, numbers[0], numbers[1], numbers.size() > 2 ? numbers[2] : 0.0};
  switch (kind) {
    case Distribution::Kind::normal:
      if (made.b > 0.0) return made;
      value.item(1).fail("out-of-range", "the standard deviation must be > 0");
      return std::nullopt;
    case Distribution::Kind::uniform:
      if (made.a < made.b) return made;
      value.item(1).fail("out-of-range", "the high end must be above the low one");
      return std::nullopt;
    case Distribution::Kind::triangular:
      if (made.a <= made.b && made.b <= made.c && made.a < made.c) return made;
      value.item(1).fail("out-of-range", "a triangle is [low, mode, high], in this order");
      return std::nullopt;
  }
  return std::nullopt;
}

/// The ends between which it has values.
std::pair<double, double> support(const Distribution& of) {
  if (of.kind == Distribution::Kind::normal) return {of.low, of.high};
  return {of.a, of.kind == Distribution::Kind::uniform ? of.b : of.c};
}

}  // namespace

std::optional<std::pair<double, double>> read_ends(const CheckedValue& value, std::optional<Dimension>& dimension) {
  const auto numbers = read_numbers(value, 2, dimension);
  if (!numbers) return std::nullopt;
  if ((*numbers)[0] < (*numbers)[1]) return std::pair((*numbers)[0], (*numbers)[1]);
  value.item(1).fail("out-of-range", "the high end must be above the low one");
  return std::nullopt;
}

std::optional<Distribution> read_distribution(MapReader& axis, std::optional<Dimension>& dimension) {
  constexpr const char* words[] = {"normal", "uniform", "triangular"};
  std::optional<Distribution> made;
  for (const auto kind : {Distribution::Kind::normal, Distribution::Kind::uniform, Distribution::Kind::triangular}) {
    const auto value = axis.find(words[static_cast<int>(kind)]);
    if (!value) continue;
    const auto numbers = read_numbers(*value, kind == Distribution::Kind::triangular ? 3 : 2, dimension);
    if (numbers) made = checked(*value, kind, *numbers);
  }
  const auto cut = axis.find("truncate");
  if (!cut || !made) return made;
  const auto ends = read_ends(*cut, dimension);
  if (!ends) return std::nullopt;
  const auto [low, high] = support(*made);
  if (ends->first >= high || ends->second <= low) {
    cut->fail("out-of-range", fmt::format("all values are between {:.6g} and {:.6g}: nothing is left", low, high));
    return std::nullopt;
  }
  made->low = ends->first;
  made->high = ends->second;
  return made;
}

}  // namespace freeplay
