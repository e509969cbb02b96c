// Simulation: what a run holds against its own numbers while it goes on.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "assembly/drive_range.h"
#include "base/index.h"
#include "run/likely_cause.h"
#include "run/simulation_impl.h"

namespace freeplay {
namespace {
// Whether the bodies of a joint hang together without it, so that others may hold what it should.
bool in_a_loop(const Model& model, int without) {
  const std::size_t bodies = model.bodies.size();  // the last place is ground's
  std::vector<std::size_t> group(bodies + 1);
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto root = [&](int marker) {
    const BodyId body = model.markers[at(marker)].body;
    std::size_t i = body == ground ? bodies : at(body);
    while (group[i] != i) i = group[i];
    return i;
  };
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointElement& joint = model.joints[at(j)];
    if (j != without && joint.gear < 0) group[root(joint.marker_a)] = root(joint.marker_b);
  }
  return root(model.joints[at(without)].marker_a) == root(model.joints[at(without)].marker_b);
}

constexpr std::string_view cause_words = "; likely cause: ";
}  // namespace

// False where the row shows that going on makes no sense.
bool Simulation::Impl::watch_row(double dt) {
  watch.add_regularity(solver.regularity(), accepted.t());
  if (torn_from && accepted.t() >= *torn_from) return fail(4, "the mechanism is torn apart");
  if (!row_is_known && !watch.is_due(e_accepted)) return true;
  if (!know_row()) return false;
  const int joint = watch.add(row, e_accepted);
  // A look at the drivers takes longer than many steps, so it waits until something is wrong.
  if (!torn_from && watch.deeper_than_play()) torn_from = out_of_reach_from(all_bodies, first_start.state);
  if (joint < 0) return true;
  TrustReason reason = watch.why(joint, row);
  const std::string cause = likely_cause(system, e_accepted, {accepted.t(), adaptive ? 0.0 : dt, joint, first_forces});
  if (!cause.empty()) reason.message += std::string(cause_words) + cause;
  fail(4, reason.message);
  outcome.doubts.push_back(std::move(reason));
  return false;
}

// Once for each joint; the text is made when the run is over.
bool Simulation::Impl::note_warnings() {
  for (const ForceBlock& block : system.force_blocks()) {
    Warning& warning = joint_warnings[at(block.joint)];
    if (warning.text != nullptr || system.rest(block.joint).now) continue;
    const Point here = point(accepted);
    Fault fault;
    if (!system.joint(block.joint).warning(system.input(block.joint, here, e_accepted), warning.text, fault.message)) {
      fault.kind = Fault::Kind::plugin;
      fault.joint = block.joint;
      return fail_with(fault, accepted.t());
    }
    if (warning.text == nullptr) continue;
    if (!know_row()) return false;
    warning.time = accepted.t();
    std::copy_n(row.begin() + channels.joints[at(block.joint)].own, system.joint_layout(block.joint).channels.size,
                warning_values.begin() + static_cast<std::ptrdiff_t>(warning.values));
  }
  return true;
}

// A contact begins where its function leaves zero in the declared direction. One that is past it from the start, and is
// declared to fall, can only be told when the bodies part: with error control the contact then never begins.
void Simulation::Impl::note_event_directions() {
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const Span<const Event> declared = system.joint_layout(j).events;
    std::vector<double> value(declared.size), rate(declared.size);
    Message message;
    const JointInput in = system.input(j, point(accepted), e_accepted);
    if (declared.empty() ||
        !system.joint(j).events(in, {value.data(), value.size()}, {rate.data(), rate.size()}, message))
      continue;
    for (std::size_t i = 0; i < declared.size; ++i) {
      if (!std::string_view(declared[i].name).ends_with("contact_begin")) continue;
      if (declared[i].crossing == Crossing::rising || !(value[i] < -StepEvents::tolerance)) continue;
      const std::string joint = fmt::format("joint '{}'", model.joints[at(j)].name);
      outcome.doubts.push_back(
          {.id = "event-direction",
           .level = adaptive ? Trust::bad : Trust::doubtful,
           .message = fmt::format("{}: its event '{}' is declared to fall through zero, but is {:.3g} at the start and "
                                  "was not told: contacts are missed if it rises when they begin",
                                  joint, declared[i].name, value[i]),
           .element = joint});
    }
  }
}

