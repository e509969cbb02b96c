#include "run/doubts.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "assembly/left_free.h"
#include "assembly/out_of_reach.h"
#include "assembly/play_rows.h"
#include "assembly/row_space.h"
#include "assembly/structure.h"
#include "base/disjoint_sets.h"
#include "base/index.h"
#include "component/joint_roles.h"
#include "linear/singular_values.h"
#include "model/element_name.h"
#include "model/force_element.h"
#include "model/whole_mass.h"

namespace freeplay {
namespace {
constexpr double fewest_steps_in_period = 10.0;  // of a motion that carries energy
constexpr double clearly_regular = 0.1;          // smallest singular value of rows by lengths, by the largest
constexpr double least_energy = 1e-6;            // by masses lifted by the model's size, or crossing it in the run

// Whether the bodies of a joint hang together without it, so that others may hold what it should.
bool in_a_loop(const Model& model, int without) {
  const int bodies = static_cast<int>(model.bodies.size());
  DisjointSets groups(bodies + 1);  // the last is ground
  const auto place = [&](int marker) {
    const BodyId body = model.markers[at(marker)].body;
    return body == ground ? bodies : body;
  };
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointElement& joint = model.joints[at(j)];
    if (j != without && joint.gear < 0) groups.unite(place(joint.marker_a), place(joint.marker_b));
  }
  return groups.together(place(model.joints[at(without)].marker_a), place(model.joints[at(without)].marker_b));
}

bool anything_acts(const Model& model) {
  const auto starts = [](const JointElement& joint) {
    return is_force_element(joint) || gives_velocity(joint) || (joint.start_speed && joint.start_speed->value != 0.0);
  };
  const auto moves = [](const Body& body) { return body.gravity != Vector3{} || has_velocity(body); };
  return !model.drivers.empty() || !model.forces.empty() || std::ranges::any_of(model.joints, starts) ||
         std::ranges::any_of(model.bodies, moves);
}
}  // namespace

RunDoubts::RunDoubts(RunContext& run, RunFailure& failure, Recorder& recorder)
    : run_(run),
      failure_(failure),
      recorder_(recorder),
      joint_warnings_(run.model.joints.size()),
      motion_(run.system),
      blows_(run.system),
      slow_(run.system) {
  const auto& drivers = run.model.drivers;
  swings_ = run.settings.discard > 0.0 &&
            std::ranges::none_of(drivers, [](const Driver& driver) { return prescribes(driver.kind); });
  std::size_t values = 0;
  for (int j = 0; j < static_cast<int>(run.model.joints.size()); ++j) {
    joint_warnings_[at(j)].values = values;
    values += run.system.joints().layout(j).channels.size;
  }
  warning_values_.resize(values);
}

void RunDoubts::save(ArchiveWriter& archive) const {
  archive(warning_values_, torn_from_, motion_, blows_, slow_);
  for (const Warning& warning : joint_warnings_) {
    archive(warning.text != nullptr, std::string(warning.text != nullptr ? warning.text : ""), warning.time);
  }
}

void RunDoubts::restore(ArchiveReader& archive) {
  archive(warning_values_, torn_from_, motion_, blows_, slow_);
  warning_texts_.resize(joint_warnings_.size());
  for (std::size_t j = 0; j < joint_warnings_.size(); ++j) {
    bool warned = false;
    archive(warned, warning_texts_[j], joint_warnings_[j].time);
    joint_warnings_[j].text = warned ? warning_texts_[j].c_str() : nullptr;
  }
}

void RunDoubts::note_motion() {
  const double t = run_.trial.t(), dt = t - run_.accepted.t();
  if (swings_) slow_.add(t, dt, run_.accepted.v(), run_.trial.v());
  if (run_.adaptive) return;
  motion_.add(t, dt, run_.accepted.a(), run_.trial.a(), run_.trial.v());
  blows_.add(run_.e_trial);
}

void RunDoubts::judge_motion() {
  if (!anything_acts(run_.model)) {
    run_.outcome.doubts.push_back(
        {.id = "doubtful-structure",
         .level = Trust::doubtful,
         .message = "nothing moves the mechanism: there is no gravity, force, driver or start speed"});
  }
  for (TrustReason& reason : run_.path_edges.doubts(run_.outcome.time, run_.adaptive ? 0.0 : run_.settings.step)) {
    run_.outcome.doubts.push_back(std::move(reason));
  }
  if (swings_) run_.outcome.slowest = slow_.slowest(run_.outcome.time, run_.accepted.v(), run_.accepted.a());
  if (run_.solver.rows().hold_everything() || run_.outcome.status == RunStatus::failed) return;
  const FastMotion::Fewest fewest = motion_.fewest();
  const double time = run_.outcome.time - run_.settings.start, size = run_.system.size();
  if (!(fewest.steps < fewest_steps_in_period) || !(time > 0.0)) return;
  const double mass = whole_mass(run_.model).mass, speed = size / time;
  const double gravity = std::hypot(run_.model.gravity[0], run_.model.gravity[1], run_.model.gravity[2]);
  if (!(fewest.energy > least_energy * mass * (gravity * size + speed * speed))) return;
  const std::string body = fmt::format("body '{}'", run_.model.bodies[at(fewest.body)].name);
  run_.outcome.doubts.push_back(
      {.id = "oscillation-steps",
       .level = Trust::doubtful,
       .message = fmt::format("{} moves to and fro with {:.2g} steps in a period, fewer than {:g}, which steps of one "
                              "size follow with another frequency; ask for shorter steps, or for an accuracy",
                              body, fewest.steps, fewest_steps_in_period),
       .element = body,
       .value = fewest.steps,
       .limit = fewest_steps_in_period});
}

