#include "format/arc_keys.h"

#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "format/map_reader.h"
#include "model/arc_curve.h"

namespace freeplay {
namespace {

constexpr std::size_t most_arcs = 1000;

/// [x, y, radius] or [x, y].
std::optional<Arc> read_arc(const CheckedValue& written) {
  const auto numbers = written.list();
  if (!numbers) return std::nullopt;
  if (numbers->size() < 2 || numbers->size() > 3) {
    written.fail("wrong-length", "'" + written.path() + "' must be [x, y, radius], or [x, y] for an end");
    return std::nullopt;
  }
  double found[3] = {};
  for (std::size_t i = 0; i < numbers->size(); ++i) {
    const auto number = (*numbers)[i].quantity(dimension::length);
    if (!number) return std::nullopt;
    found[i] = *number;
  }
  return Arc{{found[0], found[1]}, found[2]};
}

}  // namespace

bool read_arcs(const CheckedValue& written, const Dimension& of_x, const Dimension& of_value, ParameterValue& value) {
  MapReader map(written, "arcs");
  const auto list = map.require("arcs"), roller = map.find("roller");
  map.finish();
  const bool closed = of_x == dimension::angle;
  if (!(of_value == dimension::length) || !(closed || of_x == dimension::length)) {
    written.fail("wrong-type", "'arcs' are for a curve in the plane, which '" + written.path() + "' is not");
    return false;
  }
  const auto items = list ? list->list() : std::nullopt;
  const auto radius = roller ? roller->quantity(dimension::length) : std::optional<double>(0.0);
  if (!items || !radius) return false;
  const std::size_t least = closed ? 1 : 2;
  if (items->size() < least || items->size() > most_arcs) {
    list->fail(items->size() < least ? "wrong-length" : "too-large",
               fmt::format("a curve has from {} to {} arcs", least, most_arcs));
    return false;
  }
  std::vector<Arc> arcs;
  for (const CheckedValue& item : *items) {
    const auto arc = read_arc(item);
    if (!arc) return false;
    arcs.push_back(*arc);
  }
  auto made = ArcCurve::make(std::move(arcs), closed, *radius);
  if (const auto* flaw = std::get_if<ArcCurve::Flaw>(&made)) {
    (*items)[flaw->arc].fail("bad-curve", flaw->reason);
    return false;
  }
  set_arc_formula(value, std::get<ArcCurve>(std::move(made)));
  return true;
}

}  // namespace freeplay
