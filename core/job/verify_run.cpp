#include "job/verify_run.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "job/verification_record.h"
#include "load/plugins.h"
#include "results/row_memory.h"

namespace freeplay {
namespace {

constexpr double least_agreement = 1e-6;    // of positions, where less is asked for [m]
constexpr double both_errors = 3.0;         // accuracies that two runs of it may be apart
constexpr double part_of_size = 1e-6;       // accuracy of a second run to fixed steps: of the model's size
constexpr double part_of_clearance = 1e-3;  // or of the smallest clearance
constexpr double finer_explicit = 0.1;      // accuracy of the second run, of the first's
constexpr double finer_implicit = 0.5;      // where steps cost more
constexpr double third_accuracy = 10.0;     // of the second's
constexpr double least_accuracy = 1e-13;    // of the model's size: rounding
constexpr long steps_for_each = 50, steps_at_least = 500'000;  // of the first run's, before the second is given up

IntegratorLayout layout_of(const Model& model) {
  IntegratorLayout layout;
  Message message;
  if (!model.settings.integrator.declare(layout, message)) layout.error_estimate = 0;
  return layout;
}

double accuracy_of(const System& system) {
  const Model& model = system.model();
  if (model.settings.accuracy > 0.0) return model.settings.accuracy;
  double accuracy = std::min(least_agreement, part_of_size * system.size());
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const double clearance = system.joints().layout(j).clearance;
    if (clearance > 0.0) accuracy = std::min(accuracy, part_of_clearance * clearance);
  }
  return accuracy;
}

/// Its place, and its turn at its radius of gyration: a quaternion changes by half of a small turn.
void add_positions(const Body& body, const Channels& channels, std::vector<PositionChannel>& positions) {
  const double moment = std::max({body.inertia[0], body.inertia[4], body.inertia[8]});
  const double gyration = body.mass > 0.0 ? std::sqrt(moment / body.mass) : 0.0;
  const auto add = [&](const char* quantity, double lever) {
    std::string name = fmt::format("body.{}.{}", body.name, quantity);
    if (channels.find(name) >= 0) positions.push_back({std::move(name), lever});
  };
  for (const char* place : {"x", "y", "z"}) add(place, 1.0);
  add("angle", gyration);
  for (const char* part : {"qw", "qx", "qy", "qz"}) add(part, 2.0 * gyration);
}

/// A run to its end, with its rows.
struct OtherRun {
  LoadedModel loaded;
  std::unique_ptr<AssembledModel> assembled;
  std::optional<Channels> channels;
  std::optional<RowMemory> rows;
  std::vector<Peak> peaks;
  double energy = 0.0;  ///< that was moved [J]
  Outcome outcome;

  RunResult result() const { return {&rows->table(), peaks}; }
};

/// One that takes too many steps is given up.
void run_to_end(OtherRun& other, long most_steps, const std::function<bool()>& interrupted) {
  other.assembled = other.loaded.model ? assemble_model(other.loaded) : nullptr;
  if (!other.assembled) return;
  other.channels.emplace(*other.loaded.model);
  other.rows.emplace(*other.channels);
  Sink* const sink = &*other.rows;
  Simulation simulation(other.assembled->system, other.assembled->start, *other.channels, {&sink, 1});
  std::atomic<int> stop{0};
  RunHooks hooks;
  hooks.interrupt = &stop;
  hooks.progress = [&](double, long steps) {
    if (interrupted() || steps > most_steps) stop = 1;
  };
  other.outcome = simulation.run(hooks);
  // Peaks of a run that went less far are no others'.
  if (other.outcome.exit_code == 0) other.peaks = peaks_of(*other.loaded.model, simulation.statistics());
  other.energy = simulation.extremes().exchanged + simulation.extremes().kinetic.span();
}

/// The model with an integrator of the other kind than the run's.
LoadedModel load_by_other_kind(const VerifiedRun& run, BuildOptions& build) {
  const bool was_explicit = layout_of(run.system.model()).explicit_stages != 0;
  const Registry registry = load_registry(run.load, nullptr);
  std::vector<std::string> names;
  for (const std::uint32_t use : {2u, 1u}) {
    const Component* component = registry.preferred(ComponentKind::integrator, use);
    if (component != nullptr) names.emplace_back(component->description.name);
  }
  for (const std::string& name : registry.names(ComponentKind::integrator)) names.push_back(name);
  for (const std::string& name : names) {
    build.integrator = name;
    LoadedModel loaded;
    try {
      loaded = run.read(build);
    } catch (const Error&) {
      continue;  // it gives no error estimate
    }
    if (!loaded.model) return loaded;
    const IntegratorLayout layout = layout_of(*loaded.model);
    if ((layout.explicit_stages != 0) != was_explicit && layout.error_estimate != 0) return loaded;
  }
  LoadedModel none;
  return none;
}

std::string words(const Settings& settings, bool is_explicit) {
  return fmt::format("{} ({}), accuracy {:.3g} m, steps of {:g} s at most",
                     settings.integrator_parameters.component->description.name, is_explicit ? "explicit" : "implicit",
                     settings.accuracy, settings.largest_step);
}

}  // namespace