void Simulation::Impl::note_first_forces() {
  first_forces.assign(model.joints.size(), 0.0);
  for (const ForceBlock& block : system.force_blocks()) {
    const double* force = &e_accepted->wrench[12 * at(block.joint) + 6];
    first_forces[at(block.joint)] = std::hypot(force[0], force[1], force[2]);
  }
}

// Where a driver asks for what the mechanism cannot do, what failed there says little: neither does what was blamed.
void Simulation::Impl::explain_dead_point() {
  if (outcome.status != RunStatus::failed || outcome.exit_code != 4) return;
  auto why = why_out_of_reach(all_bodies, first_start.state, outcome.time);
  if (!why) return;
  outcome.reason = std::move(*why);
  for (TrustReason& reason : outcome.doubts) {
    reason.message =
        reason.message.substr(0, reason.message.find(cause_words)) + std::string(cause_words) +
        (outcome.reason.ends_with("[locked]") ? "the mechanism is locked" : "the mechanism comes to a dead point");
  }
}

// A number of the model that no machine has is worth more than any advice about steps.
void Simulation::Impl::explain_failure() {
  if (outcome.exit_code != 4 || outcome.reason.find(cause_words) != std::string::npos) return;
  if (outcome.reason.ends_with("[dead-point]") || outcome.reason.ends_with("[locked]")) return;
  const Wreck wreck{accepted.t(), adaptive ? 0.0 : settings.step, failed_joint, first_forces};
  const std::string cause = likely_cause(system, e_accepted, wreck);
  if (cause.empty()) return;
  for (const std::string_view advice : {advice::smaller_step, advice::accuracy, advice::other_steps, advice::error}) {
    if (outcome.reason.ends_with(advice)) outcome.reason.resize(outcome.reason.size() - advice.size());
  }
  outcome.reason += std::string(cause_words) + cause;
}

void Simulation::Impl::note_unused_play() {
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    if (outcome.steps == 0 || !watch.never_moved(j) || !in_a_loop(model, j)) continue;
    const std::string joint = fmt::format("joint '{}'", model.joints[at(j)].name);
    outcome.doubts.push_back(
        {.id = "play-bypassed",
         .level = Trust::doubtful,
         .message = joint + ": its journal never moved in its bearing: nothing loads it, or other joints hold it",
         .element = joint});
  }
}

void Simulation::Impl::format_warnings() {
  for (std::size_t j = 0; j < joint_warnings.size(); ++j) {
    const Warning& warning = joint_warnings[j];
    if (warning.text == nullptr) continue;
    std::string_view sentence = warning.text;
    if (sentence.ends_with('.')) sentence.remove_suffix(1);
    const std::string joint = fmt::format("joint '{}'", model.joints[j].name);
    std::string text = fmt::format("{} at t = {:.9g} s: {}", joint, warning.time, sentence);
    outcome.doubts.push_back({.id = "law-range",
                              .level = Trust::doubtful,
                              .message = fmt::format("{}: {}", joint, sentence),
                              .element = joint});
    const Span<const Channel> own = system.joint_layout(static_cast<int>(j)).channels;
    for (std::size_t i = 0; i < own.size; ++i) {
      const bool plain = std::string_view(own[i].unit) == "1";
      text += fmt::format("{} {} = {:.4g}{}{}", i == 0 ? ":" : ",", own[i].name, warning_values[warning.values + i],
                          plain ? "" : " ", plain ? "" : own[i].unit);
    }
    warnings.push_back(text);
  }
}

}  // namespace freeplay
