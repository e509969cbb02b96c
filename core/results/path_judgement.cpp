#include "results/path_judgement.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/index.h"

namespace freeplay {
namespace {

constexpr double exact_by_size = 1e-6;    // of the model's size: of ideal joints
constexpr double levers_of_play = 100.0;  // by which links make more of all clearances together
constexpr double elastic_by_size = 1e-2;  // of the model's size, where something yields
constexpr double least_arm = 0.1;         // of the model's size: a place missed at it makes an angle

/// How far play and elastic elements may take a frame from its path [m].
double room_of(const RunRecord& record) {
  double play = 0.0;
  bool yields = false;
  for (const JointElement& joint : record.model.joints) {
    if (joint.has_play) play += joint.layout.clearance;
    // What holds without rows holds by yielding.
    yields = yields || (joint.has_play && !(joint.layout.clearance > 0.0)) || joint.layout.constraint_rows == 0;
  }
  const double size = record.extremes.size;
  return std::max({exact_by_size * size, levers_of_play * play, yields ? elastic_by_size * size : 0.0});
}

}  // namespace

void judge_paths(const RunRecord& record, Verdict& verdict) {
  if (record.model.kinematics.empty() || record.outcome.status == RunStatus::failed) return;
  const double room = room_of(record), room_of_angle = room / (least_arm * record.extremes.size);
  const LargestValues& largest = record.statistics.largest();
  const auto most = [&](std::size_t place) { return std::fmax(largest.in_window()[place], largest.before()[place]); };
  for (int p = 0; p < static_cast<int>(record.model.kinematics.size()); ++p) {
    const double off = most(largest.places().position_error(p)), turned = most(largest.places().angle_error(p));
    const bool far = off > room;
    if (!far && !(turned > room_of_angle)) continue;
    const std::string driver = fmt::format("driver '{}'", record.model.kinematics[at(p)].name);
    const std::string missed = far ? fmt::format("{:.3g} m", off) : fmt::format("{:.3g} rad", turned);
    verdict.add({.id = "path-missed",
                 .level = Trust::doubtful,
                 .message = fmt::format("{}: its frame is up to {} away from the path, more than play explains: the "
                                        "driven joints do not hold it there; check whether 'joints' names all of them",
                                        driver, missed),
                 .element = driver,
                 .value = far ? off : turned,
                 .limit = far ? room : room_of_angle});
  }
}

}  // namespace freeplay
