#include "format/sweep_section.h"

#include "base/name_pattern.h"
#include "format/grid.h"

namespace freeplay {
namespace {

std::optional<Dimension> dimension_of(const Quantity* declared) {
  if (declared == nullptr || declared->kind != DimensionKind::dimensioned) return std::nullopt;
  return declared->dimension;
}

void check_axes(const CheckedValue& value, const ParameterScope& parameters, bool side_by_side) {
  long points = 1;
  std::optional<long> first;
  for (const CheckedValue& axis : entries_of(value)) {
    if (!parameters.declares(axis.key())) {
      axis.fail_at_key("unknown-name", "unknown parameter '" + axis.key() + "'",
                       nearest(axis.key(), parameters.names()));
    }
    const std::optional<GridValues> grid = read_grid(axis, dimension_of(parameters.find(axis.key())));
    if (!grid) continue;
    const std::optional<long> count = grid->count;
    if (side_by_side && first && *first != *count) {
      axis.fail("wrong-length", "parameters side by side need grids of equal length");
    }
    if (!first) first = count;
    if (side_by_side || points > largest_grid) continue;
    points *= *count;  // at most 10^16
    if (points > largest_grid) value.fail_at_key("too-large", "a sweep has at most 10^8 points");
  }
}

void check_ideal(const Draft& draft, const CheckedValue& value) {
  const auto items = value.one_or_list();
  if (!items) return;
  for (const CheckedValue& item : *items) {
    const auto name = item.string();
    if (!name || *name == "all" || draft.excused(*name)) continue;
    if (is_pattern(*name) && !matching(draft, draft.joints, item, *name, draft.parts.front()).empty()) continue;
    if (draft.find_joint(*name, draft.parts.front())) continue;
    item.fail("unknown-name", "unknown joint '" + *name + "'", nearest(*name, draft.joints.names()));
  }
}

void check_reducer(const CheckedValue& entry) {
  Draft::check_name(entry);
  MapReader map(entry, "reducer");
  const auto channel = map.require("channel");
  const auto reduce = map.require("reduce");
  const auto from = map.find("from");
  if (channel) channel->string();
  if (reduce) reduce->word({"max", "min", "absmax", "mean", "rms", "final", "peak-to-peak"});
  if (from) from->quantity(dimension::time);
  map.finish();
}

}  // namespace

void check_sweep(Draft& draft, const CheckedValue& section, const ParameterScope& parameters) {
  MapReader map(section, "sweep");
  const auto axes = map.require("parameters");
  const auto combine = map.find("combine");
  const auto ideal = map.find("ideal");
  const auto reducers = map.find("reducers");
  const std::optional<int> word = combine ? combine->word({"grid", "zip"}) : std::optional<int>(0);
  if (axes) check_axes(*axes, parameters, word == std::optional<int>(1));
  if (ideal) check_ideal(draft, *ideal);
  if (reducers) {
    for (const CheckedValue& entry : entries_of(*reducers)) check_reducer(entry);
  }
  map.finish();
}

}  // namespace freeplay
