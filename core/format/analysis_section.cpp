#include "format/analysis_section.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/name_pattern.h"
#include "format/grid.h"
#include "format/kinematics_keys.h"
#include "model/path_pose.h"

namespace freeplay {
namespace {

/// By number of a pose: in the plane x, y, angle, in space x, y, z, roll, pitch, yaw.
void read_pose_grid(AnalysisSection& analysis, const CheckedValue& value) {
  MapReader map(value, "pose_grid");
  const Space space = value.in_space() ? Space::spatial : Space::planar,
              other = value.in_space() ? Space::planar : Space::spatial;
  const std::size_t lengths = value.in_space() ? 3 : 2;
  const auto words = path_words(space);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto axis = map.find(words[i]);
    std::optional<Dimension> dimension = i < lengths ? dimension::length : dimension::angle;
    if (axis) analysis.grid[i] = read_grid(*axis, dimension);
  }
  for (const char* word : path_words(other)) {
    const bool shared = std::ranges::any_of(words, [&](std::string_view own) { return own == word; });
    const auto axis = shared ? std::nullopt : map.find(word);
    if (!axis) continue;
    axis->fail_at_key("type-space",
                      fmt::format("'{}' is no number of a pose {}, which has {}", word,
                                  value.in_space() ? "in space" : "in the plane", fmt::join(words, ", ")));
  }
  map.finish();
}

/// The same ends for several joints. A pattern passes over joints without a coordinate.
void read_ends(Draft& draft, const CheckedValue& entry, const std::vector<CheckedValue>& items,
               const std::vector<int>& joints) {
  bool some = false;
  for (const int j : joints) {
    const std::size_t joint = static_cast<std::size_t>(j);
    if (!draft.joint_usable[joint]) return;
    const Coordinate coordinate = draft.model.joints[joint].ideal_layout().coordinate;
    if (coordinate == Coordinate::none || draft.model.joints[joint].gear >= 0) continue;
    some = true;
    const Dimension& dimension = coordinate == Coordinate::angle ? dimension::angle : dimension::length;
    const auto lowest = items[0].quantity(dimension), highest = items[1].quantity(dimension);
    if (!lowest || !highest) return;
    if (!(*lowest < *highest)) {
      return entry.fail("out-of-range",
                        "'" + entry.path() + "' must be [lowest, highest], the lowest below the highest");
    }
    draft.model.analysis.limits.push_back({j, *lowest, *highest});
  }
  if (some) return;
  entry.fail_at_key("wrong-type", "'" + entry.key() + "' has no coordinate that could have ends");
}

/// `limits: {JOINT: [lowest, highest]}`, JOINT a name or a pattern.
void read_limits(Draft& draft, const CheckedValue& value) {
  const Part& top = draft.parts.front();
  for (const CheckedValue& entry : entries_of(value, MapNames::references)) {
    std::vector<int> joints;
    if (is_pattern(entry.key())) {
      joints = matching(draft, draft.joints, entry, entry.key(), top);
      if (joints.empty() && !draft.excused(entry.key())) {
        entry.fail_at_key("unknown-name", "no joint matches the pattern '" + entry.key() + "'");
      }
    } else if (const auto joint = draft.find_joint(entry.key(), top)) {
      joints.push_back(*joint);
    } else {
      draft.unknown_joint(entry, entry.key(), top, true);
    }
    const auto items = entry.list(2);
    if (!items || joints.empty()) continue;
    read_ends(draft, entry, *items, joints);
  }
}

/// An angle; of slides a length.
void read_input_error(AnalysisSection& analysis, const CheckedValue& value) {
  const std::optional<Quantity> error = value.any_quantity();
  if (!error) return;
  if (!fits(*error, dimension::angle) && !fits(*error, dimension::length)) {
    value.fail("dimension-mismatch", "'" + value.path() + "' must be of angle, or of length for slides, not of " +
                                         dimension_name(error->dimension));
    return;
  }
  if (!not_negative.contains(error->value)) {
    value.fail("out-of-range", "'" + value.path() + "' must be " + not_negative.text("1"));
    return;
  }
  analysis.input = error->value;
  analysis.input_location = value.location();
  analysis.input_is_length = error->dimension == dimension::length;
}

void read_error(Draft& draft, const CheckedValue& value) {
  MapReader map(value, "error");
  const auto clearance = map.find("clearance");
  const auto input = map.find("input");
  AnalysisSection& analysis = draft.model.analysis;
  if (clearance) {
    for (const CheckedValue& entry : entries_of(*clearance, MapNames::references)) {
      const std::optional<double> radius = entry.quantity(dimension::length, not_negative);
      const std::optional<int> joint = draft.find_joint(entry.key(), draft.parts.front());
      if (joint && radius) analysis.clearance.emplace_back(*joint, *radius);
      if (!joint) draft.unknown_joint(entry, entry.key(), draft.parts.front(), true);
    }
  }
  if (input) read_input_error(analysis, *input);
  map.finish();
}

}  // namespace

void read_analysis(Draft& draft, const CheckedValue& section) {
  MapReader map(section, "analysis");
  const Part& top = draft.parts.front();
  AnalysisSection& analysis = draft.model.analysis;
  const auto frame = map.find("frame"), joints = map.find("joints"), time = map.find("time"), error = map.find("error");
  auto elbow = map.find("elbow");
  const auto path = map.find("path"), grid = map.find("grid"), limits = map.find("limits");
  std::optional<std::size_t> count;
  if (elbow && elbow->in_space()) {
    elbow->fail_at_key("type-space", "working modes work in planar models only");
    elbow.reset();
  }
  if (frame) {
    analysis.frame_location = frame->location();
    analysis.marker = draft.marker(*frame, top).value_or(0);
  }
  if (joints) {
    const auto driven = draft.joint_list(*joints, top);
    if (driven) count = driven->size();
    analysis.joints_location = joints->location();
    analysis.joints = driven.value_or(std::vector<int>{});
  }
  if (elbow) {
    analysis.elbow_location = elbow->location();
    analysis.elbow = read_elbow(*elbow, count).value_or(std::vector<int>{});
  }
  if (path) {
    const auto components = read_path(draft, *path, false);
    analysis.path_location = path->location();
    if (components) analysis.path = *components;
  }
  std::optional<Dimension> seconds = dimension::time;
  if (time) analysis.time = read_grid(*time, seconds);
  if (grid) {
    analysis.grid_location = grid->key_location();
    read_pose_grid(analysis, *grid);
  }
  if (limits) read_limits(draft, *limits);
  if (error) read_error(draft, *error);
  map.finish();
}

}  // namespace freeplay
