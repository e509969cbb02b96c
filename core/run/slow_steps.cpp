#include "run/slow_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/index.h"

namespace freeplay {
namespace {

constexpr double many = 1e7;       // steps of a whole run: minutes
constexpr double endless = 1e11;   // a day at a million a second
constexpr double quick = 0.02;     // part of itself by which a force changes from step to step
constexpr double chatters = 0.75;  // likewise: it is another one after each step, however few they are

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
      changes_(run.model.joints.size() + run.model.drivers.size()) {}

// The last step goes from what the trial's evaluation holds now to the accepted one.
double SlowSteps::change_of(std::size_t load) const {
  const Evaluation &now = run_.e_accepted, &before = run_.e_trial;
  const std::size_t joints = run_.model.joints.size();
  if (load < joints) {
    const double *a = &now.wrench[12 * load + 6], *b = &before.wrench[12 * load + 6];
    return std::max(difference(a, b), difference(a + 3, b + 3));
  }
  const std::size_t d = load - joints;
  if (prescribes(run_.model.drivers[d].kind)) return 0.0;
  const double a[3] = {now.motion[d].value, 0.0, 0.0}, b[3] = {before.motion[d].value, 0.0, 0.0};
  return difference(a, b);
}

void SlowSteps::watch() {
  for (std::size_t i = 0; i < changes_.size(); ++i) changes_[i] += change_of(i) / watched;
}

std::string SlowSteps::name_of(std::size_t load) const {
  const std::size_t joints = run_.model.joints.size();
  if (load >= joints) return fmt::format("driver '{}'", run_.model.drivers[load - joints].name);
  const JointElement& joint = run_.model.joints[load];
  return fmt::format("{} '{}'", joint.is_force ? "force" : "joint", joint.name);
}

SlowSteps::Blame SlowSteps::blame() const {
  if (2 * limited_ > steps_) {
    const std::string name = name_of(at(joint_));
    return {name, fmt::format("{} asks for steps no longer", name)};
  }
  const auto most = std::ranges::max_element(changes_);
  if (most == changes_.end() || !(*most > quick)) return {};
  const std::string name = name_of(static_cast<std::size_t>(most - changes_.begin()));
  return {name, fmt::format("{} changes by {:.2g} % from each to the next: it jumps, or is stiff", name,
                            100.0 * std::min(*most, 1.0))};
}

bool SlowSteps::judge() {
  const double t = run_.accepted.t(), step = (t - from_) / static_cast<double>(steps_);
  const double all = static_cast<double>(run_.outcome.steps) + (run_.settings.end - t) / step;
  const bool chattering = std::ranges::any_of(changes_, [](double change) { return change > chatters; });
  bool going = true;
  if (sentence_.empty() && (all > many || chattering)) {
    Blame blame = this->blame();
    sentence_ = fmt::format("steps of {:.2g} s at t = {:.6g} s, of which the whole run would take {:.2g}{}{}", step, t,
                            all, blame.words.empty() ? "" : "; ", blame.words);
    element_ = std::move(blame.element), step_ = step;
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
                                 .value = step_,
                                 .limit = (run_.settings.end - run_.settings.start) / many});
}

}  // namespace freeplay
