#include "results/touch_judgement.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/index.h"
#include "model/element_name.h"

namespace freeplay {
namespace {

constexpr double rounding = 1e-9;  // [N]

/// With what `discard` leaves out.
bool ever_pressed(const RunRecord& record, int j) {
  const LargestValues& largest = record.statistics.largest();
  const std::size_t force = largest.places().normal_force(j);
  return record.statistics.joint(j).max_normal_force > rounding || largest.before()[force] > rounding;
}

}  // namespace

void judge_touch(const RunRecord& record, Verdict& verdict) {
  if (record.outcome.status != RunStatus::completed || !record.statistics.any()) return;
  for (int j = 0; j < static_cast<int>(record.model.joints.size()); ++j) {
    const JointElement& joint = record.model.joints[at(j)];
    // A journal in the middle of its bearing may fly for long.
    if (!joint.has_play || joint.layout.clearance > 0.0 || !has_contact_statistics(record.channels.joints[at(j)]) ||
        ever_pressed(record, j))
      continue;
    const std::string name = written_name(joint);
    const auto judged = [&](const TrustReason& reason) { return reason.element == name; };
    if (std::ranges::any_of(verdict.reasons(), judged)) continue;
    verdict.add({.id = "never-touches",
                 .level = Trust::doubtful,
                 .message = fmt::format("{}: its surfaces never touch in the whole run, as if it were not there: check "
                                        "where it starts, its sides, and what was to press them together",
                                        name),
                 .element = name});
  }
}

}  // namespace freeplay
