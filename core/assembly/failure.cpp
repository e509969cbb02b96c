#include "assembly/failure.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "assembly/drive_range.h"
#include "assembly/loop_gap.h"
#include "assembly/loop_sides.h"
#include "base/error.h"
#include "base/index.h"
#include "model/path_pose.h"

namespace freeplay {
namespace {

/// "; the path of 'tool' begins at x = 1 m, y = 0 m", of every path.
std::string begin_of_paths(const ClosedMechanism& mechanism) {
  const Model& model = mechanism.model();
  const std::size_t lengths = model.space == Space::spatial ? 3 : 2;
  std::string text;
  for (std::size_t k = 0; k < model.kinematics.size(); ++k) {
    const InverseKinematics& entry = model.kinematics[k];
    PathPose pose;
    MotionFault ignored;
    if (!mechanism.system.motions().path(static_cast<int>(k), model.settings.start, pose, ignored)) continue;
    std::string place;
    for (std::size_t i = 0; i < lengths; ++i) {
      if (!entry.path.gives(i)) continue;
      place += fmt::format("{} {} = {:.6g} m", place.empty() ? "" : ",", path_words(model.space)[i], pose[i].value);
    }
    if (!place.empty()) text += fmt::format("; the path of '{}' begins at{}: is that within reach?", entry.name, place);
  }
  return text;
}

void refuse_open_path(const ClosedMechanism& mechanism, const ClosedMechanism::Rows& rows) {
  for (std::size_t i = 0; i < rows.row.size(); ++i) {
    if (rows.path[i] < 0 ||
        std::abs(rows.residual[static_cast<Eigen::Index>(i)]) <= mechanism.model().settings.assembly_tolerance)
      continue;
    const InverseKinematics& entry = mechanism.model().kinematics[at(mechanism.paths[at(rows.path[i])].kinematics)];
    throw Error(Error::Category::input, "ik-unreachable",
                fmt::format("the mechanism cannot bring the frame of '{}' to its path at the start time {} s{}",
                            entry.name, mechanism.state.t(), begin_of_paths(mechanism)),
                entry.path_location,
                "if it is, give the bodies a `pose` closer to the wanted one; lengths without a unit are metres");
  }
}

/// Conditions for which there are no freedoms, as a slide in place of a pin makes one.
std::string too_many(const ClosedMechanism::Rows& rows) {
  const Eigen::Index over = rows.matrix.rows() - rows.matrix.cols();
  if (over <= 0) return {};
  return fmt::format("; joints, drivers and start values hold {} {} more than the bodies have", over,
                     over == 1 ? "freedom" : "freedoms");
}

}  // namespace

void throw_open(ClosedMechanism& mechanism, const ClosedMechanism::Rows& rows) {
  const Model& model = mechanism.model();
  const Layout& layout = mechanism.system.layout();
  double worst = -1.0;
  std::string text;
  Location location;
  const auto consider = [&](double gap, const std::string& words, const Location& place) {
    if (!(gap <= worst)) worst = gap, text = words, location = place;
  };
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const Slice slice = layout.rows(j);
    if (slice.size > 0 && !mechanism.held_row[at(slice.offset)]) continue;
    double gap = 0.0;
    for (int r = 0; r < slice.size; ++r) gap = std::hypot(gap, mechanism.e.phi[at(slice.offset + r)]);
    consider(gap, fmt::format("joint '{}' stays open by {:.6g} m", model.joints[at(j)].name, gap),
             model.joints[at(j)].location);
  }
  refuse_open_path(mechanism, rows);
  for (std::size_t i = 0; i < rows.row.size(); ++i) {
    const double gap = std::abs(rows.residual[static_cast<Eigen::Index>(i)]);
    if (rows.lead[i] >= 0) {
      const JointElement& joint = model.joints[at(rows.lead[i])];
      consider(gap,
               fmt::format("joint '{}' misses its start value by {}", joint.name,
                           words(gap, joint.ideal_layout().coordinate)),
               joint.location);
    }
  }
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const int r = layout.driver_row(d);
    if (r < 0 || !mechanism.held_row[at(r)]) continue;
    const double gap = std::abs(mechanism.e.phi[at(r)]);
    const Driver& driver = model.drivers[at(d)];
    const Coordinate kind = model.joints[at(driver.joint)].ideal_layout().coordinate;
    consider(gap, fmt::format("driver '{}' misses its value by {}", driver.name, words(gap, kind)), driver.location);
  }
  // A gap of rounding says that there is a position, which the start does not lead to.
  if (const std::optional<LoopGap> gap = loop_gap(mechanism); gap && gap->size > model.settings.assembly_tolerance) {
    const JointElement& joint = model.joints[at(gap->joint)];
    text = fmt::format("joint '{}' stays open by {:.6g} m with all others closed", joint.name, gap->size);
    location = joint.location;
    text += sides_of_loop(model, gap->joint);
  }
  if (const double far = farthest_body(mechanism); far > LoopGap::far_away * mechanism.system.size())
    text +=
        fmt::format("; it comes so near only with a body {:.3g} m away: check the directions of slides and slots", far);
  text += too_many(rows);
  if (const auto elsewhere = closes_elsewhere(mechanism)) text += "; " + *elsewhere;
  text += begin_of_paths(mechanism);
  throw Error(
      Error::Category::input, "assembly-failed", "the mechanism cannot be put together: " + text, location,
      model.space == Space::spatial
          ? "check lengths, axes of joints and start values, or give the bodies a `pose` closer to the wanted one"
          : "check lengths and start values, or give the bodies a `pose` closer to the wanted one");
}

}  // namespace freeplay