std::vector<Peak> peaks_of(const Model& model, const Statistics& statistics) {
  std::vector<Peak> peaks;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const JointStatistics seen = statistics.joint(static_cast<int>(i));
    if (model.joints[i].gear >= 0) continue;
    peaks.push_back({fmt::format("joint {} max |F|", model.joints[i].name), seen.max_force});
    peaks.push_back({fmt::format("joint {} rms |F|", model.joints[i].name), seen.rms_force});
    if (model.joints[i].has_play) {
      peaks.push_back({fmt::format("joint {} max delta", model.joints[i].name), seen.max_penetration});
    }
  }
  for (std::size_t i = 0; i < model.drivers.size(); ++i) {
    const Driver& driver = model.drivers[i];
    const bool slide = model.joints[static_cast<std::size_t>(driver.joint)].layout.coordinate == Coordinate::position;
    const char* const effort = slide ? "|force|" : "|torque|";
    const DriverStatistics seen = statistics.driver(static_cast<int>(i));
    peaks.push_back({fmt::format("driver {} max {}", driver.name, effort), seen.max_abs});
    peaks.push_back({fmt::format("driver {} rms {}", driver.name, effort), seen.rms});
    peaks.push_back({fmt::format("driver {} work", driver.name), seen.work});
  }
  for (std::size_t i = 0; i < model.force_elements.size(); ++i) {
    peaks.push_back({fmt::format("force {} work", force_words(model, static_cast<int>(i)).name),
                     statistics.force(static_cast<int>(i)).work});
  }
  for (std::size_t i = 0; i < model.kinematics.size(); ++i) {
    peaks.push_back({fmt::format("path {} max error", model.kinematics[i].name),
                     statistics.path(static_cast<int>(i)).max_position});
  }
  return peaks;
}

std::optional<Verification> verify_run(const VerifiedRun& run, std::string& trouble) {
  const Model& model = run.system.model();
  const Settings& settings = model.settings;
  const bool second_explicit = layout_of(model).explicit_stages == 0;
  const double asked = accuracy_of(run.system);
  const double least = least_accuracy * run.system.size();
  BuildOptions build = run.build;
  build.step = std::nullopt;
  build.largest_step = settings.interval;
  build.accuracy = std::max(asked * (second_explicit ? finer_explicit : finer_implicit), least);
  OtherRun second;
  second.loaded = load_by_other_kind(run, build);
  if (!second.loaded.model) {
    trouble = "there is no integrator of another kind that could run the model";
    return std::nullopt;
  }
  const long most_steps = std::max(steps_at_least, steps_for_each * run.outcome.steps);
  run_to_end(second, most_steps, run.interrupted);
  if (!second.assembled || second.outcome.rows < 2) {
    trouble = run.interrupted()
                  ? "the second run was interrupted"
                  : fmt::format("the second run, by {}, came to nothing: {}", *build.integrator, second.outcome.reason);
    return std::nullopt;
  }
  VerificationRules rules;
  rules.limit = std::max(least_agreement, both_errors * settings.accuracy);
  rules.size = run.system.size();
  rules.energy = second.energy;
  rules.length = both_errors * asked;
  rules.fixed = settings.accuracy == 0.0;
  for (const Body& body : model.bodies) add_positions(body, *second.channels, rules.positions);
  const RunResult first{&run.rows, peaks_of(model, run.statistics)};
  Verification result = compare_runs(first, second.result(), rules);
  result.method = words(second.loaded.model->settings, second_explicit);
  result.steps = second.outcome.steps;
  result.whole = second.outcome.exit_code == 0;
  if (second.outcome.exit_code != 0) {
    trouble =
        second.outcome.status == RunStatus::interrupted
            ? fmt::format("the second run was {} at {:.6g} s after {} steps",
                          run.interrupted() ? "interrupted" : "given up", second.outcome.time, second.outcome.steps)
            : fmt::format("the second run ended early: {}", second.outcome.reason);
  }
  if (result.agreement == Agreement::agree || run.interrupted()) return result;
  OtherRun third;
  build.accuracy = third_accuracy * *build.accuracy;
  third.loaded = run.read(build);
  run_to_end(third, most_steps, run.interrupted);
  if (third.assembled && third.rows) judge(result, first, second.result(), third.result(), rules);
  return result;
}

void add_verification(const Verification& verification, RunRecord& record) {
  for (const ChannelError& channel : verification.channels) record.verify.emplace_back(channel.name, channel.error);
  record.agree_until = verification.agree_until;
  record.verification = verification_json(verification);
  const bool peaks_differ = std::ranges::any_of(verification.peaks, &PeakPair::differs);
  if (verification.agreement == Agreement::err && peaks_differ) {
    record.trust.add({.id = "verify",
                      .level = Trust::doubtful,
                      .message = fmt::format("a second run, by {}, has other peaks", verification.method)});
  }
  if (!verification.whole) {
    record.trust.add(
        {.id = "verify",
         .level = Trust::doubtful,
         .message = fmt::format("a second run, by {}, came to {:.6g} s alone: nothing after that is verified",
                                verification.method, verification.until)});
  }
  if (verification.agreement == Agreement::disagree) {
    record.trust.add({.id = "verify",
                      .level = Trust::bad,
                      .message = fmt::format("a second run, by {}, disagrees", verification.method),
                      .value = verification.largest,
                      .limit = verification.limit});
  }
}

}  // namespace freeplay
