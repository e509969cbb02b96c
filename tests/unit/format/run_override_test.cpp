// Values for one run that are set beside the model: which of them holds, and what mistakes are answered.
#include "format/run_override.h"

#include "answers.h"
#include "base/error.h"

namespace freeplay {
namespace {

constexpr const char* loose_pin =
    "freeplay: 1\n"
    "parameters: {m: 2 kg}\n"
    "bodies: {puck: {mass: $m, inertia: 1}}\n"
    "joints:\n"
    "  A: {type: revolute, between: [ground, puck], clearance: {radial_clearance: 0.1 mm, bearing_radius: 10 mm, "
    "contact: {law: flores, restitution: 0.9, K: 1e9}}}\n"
    "simulation: {end: 1, step: 1 ms, integrator: bathe}\n";

using Set = std::vector<std::pair<std::string, std::string>>;

/// "message | hint" of the refusal.
std::string refused_override(const BuildOptions& options) {
  try {
    return "said " + said_of(loose_pin, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.category(), Error::Category::usage);
    return error.message() + (error.hint().empty() ? "" : " | " + error.hint());
  }
}

TEST(RunOverride, MistakesAreRefused) {
  const struct {
    const char *name, *text, *said;
  } cases[] = {
      {"simulation.end", "0", "--set simulation.end='0': it must be > 0"},
      {"simulation.end", "1 m",
       "--set simulation.end='1 m': expected time, but this is length | write a unit such as 's'"},
      {"simulation.step", "1 mss", "--set simulation.step='1 mss': 'mss' is not a unit | did you mean 'ms'?"},
      {"simulation.accuracy", "-1 um", "--set simulation.accuracy='-1 um': it must be > 0"},
      {"simulation.integrator", "bath", "--integrator bath: there is no such integrator | did you mean 'bathe'?"},
      {"simulation.integrator", "zzzz",
       "--integrator zzzz: there is no such integrator | there is bathe, newmark, hht, generalized-alpha, dopri5, "
       "verner6, verner7 or arkode"},
      {"repeat", "0", "--set repeat='0': it must be a whole number from 1 to 2^53"},
      {"repeat", "1.5", "--set repeat='1.5': it must be a whole number from 1 to 2^53"},
      {"repeat", "1x", "--set repeat='1x': it must be a whole number from 1 to 2^53"},
      {"repeat", "many", "--set repeat='many': it must be a whole number from 1 to 2^53"},
      {"seed", "-1", "--set seed='-1': it must be a whole number from 0 to 2^53"},
      {"seed", "1e17", "--set seed='1e17': it must be a whole number from 0 to 2^53"},
      {"ideal", "[A", "--set ideal='[A': it is no list of names"},
  };
  for (const auto& c : cases) {
    BuildOptions options;
    options.set = {{c.name, c.text}};
    EXPECT_EQ(refused_override(options), c.said) << c.name;
  }
  BuildOptions options;
  options.end = 0.0;
  EXPECT_EQ(refused_override(options), "--end 0 must be greater than the start, 0 s");
  options.end.reset(), options.step = 0.0;
  EXPECT_EQ(refused_override(options), "--step 0 must be > 0");
  options.step.reset(), options.interval = 1e-18;
  EXPECT_EQ(refused_override(options),
            "--interval: 1e-18 s between rows is less than times of 1 s can differ by; it must be at least 4.4e-16 s");
}

Settings settings_of(const Set& set, BuildOptions options = {}) {
  options.set = set;
  return test::load(loose_pin, options)->settings;
}

TEST(RunOverride, TheLastOfStepAndAccuracyHolds) {
  EXPECT_EQ(settings_of({{"simulation.step", "2 ms"}}).step, 2e-3);
  EXPECT_EQ(settings_of({{"simulation.accuracy", "1 um"}}).accuracy, 1e-6);
  EXPECT_EQ(settings_of({{"simulation.step", "2 ms"}, {"simulation.accuracy", "1 um"}}).accuracy, 1e-6);
  EXPECT_EQ(settings_of({{"simulation.accuracy", "1 um"}, {"simulation.step", "2 ms"}}).accuracy, 0.0);
  EXPECT_EQ(settings_of({{"simulation.accuracy", "1 um"}, {"simulation.step", "{size: 2 ms}"}}).step, 2e-3);
}

TEST(RunOverride, OptionsOfTheCommandLineComeFirst) {
  BuildOptions options;
  options.end = 3.0, options.step = 5e-3, options.integrator = "newmark";
  const Settings settings = settings_of({{"simulation.end", "2"},
                                         {"simulation.step", "2 ms"},
                                         {"simulation.accuracy", "1 um"},
                                         {"simulation.integrator", "hht"}},
                                        options);
  EXPECT_EQ(settings.end, 3.0);
  EXPECT_EQ(settings.step, 5e-3);
  EXPECT_EQ(settings.accuracy, 0.0);
  EXPECT_STREQ(settings.integrator_parameters.component->description.name, "newmark");
}

TEST(RunOverride, IntegratorsAreNamesOrMaps) {
  const auto name = [](const Set& set) {
    return std::string(settings_of(set).integrator_parameters.component->description.name);
  };
  EXPECT_EQ(name({{"simulation.integrator", "hht"}}), "hht");
  EXPECT_EQ(name({{"simulation.integrator", "{type: newmark}"}}), "newmark");
  EXPECT_EQ(name({{"simulation.integrator", "hht"}, {"simulation.integrator", "{type: newmark}"}}), "newmark");
}

TEST(RunOverride, JointsAreMadeIdealByNamesAListOrNone) {
  const auto loose = [](const char* text, std::vector<std::string> asked = {}) {
    BuildOptions options;
    options.set = {{"ideal", text}}, options.ideal = std::move(asked);
    return test::load(loose_pin, options)->clearance_joints();
  };
  EXPECT_EQ(loose("none"), 1);
  EXPECT_EQ(loose("A"), 0);
  EXPECT_EQ(loose("[A]"), 0);
  EXPECT_EQ(loose("none", {"all"}), 0);
}

TEST(RunOverride, ChoosesTheStartUnlessAParameterHasTheName) {
  const auto chosen = [](const std::string& text, const Set& set) {
    BuildOptions options;
    options.set = set;
    return start_choice(*test::load(text, options));
  };
  EXPECT_EQ(chosen(loose_pin, {{"repeat", "3"}, {"seed", "7"}}).repeat, 3u);
  EXPECT_EQ(chosen(loose_pin, {{"repeat", "3"}, {"seed", "7"}}).seed, 7u);
  const std::string own = test::replaced(test::replaced(loose_pin, "m: 2 kg", "seed: 2 kg"), "$m", "$seed");
  EXPECT_EQ(chosen(own, {{"seed", "7"}}).seed, chosen(loose_pin, {}).seed);
}

}  // namespace
}  // namespace freeplay
