#include "results/singular_judgement.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/index.h"
#include "model/element_name.h"

namespace freeplay {
namespace {

constexpr double of_beside = 1.5;     // force close to a singular position by that not quite so close
constexpr double of_noise = 0.02;     // by which a little farther from it a force may be another one
constexpr double of_last_step = 0.1;  // smooth change of such a force in a step, by the largest

/// The largest force of a joint's rows in the table, which may lie inside a step; its time is not known.
NearForce largest_of_rows(const RunRecord& record) {
  const LargestValues& largest = record.statistics.largest();
  NearForce most;
  for (std::size_t j = 0; j < record.model.joints.size(); ++j) {
    const JointElement& joint = record.model.joints[j];
    if (joint.layout.constraint_rows == 0 || joint.gear >= 0) continue;
    const std::size_t place = largest.places().force(static_cast<int>(j));
    const double force = std::max(largest.in_window()[place], largest.before()[place]);
    if (force > most.force) most = {.force = force, .joint = static_cast<int>(j)};
  }
  return most;
}

/// The joint whose force in the table is that of a row very close to a singular position, and most another one a little
/// farther from it; -1: none.
int noisiest_beside(const RunRecord& record) {
  const LargestValues& largest = record.statistics.largest();
  int found = -1;
  double most = of_noise;
  for (std::size_t j = 0; j < record.extremes.noisy.size(); ++j) {
    const RunExtremes::NoisyForce& noisy = record.extremes.noisy[j];
    const std::size_t place = largest.places().force(static_cast<int>(j));
    const double shown = std::max(largest.in_window()[place], largest.before()[place]);
    if (!(noisy.force >= shown && noisy.off > most * noisy.force)) continue;
    found = static_cast<int>(j);
    most = noisy.off / noisy.force;
  }
  return found;
}

void judge_noise_beside(const RunRecord& record, Verdict& verdict) {
  const int j = noisiest_beside(record);
  if (j < 0) return;
  const RunExtremes::NoisyForce& noisy = record.extremes.noisy[at(j)];
  const std::string joint = written_name(record.model.joints[at(j)]);
  verdict.add({.id = "singular-position",
               .level = Trust::doubtful,
               .message = fmt::format("the mechanism comes so close to a singular position of its constraints that "
                                      "roundings of positions make forces: {} has {:.4g} N at t = {:.6g} s, and {:.4g} "
                                      "N a little farther from it",
                                      joint, noisy.force, noisy.time, noisy.force - noisy.off),
               .element = joint,
               .value = noisy.off,
               .limit = of_noise * noisy.force});
}

}  // namespace

// Multipliers are quotients of two vanishing numbers there. Where the position is one of the chosen rows alone, as of
// redundant constraints, forces pass it smoothly.
void judge_singular(const RunRecord& record, Verdict& verdict) {
  const RunExtremes& seen = record.extremes;
  if (!(seen.passed_at < unbounded)) return judge_noise_beside(record, verdict);
  // A long step may pass the position and end a little beside it, where forces are still far above all others.
  NearForce near = seen.near.force > of_beside * seen.beside.force ? seen.near : seen.beside;
  const bool above = near.force > seen.beside.force && seen.beside.force > 0.0;
  double usual = above ? seen.beside.force : seen.away.force;
  // So may a row inside such a step, of which its ends show nothing.
  const NearForce most = largest_of_rows(record);
  const bool inside = most.force > of_beside * seen.row_force;
  if (inside && !(near.force > of_beside * usual)) usual = seen.row_force;
  if (inside) near = most;
  if (near.joint < 0 || !(near.force > of_beside * usual)) return judge_noise_beside(record, verdict);
  // A quotient of roundings is another one at each step: what grows little by little is the force of the motion.
  if (!inside && seen.near_change < of_last_step * near.force) return judge_noise_beside(record, verdict);
  const std::string joint = written_name(record.model.joints[at(near.joint)]);
  verdict.add({.id = "singular-position",
               .level = Trust::doubtful,
               .message = fmt::format("the mechanism went through a singular position of its constraints, first at t = "
                                      "{:.6g} s: beside one, forces hang on where steps and rows end, whatever their "
                                      "length; {} has {:.4g} N{}",
                                      seen.passed_at, joint, near.force,
                                      inside ? std::string() : fmt::format(" at t = {:.6g} s", near.time)),
               .element = joint,
               .value = near.force,
               .limit = of_beside * usual});
}

}  // namespace freeplay
