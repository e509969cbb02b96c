#include "model/analysis_section.h"

#include "model/grid.h"
#include "model/kinematics_keys.h"

namespace freeplay {
namespace {

void check_grids(const CheckedValue& value) {
  MapReader map(value, "pose_grid");
  const auto x = map.find("x"), y = map.find("y"), angle = map.find("angle");
  if (x) check_grid(*x, dimension::length);
  if (y) check_grid(*y, dimension::length);
  if (angle) check_grid(*angle, dimension::angle);
  map.finish();
}

void check_error(const Draft& draft, const CheckedValue& value) {
  MapReader map(value, "error");
  const auto clearance = map.find("clearance");
  const auto input = map.find("input");
  if (clearance) {
    for (const CheckedValue& entry : entries_of(*clearance)) {
      entry.quantity(dimension::length, not_negative);
      if (draft.find_joint(entry.key(), draft.parts.front()) || draft.excused(entry.key())) continue;
      entry.fail_at_key("unknown-name", "unknown joint '" + entry.key() + "'",
                        nearest(entry.key(), draft.joints.names()));
    }
  }
  if (input) input->quantity(dimension::angle);
  map.finish();
}

}  // namespace

void check_analysis(Draft& draft, const CheckedValue& section) {
  MapReader map(section, "analysis");
  const Part& top = draft.parts.front();
  const auto frame = map.find("frame"), joints = map.find("joints"), elbow = map.find("elbow");
  const auto path = map.find("path"), time = map.find("time"), grid = map.find("grid"), error = map.find("error");
  std::optional<std::size_t> count;
  if (frame) draft.marker(*frame, top);
  if (joints) {
    const auto driven = draft.joint_list(*joints, top);
    if (driven) count = driven->size();
  }
  if (elbow) read_elbow(*elbow, count);
  if (path) read_path(*path);
  if (time) check_grid(*time, dimension::time);
  if (grid) check_grids(*grid);
  if (error) check_error(draft, *error);
  map.finish();
}

}  // namespace freeplay
