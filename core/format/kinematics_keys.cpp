#include "format/kinematics_keys.h"

namespace freeplay {
namespace {

std::optional<int> read_mode(const CheckedValue& value) {
  const std::optional<long> mode = value.integer(-1, 1);
  if (!mode || *mode != 0) return mode ? std::optional<int>(static_cast<int>(*mode)) : std::nullopt;
  value.fail("out-of-range", "'" + value.path() + "' must be 1 or -1, not 0");
  return std::nullopt;
}

}  // namespace

std::optional<std::array<std::optional<Expression>, 3>> read_path(const CheckedValue& value) {
  MapReader map(value, "path");
  std::array<std::optional<Expression>, 3> path;
  constexpr std::array<const char*, 3> keys{"x", "y", "angle"};
  bool good = map.good(), any = false;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto component = map.find(keys[i]);
    if (!component) continue;
    any = true;
    path[i] = component->time_function(i < 2 ? dimension::length : dimension::angle);
    good = good && path[i].has_value();
  }
  for (const char* spatial : {"z", "roll", "pitch", "yaw"}) map.refuse(spatial, "only in spatial models");
  map.finish();
  if (map.good() && !any) {
    value.fail_at_key("missing-key", "'" + value.path() + "' needs at least one of 'x', 'y' and 'angle'");
  }
  if (!good || !any) return std::nullopt;
  return path;
}

std::optional<std::vector<int>> read_elbow(const CheckedValue& value, std::optional<std::size_t> count) {
  if (!value.node().is_list()) {
    const std::optional<int> mode = read_mode(value);
    if (!mode) return std::nullopt;
    return std::vector<int>(count.value_or(1), *mode);
  }
  const auto items = count ? value.list(*count) : value.list();
  if (!items) return std::nullopt;
  std::vector<int> modes;
  for (const CheckedValue& item : *items) {
    if (const std::optional<int> mode = read_mode(item)) modes.push_back(*mode);
  }
  if (modes.size() != items->size()) return std::nullopt;
  return modes;
}

}  // namespace freeplay
