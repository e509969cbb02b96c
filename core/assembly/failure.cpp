#include "assembly/failure.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "assembly/contradiction.h"
#include "assembly/drive_range.h"
#include "assembly/loop_gap.h"
#include "assembly/loop_sides.h"
#include "base/error.h"
#include "base/index.h"
#include "model/path_pose.h"

namespace freeplay {
namespace {

constexpr std::size_t most_named = 12;  // conditions

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

/// What stays open most, and where it stands in the file.
struct OpenElement {
  double gap = -1.0;
  std::string text;
  Location location;
  int joint = -1;  ///< that stays open; -1 for a value that is missed
  void consider(double size, const std::string& words, const Location& place, int open_joint = -1) {
    if (!(size <= gap)) gap = size, text = words, location = place, joint = open_joint;
  }
};

OpenElement widest_open(const ClosedMechanism& mechanism, const ClosedMechanism::Rows& rows) {
  const Model& model = mechanism.model();
  const Layout& layout = mechanism.system.layout();
  OpenElement open;
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const Slice slice = layout.rows(j);
    if (slice.size > 0 && !mechanism.held_row[at(slice.offset)]) continue;
    const JointMiss miss = miss_of(j, mechanism, rows);
    open.consider(std::hypot(miss.length, miss.angle),
                  fmt::format("joint '{}' stays open by {}", model.joints[at(j)].name,
                              words(miss, model.settings.assembly_tolerance)),
                  model.joints[at(j)].location, j);
  }
  for (std::size_t i = 0; i < rows.row.size(); ++i) {
    if (rows.lead[i] < 0) continue;
    const JointElement& joint = model.joints[at(rows.lead[i])];
    const double gap = std::abs(rows.residual[static_cast<Eigen::Index>(i)]);
    open.consider(
        gap,
        fmt::format("joint '{}' misses its start value by {}", joint.name, words(gap, joint.ideal_layout().coordinate)),
        joint.location);
  }
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const int r = layout.driver_row(d);
    if (r < 0 || !mechanism.held_row[at(r)]) continue;
    const double gap = std::abs(mechanism.e.phi[at(r)]);
    const Driver& driver = model.drivers[at(d)];
    const Coordinate kind = model.joints[at(driver.joint)].ideal_layout().coordinate;
    open.consider(gap, fmt::format("driver '{}' misses its value by {}", driver.name, words(gap, kind)),
                  driver.location);
  }
  return open;
}

/// "; the sides of its loop are ...", "; joints ... contradict each other": of what cannot be put together by itself.
/// Where that is nothing of what `open` says, it says this instead.
std::string why_open(ClosedMechanism& mechanism, const std::optional<LoopGap>& gap, OpenElement& open) {
  const Model& model = mechanism.model();
  if (const auto loop = overlong_loop(model, gap ? gap->joint : -1)) {
    if (std::ranges::count(loop->joints, open.joint) > 0)
      return (loop->one_side ? "; its loop has one side, " : "; the sides of its loop are ") + loop->text;
    open.text = (loop->one_side ? "a loop has one side, " : "a loop cannot close; its sides are ") + loop->text;
    open.location = model.joints[at(loop->joints.front())].location;
    return {};
  }
  const double size = mechanism.system.size();
  const double missed = gap ? std::hypot(gap->miss.length / size, gap->miss.angle) : open.gap / std::max(1.0, size);
  const std::vector<Condition> conditions = contradiction(mechanism, gap ? gap->joint : -1, missed);
  if (conditions.size() < 2 || conditions.size() > most_named) return {};
  const auto is_open = [&](const Condition& one) {
    return one.kind == Condition::Kind::joint && one.index == open.joint;
  };
  const std::string text = words(conditions, mechanism);
  if (std::ranges::any_of(conditions, is_open)) return "; " + text;
  open.text = text;
  if (conditions.front().kind == Condition::Kind::joint)
    open.location = model.joints[at(conditions.front().index)].location;
  return {};
}

}  // namespace

void throw_open(ClosedMechanism& mechanism, const ClosedMechanism::Rows& rows) {
  const Model& model = mechanism.model();
  refuse_open_path(mechanism, rows);
  OpenElement open = widest_open(mechanism, rows);
  std::optional<LoopGap> gap = loop_gap(mechanism);
  // A gap of rounding says that there is a position, which the start does not lead to.
  const bool closes = gap && gap->size <= model.settings.assembly_tolerance;
  if (gap && !closes) {
    const JointElement& joint = model.joints[at(gap->joint)];
    open.text = fmt::format("joint '{}' stays open by {} with all others closed", joint.name,
                            words(gap->miss, model.settings.assembly_tolerance));
    open.location = joint.location;
    open.joint = gap->joint;
  }
  std::string more = closes ? std::string{} : why_open(mechanism, gap, open);
  if (const double far = farthest_body(mechanism); far > LoopGap::far_away * mechanism.system.size())
    more +=
        fmt::format("; it comes so near only with a body {:.3g} m away: check the directions of slides and slots", far);
  more += too_many(rows);
  if (const auto elsewhere = closes_elsewhere(mechanism)) more += "; " + *elsewhere;
  more += begin_of_paths(mechanism);
  throw Error(
      Error::Category::input, "assembly-failed", "the mechanism cannot be put together: " + open.text + more,
      open.location,
      model.space == Space::spatial
          ? "check lengths, axes of joints and start values, or give the bodies a `pose` closer to the wanted one"
          : "check lengths and start values, or give the bodies a `pose` closer to the wanted one");
}

}  // namespace freeplay
