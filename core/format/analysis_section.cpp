#include "format/analysis_section.h"

#include <cmath>
#include <utility>

#include "format/grid.h"
#include "format/kinematics_keys.h"

namespace freeplay {
namespace {

void read_pose_grid(AnalysisSection& analysis, const CheckedValue& value) {
  MapReader map(value, "pose_grid");
  constexpr std::array<const char*, 3> keys{"x", "y", "angle"};
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto axis = map.find(keys[i]);
    std::optional<Dimension> dimension = i < 2 ? dimension::length : dimension::angle;
    if (axis) analysis.grid[i] = read_grid(*axis, dimension);
  }
  map.finish();
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
    for (const CheckedValue& entry : entries_of(*clearance)) {
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
  auto elbow = map.find("elbow"), path = map.find("path"), grid = map.find("grid");
  std::optional<std::size_t> count;
  for (const auto& [value, what] : {std::pair{&grid, "grids"}, {&elbow, "working modes"}}) {
    if (!*value || !(*value)->in_space()) continue;
    (*value)->fail_at_key("type-space", std::string(what) + " work in planar models only");
    value->reset();
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
    const auto components = read_path(draft, *path);
    analysis.path_location = path->location();
    if (components) analysis.path = *components;
  }
  std::optional<Dimension> seconds = dimension::time;
  if (time) analysis.time = read_grid(*time, seconds);
  if (grid) read_pose_grid(analysis, *grid);
  if (error) read_error(draft, *error);
  map.finish();
}

}  // namespace freeplay