void RunDoubts::note_lasting_blows() {
  const LastingBlows::Fewest fewest = blows_.fewest();
  if (!(fewest.steps < fewest_steps_of_blow)) return;
  const std::string joint = written_name(run_.model.joints[at(fewest.joint)]);
  run_.outcome.doubts.push_back(
      {.id = "impact-steps",
       .level = Trust::doubtful,
       .message = fmt::format("{}: a blow that begins a lasting contact took {:g} steps, fewer than {:g}; ask for "
                              "shorter steps, or for an accuracy",
                              joint, fewest.steps, fewest_steps_of_blow),
       .element = joint,
       .value = fewest.steps,
       .limit = fewest_steps_of_blow});
}

// By lengths alone: a body with hardly any inertia makes a regularity that goes by masses fall, too.
bool RunDoubts::is_nearly_singular() const {
  if (run_.system.layout().nv() > Structure::most_examined) return true;
  Eigen::MatrixXd rows = constraint_matrix(run_.system.jacobian(), run_.e_accepted);
  for (Eigen::Index c = 0; c < rows.cols(); ++c) {
    if (run_.system.coordinates().is_turn(static_cast<int>(c))) rows.col(c) /= run_.system.size();
  }
  for (Eigen::Index r = 0; r < rows.rows(); ++r) rows.row(r).normalize();
  const Eigen::VectorXd values = singular_values(rows).sigma;
  return values.size() == 0 || !(values[values.size() - 1] > clearly_regular * values[0]);
}

// False where the row shows that going on makes no sense.
bool RunDoubts::watch_row(double dt) {
  const double passed_at = run_.watch.passed_at();
  run_.watch.add_regularity(run_.solver.regularity(), run_.accepted.t());
  if (run_.watch.passed_at() < passed_at && !is_nearly_singular()) run_.watch.forget_passage();
  if (torn_from_ && run_.accepted.t() >= *torn_from_) return failure_.fail(4, "the mechanism is torn apart");
  if (!recorder_.loads_are_known() && !run_.watch.is_due(run_.e_accepted)) return true;
  if (!recorder_.know_loads()) return false;
  const int joint = run_.watch.add(recorder_.row(), run_.e_accepted);
  // A look at the drivers takes longer than many steps, so it waits until something is wrong.
  if (!torn_from_ && run_.watch.pressed_through())
    torn_from_ = out_of_reach_from(run_.equations->whole(), run_.equations->start().state);
  const bool runs_away = joint < 0 && run_.watch.runaway() >= 0;
  if (joint < 0 && !runs_away) return true;
  TrustReason reason = runs_away ? run_.watch.why_runaway(recorder_.row()) : run_.watch.why(joint, recorder_.row());
  std::string cause = failure_.likely_cause_at(run_.accepted.t(), dt, joint);
  if (cause.empty() && runs_away) cause = failure_.hardest_worker(0.0);
  if (!cause.empty()) reason.message += std::string(cause_words) + cause;
  failure_.fail(4, reason.message);
  run_.outcome.doubts.push_back(std::move(reason));
  return false;
}

// Once for each joint; the text is made when the run is over.
bool RunDoubts::note_warnings() {
  for (const ForceBlock& block : run_.system.forces().blocks()) {
    Warning& warning = joint_warnings_[at(block.joint)];
    if (warning.text != nullptr || run_.evaluations.is_asleep(block.joint)) continue;
    const Point here = point(run_.accepted);
    Fault fault;
    if (!run_.system.joints()
             .handle(block.joint)
             .warning(run_.system.joints().input(block.joint, here, run_.e_accepted), warning.text, fault.message)) {
      fault.kind = Fault::Kind::plugin;
      fault.joint = block.joint;
      return failure_.fail_with(fault, run_.accepted.t());
    }
    if (warning.text == nullptr) continue;
    if (!recorder_.know_row()) return false;
    warning.time = run_.accepted.t();
    std::copy_n(recorder_.row().begin() + run_.channels.joints[at(block.joint)].own,
                run_.system.joints().layout(block.joint).channels.size,
                warning_values_.begin() + static_cast<std::ptrdiff_t>(warning.values));
  }
  return true;
}

