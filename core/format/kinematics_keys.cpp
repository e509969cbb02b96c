#include "format/kinematics_keys.h"

#include <span>
#include <string>

#include "format/doubtful_number.h"
#include "format/doubtful_threshold.h"
#include "format/pose_table.h"
#include "model/path_pose.h"

namespace freeplay {
namespace {

std::optional<int> read_mode(const CheckedValue& value) {
  const std::optional<long> mode = value.integer(-1, 1);
  if (!mode || *mode != 0) return mode ? std::optional<int>(static_cast<int>(*mode)) : std::nullopt;
  value.fail("out-of-range", "'" + value.path() + "' must be 1 or -1, not 0");
  return std::nullopt;
}

/// `30` where 30 degrees are meant.
void doubt_first_angle(const CheckedValue& written, const Expression& angle) {
  Jet at_zero;
  EvaluationFailure ignored;
  if (angle.evaluate(0.0, at_zero, ignored) && doubt_angle(written, at_zero.value)) return;
  doubt_bare_term(written);
}

/// "'x', 'y' and 'angle'"
std::string any_of_words(std::span<const char* const> words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    out += std::string(i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + "'" + words[i] + "'";
  }
  return out;
}

}  // namespace

std::optional<FramePath> read_path(Draft& draft, const CheckedValue& value, bool in_run) {
  if (!value.node().is_scalar() && !value.node().is_map()) {
    value.wrong_type("the path of a file or a map");
    return std::nullopt;
  }
  MapReader map = value.node().is_scalar() ? MapReader::empty(value) : MapReader(value, "path");
  FramePath path;
  const bool in_space = value.in_space();
  const std::span<const char* const> keys = path_words(in_space ? Space::spatial : Space::planar);
  if (value.node().is_scalar() || map.has("file")) {
    for (const char* key : keys) {
      map.find(key);
      map.conflict("file", key);
    }
    return read_pose_table(draft, value, map);
  }
  for (const char* key : {"time", "time_unit", "unit", "angle_unit", "interpolation", "ends", "outside"}) {
    map.refuse(key, "only with 'file'");
  }
  bool good = map.good();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto component = map.find(keys[i]);
    if (!component) continue;
    const bool turns = i >= (in_space ? 3U : 2U);
    path.functions[i] = component->time_function(turns ? dimension::angle : dimension::length);
    path.text[i] = component->node().text;
    if (turns && path.functions[i]) doubt_first_angle(*component, *path.functions[i]);
    if (!turns) doubt_bare_place(*component, draft.length_scale);
    if (in_run && path.functions[i]) draft.timed.push_back({*component, path.functions[i]->time_parts(), false, false});
    good = good && path.functions[i].has_value();
  }
  if (in_space) {
    map.refuse("angle", "in space 'roll', 'pitch' and 'yaw'");
  } else {
    for (const char* spatial : {"z", "roll", "pitch", "yaw"}) map.refuse(spatial, "only in spatial models");
  }
  map.finish();
  if (good && !path.gives_any()) {
    value.fail_at_key("missing-key", "'" + value.path() + "' needs at least one of " + any_of_words(keys));
  }
  if (!good || !path.gives_any()) return std::nullopt;
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
