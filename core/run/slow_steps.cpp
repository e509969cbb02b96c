#include "run/slow_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "assembly/play_rows.h"
#include "base/index.h"
#include "model/element_name.h"

namespace freeplay {
namespace {

constexpr double many = 1e7;       // steps of a whole run: minutes
constexpr double endless = 1e11;   // a day at a million a second
constexpr double quick = 0.02;     // part of itself by which a force changes from step to step
constexpr double chatters = 0.75;  // likewise: it is another one after each step, however few they are
constexpr double too_fine = 5.0;   // steps in a half wave of a contact, by those that an impact should take

/// Of two vectors of three components, by the larger: 0 to 2.
double difference(const double* a, const double* b) {
  const double apart = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  const double size = std::max(std::hypot(a[0], a[1], a[2]), std::hypot(b[0], b[1], b[2]));
  return size > 0.0 ? apart / size : 0.0;
}

}  // namespace

SlowSteps::SlowSteps(RunContext& run, RunFailure& failure)
    : run_(run),
      failure_(failure),
      from_(run.settings.start),
      changes_(run.model.joints.size() + run.model.drivers.size() + run.model.forces.size()),
      contacts_(run) {}

// The last step goes from what the trial's evaluation holds now to the accepted one.
double SlowSteps::change_of(std::size_t load) const {
  const Evaluation &now = run_.e_accepted, &before = run_.e_trial;
  const std::size_t joints = run_.model.joints.size();
  if (load < joints) {
    const double *a = &now.wrench[12 * load + 6], *b = &before.wrench[12 * load + 6];
    return std::max(difference(a, b), difference(a + 3, b + 3));
  }
  const std::size_t d = load - joints, drivers = run_.model.drivers.size();
  if (d >= drivers) {
    const double *a = &now.applied[6 * (d - drivers)], *b = &before.applied[6 * (d - drivers)];
    return std::max(difference(a, b), difference(a + 3, b + 3));
  }
  if (prescribes(run_.model.drivers[d].kind)) return 0.0;
  const double a[3] = {now.motion[d].value, 0.0, 0.0}, b[3] = {before.motion[d].value, 0.0, 0.0};
  return difference(a, b);
}

void SlowSteps::watch() {
  if (steps_ == block - watched + 1) watched_from_ = run_.accepted.t();
  for (std::size_t i = 0; i < changes_.size(); ++i) changes_[i] += change_of(i) / watched;
}

std::string SlowSteps::name_of(std::size_t load) const {
  const std::size_t joints = run_.model.joints.size();
  const std::size_t drivers = run_.model.drivers.size();
  if (load >= joints + drivers) return fmt::format("force '{}'", run_.model.forces[load - joints - drivers].name);
  if (load >= joints) return fmt::format("driver '{}'", run_.model.drivers[load - joints].name);
  const JointElement& joint = run_.model.joints[load];
  return written_name(joint);
}

SlowSteps::Blame SlowSteps::blame() const {
  if (2 * limited_ > steps_) {
    const std::string name = name_of(at(joint_));
    return {name, fmt::format("{} asks for steps no longer", name)};
  }
  const auto most = std::ranges::max_element(changes_);
  if (most == changes_.end() || !(*most > quick)) return {};
  const std::string name = name_of(static_cast<std::size_t>(most - changes_.begin()));
  return {name, fmt::format("{} changes by {:.3g} % from each to the next: it jumps, or is stiff", name,
                            100.0 * std::min(*most, 1.0))};
}

// Steps as long as the time constant m/c of a contact are as long as an explicit method can take. Where they are far
// shorter than what the contact does as a spring, it is the damping alone that asks for them.
void SlowSteps::judge_contacts(double mean, double all) {
  if (!contacts_.any() || run_.integrator_layout.explicit_stages == 0) return;
  const double step = (run_.accepted.t() - watched_from_) / static_cast<double>(watched - 1);
  const ContactPace pace = contacts_.fastest();
  const double turn = pace.swing * step, limit = too_fine * run_.settings.per_contact;
  if (!(pace.damping * step > 1.0 && M_PI > limit * turn)) return;
  element_ = name_of(at(pace.joint)), value_ = turn > 0.0 ? M_PI / turn : std::nan(""), limit_ = limit;
  const std::string times = fmt::format("{:.2g} times as much as stops", 0.5 * pace.damping / pace.swing);
  // What brings sliding to rest is no spring, and one that does not press yet has nothing to be compared with.
  const std::string much =
      pace.slides ? "brings sliding to rest"
                  : "is damped " + (turn > 0.0 ? times : "more than enough to stop") + " it from swinging,";
  sentence_ = fmt::format(
      "steps of {:.2g} s at t = {:.6g} s, of which the whole run would take {:.2g}; {} limits the last of them to "
      "{:.2g} s: {} {} with a time constant of {:.2g} s; {}, or steps of one size",
      mean, run_.accepted.t(), all, element_, step, contacts_.words(pace), much, 1.0 / pace.damping, remedy_for(pace));
}

const char* SlowSteps::remedy_for(const ContactPace& pace) const {
  if (pace.slides) return "take a friction that sets in over a larger speed, as by a larger 'vs'";
  const JointElement& joint = run_.model.joints[at(pace.joint)];
  if (!could_start_by_its_load(joint)) return "take a law or a restitution that damps less";
  return "start it in contact under its load ('initial: loaded'), take a law or a restitution that damps less";
}

bool SlowSteps::judge() {
  const double t = run_.accepted.t(), step = (t - from_) / static_cast<double>(steps_);
  const double all = static_cast<double>(run_.outcome.steps) + (run_.settings.end - t) / step;
  const bool chattering = std::ranges::any_of(changes_, [](double change) { return change > chatters; });
  bool going = true;
  if (sentence_.empty() && !(all > endless)) judge_contacts(step, all);
  if (sentence_.empty() && (all > many || chattering)) {
    Blame blame = this->blame();
    sentence_ = fmt::format("steps of {:.2g} s at t = {:.6g} s, of which the whole run would take {:.2g}{}{}", step, t,
                            all, blame.words.empty() ? "" : "; ", blame.words);
    element_ = std::move(blame.element);
    value_ = step, limit_ = (run_.settings.end - run_.settings.start) / many;
    going = !(all > endless);
    if (!going) failure_.fail(4, fmt::format("t = {:.9g} s: the run does not come to its end: {}", t, sentence_));
  }
  steps_ = limited_ = 0;
  from_ = t;
  std::ranges::fill(changes_, 0.0);
  return going;
}

std::string SlowSteps::take_notice() {
  noticed_ = true;
  return sentence_;
}

// Many steps that nothing is to blame for are only many.
void SlowSteps::add_doubt() {
  if (element_.empty()) return;
  run_.outcome.doubts.push_back({.id = "short-steps",
                                 .level = Trust::doubtful,
                                 .message = sentence_,
                                 .element = element_,
                                 .value = value_,
                                 .limit = limit_});
}

}  // namespace freeplay