// A contact begins where its function leaves zero in the declared direction. One that is past it from the start, and is
// declared to fall, only has its event when the bodies part: with error control the contact then never begins.
void RunDoubts::note_event_directions() {
  for (int j = 0; j < static_cast<int>(run_.model.joints.size()); ++j) {
    const Span<const Event> declared = run_.system.joints().layout(j).events;
    std::vector<double> value(declared.size), rate(declared.size);
    Message message;
    const JointInput in = run_.system.joints().input(j, point(run_.accepted), run_.e_accepted);
    if (declared.empty() ||
        !run_.system.joints().handle(j).events(in, {value.data(), value.size()}, {rate.data(), rate.size()}, message)) {
      continue;
    }
    for (std::size_t i = 0; i < declared.size; ++i) {
      if (event_role(run_.system.joints().layout(j), i) != EventRole::contact_begin) continue;
      if (declared[i].crossing == Crossing::rising || !(value[i] < -StepEvents::tolerance)) continue;
      const std::string joint = written_name(run_.model.joints[at(j)]);
      run_.outcome.doubts.push_back(
          {.id = "event-direction",
           .level = run_.adaptive ? Trust::bad : Trust::doubtful,
           .message = fmt::format("{}: its event '{}' is declared to fall through zero, but is {:.3g} at the start and "
                                  "did not happen: contacts are missed if it rises when they begin",
                                  joint, declared[i].name, value[i]),
           .element = joint});
    }
  }
}

void RunDoubts::note_first_forces() {
  run_.first_forces.assign(run_.model.joints.size(), 0.0);
  for (const ForceBlock& block : run_.system.forces().blocks()) {
    const double* force = &run_.e_accepted->wrench[12 * at(block.joint) + 6];
    run_.first_forces[at(block.joint)] = std::hypot(force[0], force[1], force[2]);
  }
}

void RunDoubts::note_unused_play() {
  for (int j = 0; j < static_cast<int>(run_.model.joints.size()); ++j) {
    if (run_.outcome.steps == 0 || !run_.watch.never_moved(j) || !in_a_loop(run_.model, j)) continue;
    const std::string joint = written_name(run_.model.joints[at(j)]);
    run_.outcome.doubts.push_back(
        {.id = "play-bypassed",
         .level = Trust::doubtful,
         .message = joint + ": its journal never moved in its bearing: nothing loads it, or other joints hold it",
         .element = joint});
  }
}

// Laws that divide their damping by the speed of approach press without bound where a contact began with next to none.
void RunDoubts::note_damped_peaks() {
  for (int j = 0; j < static_cast<int>(run_.model.joints.size()); ++j) {
    const double times = run_.watch.damped_by(j);
    if (!(times > 0.0)) continue;
    const std::string joint = written_name(run_.model.joints[at(j)]);
    run_.outcome.doubts.push_back(
        {.id = "law-range",
         .level = Trust::doubtful,
         .message = fmt::format(
             "{}: where it presses hardest, damping makes {:.2g} times of what its stiffness presses with: "
             "a law of impact divides by the speed at which the contact began, here next to "
             "nothing; {}compare with a law without loss",
             joint, times,
             could_start_by_its_load(run_.model.joints[at(j)]) ? "start it under its load ('initial: loaded'), or "
                                                               : ""),
         .element = joint,
         .value = times,
         .limit = RunWatch::most_damped});
  }
}

void RunDoubts::format_warnings() {
  for (std::size_t j = 0; j < joint_warnings_.size(); ++j) {
    const Warning& warning = joint_warnings_[j];
    if (warning.text == nullptr) continue;
    std::string_view sentence = warning.text;
    if (sentence.ends_with('.')) sentence.remove_suffix(1);
    const std::string joint = written_name(run_.model.joints[j]);
    std::string text = fmt::format("{} at t = {:.9g} s: {}", joint, warning.time, sentence);
    run_.outcome.doubts.push_back({.id = "law-range",
                                   .level = Trust::doubtful,
                                   .message = fmt::format("{}: {}", joint, sentence),
                                   .element = joint});
    const Span<const Channel> own = run_.system.joints().layout(static_cast<int>(j)).channels;
    for (std::size_t i = 0; i < own.size; ++i) {
      const bool plain = std::string_view(own[i].unit) == "1";
      text += fmt::format("{} {} = {:.4g}{}{}", i == 0 ? ":" : ",", own[i].name, warning_values_[warning.values + i],
                          plain ? "" : " ", plain ? "" : own[i].unit);
    }
    run_.warnings.push_back(text);
  }
}

}  // namespace freeplay
