// Mistakes in the sections `simulation`, `parameters`, `presets`, `templates` and `instances`.
#include "answers.h"

namespace freeplay {
namespace {

const std::string swinging_rod =
    "freeplay: 1\n"
    "bodies:\n"
    "  rod: {mass: 1, inertia: 1, frames: {tip: [1, 0]}}\n"
    "joints:\n"
    "  A: {type: revolute, between: [ground, rod]}\n"
    "forces:\n"
    "  w: {type: force, at: rod/tip, value: [0, 1]}\n"
    "simulation: ";

constexpr Answer of_runs[] = {
    {"3", "8:13 wrong-type: 'simulation' must be a map, not a scalar"},
    {"{end: 0, step: 1 ms}", "8:19 out-of-range: 'end' (0 s) must be greater than 'start' (0 s)"},
    {"{start: 2, end: 1, step: 1 ms}", "8:29 out-of-range: 'end' (1 s) must be greater than 'start' (2 s)"},
    {"{start: 2, step: 1 ms}", "8:21 out-of-range: 'end' (1 s) must be greater than 'start' (2 s)"},
    {"{start: 2, end: 3, step: 1 ms}", ""},
    {"{end: [1], step: 1 ms}", "8:19 wrong-type: 'simulation.end' must be a quantity, not a list"},
    {"{start: [1], end: 1, step: 1 ms}", "8:21 wrong-type: 'simulation.start' must be a quantity, not a list"},
    {"{end: 1, step: 0}", "8:28 out-of-range: 'simulation.step' must be > 0 s, not 0 s"},
    {"{end: 1, step: [1]}", "8:28 wrong-type: 'simulation.step' must be a quantity, not a list"},
    {"{end: 1, step: {adaptive: true}}", ""},
    {"{end: 1, step: {size: 1 ms, adaptive: 1}}",
     "8:51 wrong-type: 'simulation.step.adaptive' must be true or false, not '1'"},
    {"{end: 1, step: {size: 1 ms, adaptive: [true]}}",
     "8:51 wrong-type: 'simulation.step.adaptive' must be true or false, not a list"},
    {"{end: 1, step: {size: 1 ms, tolerance: 1e-3}}",
     "8:41 unused: 'tolerance' has no effect on fixed steps: 'adaptive: true' is missing"},
    {"{end: 1, step: {size: 1 ms, min: 1 us, max: 2 ms}}",
     "8:41 unused: 'min' has no effect on fixed steps: 'adaptive: true' is missing\n8:52 unused: 'max' has no effect "
     "on fixed steps: 'adaptive: true' is missing"},
    {"{end: 1, step: {size: 1 ms, adaptive: true, min: 2 ms}}",
     "8:62 out-of-range: 'min' must not be above 'size', 0.001 s"},
    {"{end: 1, step: {size: 1 ms, adaptive: true, max: 1 us}}",
     "8:62 out-of-range: 'max' must not be below 'size', 0.001 s"},
    {"{end: 1, step: {size: 1 ms, adaptive: true, tolerance: 2}}",
     "8:68 out-of-range: 'simulation.step.tolerance' must be >= 1e-14 and <= 0.1, not 2"},
    {"{end: 1, step: {size: 1 ms, adaptive: true, per_contact: 0}}",
     "8:70 out-of-range: 'simulation.step.per_contact' must be >= 2 and <= 1000000, not 0"},
    {"{end: 1, step: {size: 1 ms, adaptive: true, per_contact: 30}}", ""},
    {"{end: 1, step: {size: [1]}}", "8:35 wrong-type: 'simulation.step.size' must be a quantity, not a list"},
    {"{end: 1, step: 1 ms, accuracy: 1 um}", "8:34 conflicting-keys: 'step' and 'accuracy' exclude each other"},
    {"{end: 1, accuracy: 0}", "8:32 out-of-range: 'simulation.accuracy' must be > 0 m, not 0 m"},
    {"{end: 1, accuracy: 1 s}",
     "8:32 dimension-mismatch: expected length, but this is time | write a unit such as 'm'"},
    {"{end: 1, accuracy: 1 um, integrator: newmark}", ""},
    {"{end: 1, step: {size: 1 ms, adaptive: true}, integrator: newmark}", ""},
    {"{end: 1, step: 1 ms, integrator: [bathe]}",
     "8:46 wrong-type: 'simulation.integrator' must be a name or a map, not a list"},
    {"{end: 1, step: 1 ms, integrator: bath}",
     "8:46 unknown-type: unknown type 'bath' in 'simulation.integrator' | bathe"},
    {"{end: 1, step: 1 ms, integrator: zzzz}",
     "8:46 unknown-type: unknown type 'zzzz' in 'simulation.integrator' | not in this release, which has bathe, "
     "newmark, hht, generalized-alpha, dopri5, verner6, verner7 or arkode"},
    {"{end: 1, step: 1 ms, integrator: {}}", "8:34 missing-key: missing key 'type' in 'simulation.integrator'"},
    {"{end: 1, step: 1 ms, integrator: {type: bathe, splitt: 1}}",
     "8:60 unknown-key: unknown key 'splitt' in 'simulation.integrator' | split"},
    {"{end: 1, step: 1 ms, integrator: {type: bathe, newton: {max_iterations: 0}}}",
     "8:85 out-of-range: 'simulation.integrator.newton.max_iterations' must be >= 1, not 0"},
    {"{end: 1, step: 1 ms, integrator: {type: bathe, newton: 3}}",
     "8:68 wrong-type: 'simulation.integrator.newton' must be a map, not a scalar"},
    {"{end: 1, step: 1 ms, integrator: {type: [bathe]}}",
     "8:53 wrong-type: 'simulation.integrator.type' must be a word or text, not a list"},
};

constexpr Answer of_outputs[] = {
    {"3", "8:42 wrong-type: 'simulation.output' must be a map, not a scalar"},
    {"{interval: 0}", "8:53 out-of-range: 'simulation.output.interval' must be > 0 s, not 0 s"},
    {"{interval: 1e-18}",
     "8:53 doubtful-time: 'simulation.output.interval' is 1e-18 s in a run of 1 s: 1e+18 rows would be written\n8:53 "
     "out-of-range: 1e-18 s between rows is less than times of 1 s can differ by; it must be at least 4.4e-16 s"},
    {"{interval: [1]}", "8:53 wrong-type: 'simulation.output.interval' must be a quantity, not a list"},
    {"{channels: 3}", "8:53 wrong-type: 'simulation.output.channels' must be a list, not a scalar"},
    {"{channels: [[1]]}", "8:54 wrong-type: 'simulation.output.channels[0]' must be a word or text, not a list"},
    {"{channels: [body.rod.q]}", "8:54 unknown-name: no channel fits 'body.rod.q' | body.rod.x"},
    {"{channels: ['zz*']}", "8:54 unknown-name: no channel fits 'zz*'"},
    {"{frames: 3}", "8:51 wrong-type: 'simulation.output.frames' must be a list, not a scalar"},
    {"{frames: [rod/tap]}", "8:52 unknown-name: body 'rod' has no frame 'tap' | tip"},
    {"{frames: [[1]]}", "8:52 wrong-type: 'simulation.output.frames[0]' must be a name, not a list"},
    {"{frames: [rod/tip, rod/tip]}", ""},
    {"{format: [csv]}", "8:51 wrong-type: 'simulation.output.format' must be csv, hdf5 or both, not a list"},
    {"{format: cvs}", "8:51 wrong-type: 'simulation.output.format' must be csv, hdf5 or both, not 'cvs' | csv"},
    {"{format: hdf5}", ""},
    {"{rows_in_contact: -1}", "8:60 out-of-range: 'simulation.output.rows_in_contact' must be >= 0, not -1"},
    {"{rows_in_contact: 1e9}",
     "8:60 out-of-range: 'simulation.output.rows_in_contact' must be <= 1000, not 1000000000"},
    {"{rows_in_contact: [1]}", "8:60 wrong-type: 'simulation.output.rows_in_contact' must be a quantity, not a list"},
    {"{rows_in_contact: 1.5}", "8:60 wrong-type: 'simulation.output.rows_in_contact' must be an integer, not 1.5"},
    {"{discard: -1}", "8:52 out-of-range: 'simulation.output.discard' must be >= 0 s, not -1 s"},
    {"{discard: 2}",
     "8:52 no-statistics: statistics begin at 2 s, but the run ends at 1 s: its table and summary will have none; make "
     "'discard' smaller than the run is long"},
    {"{discard: [1]}", "8:52 wrong-type: 'simulation.output.discard' must be a quantity, not a list"},
    {"{discrad: 1}", "8:43 unknown-key: unknown key 'discrad' in 'simulation.output' | discard"},
};

constexpr Answer of_conditions[] = {
    {"3", "8:40 wrong-type: 'simulation.stop' must be a list, not a scalar"},
    {"t above 7 ms",
     "8:40 wrong-type: 'simulation.stop' is a condition in words | write a list of maps, as [{channel: time, above: 7 "
     "ms}]; where only a time is meant, 'end'"},
    {"[time > 7 ms]",
     "8:41 wrong-type: 'simulation.stop[0]' is a condition in words | write a list of maps, as [{channel: time, above: "
     "7 ms}]; where only a time is meant, 'end'"},
    {"[{value: t, above: 7 ms}]",
     "8:59 dimension-mismatch: the limit of 'output.stop1' must be of angle or number, not of time | in a formula t is "
     "a number of seconds; a time is limited by `channel: time`, or by `end`"},
    {"[3]", "8:41 wrong-type: 'simulation.stop[0]' must be a map, not a scalar"},
    {"[{}]",
     "8:41 missing-key: missing key 'channel' in 'simulation.stop[0]'\n8:41 missing-key: missing key 'above' in "
     "'simulation.stop[0]'"},
    {"[{channel: body.rod.x}]", "8:41 missing-key: missing key 'above' in 'simulation.stop[0]'"},
    {"[{above: 1}]", "8:41 missing-key: missing key 'channel' in 'simulation.stop[0]'"},
    {"[{channel: body.rod.x, value: body.rod.x, above: 1}]",
     "8:63 conflicting-keys: 'channel' and 'value' exclude each other"},
    {"[{channel: body.rod.x, above: 1, below: 2}]", "8:73 conflicting-keys: 'above' and 'below' exclude each other"},
    {"[{channel: [1], above: 1}]", "8:51 wrong-type: 'simulation.stop[0].channel' must be a word or text, not a list"},
    {"[{channel: body.rod.q, above: 1}]", "8:51 unknown-name: there is no channel 'body.rod.q' | body.rod.x"},
    {"[{channel: body.rod.x, above: 1 s}]",
     "8:70 dimension-mismatch: the limit of 'body.rod.x' must be of length, not of time"},
    {"[{channel: body.rod.x, above: [1]}]",
     "8:70 wrong-type: 'simulation.stop[0].above' must be a quantity, not a list"},
    {"[{value: body.rod.q, above: 1}]", "8:49 unknown-name: unknown channel 'body.rod.q' | body.rod.x"},
    {"[{value: [1], above: 1}]", "8:49 wrong-type: 'simulation.stop[0].value' must be a formula, not a list"},
    {"[{value: body.rod.x*2, below: 1 kg}]",
     "8:70 dimension-mismatch: the limit of 'output.stop1' must be of length, not of mass"},
    {"[{channel: body.rod.x, above: 1, after: 1 m}]",
     "8:80 dimension-mismatch: expected time, but this is length | write a unit such as 's'"},
    {"[{channel: body.rod.x, above: 1, aftr: 1 s}]",
     "8:73 unknown-key: unknown key 'aftr' in 'simulation.stop[0]' | after"},
    {"[{channel: body.rod.x, above: 1, after: 2 s}]", ""},
};

TEST(Answers, ToRuns) {
  expect_answers(swinging_rod + "@\n", of_runs);
  expect_answers(swinging_rod + "{end: 1, step: 1 ms, output: @}\n", of_outputs);
  expect_answers(swinging_rod + "{end: 1, step: 1 ms, stop: @}\n", of_conditions);
}

const std::string arms =
    "freeplay: 1\n"
    "templates:\n"
    "  arm:\n"
    "    parameters: {k: required, c: 2}\n"
    "    bodies: {rod: {mass: $k, inertia: 1, frames: {tip: [1, 0]}}}\n"
    "    joints: {pin: {type: revolute, between: [ground, rod]}}\n"
    "instances: {a: {template: arm, with: {k: 1}}}\n"
    "simulation: {end: 1, step: 1 ms}\n";

constexpr Answer of_instances[] = {
    {"3", "7:12 wrong-type: 'instances' must be a map, not a scalar"},
    {"{a: 3}", "7:16 wrong-type: 'instances.a' must be a map, not a scalar"},
    {"{a: {}}", "7:13 missing-key: missing key 'template' in 'instances.a'"},
    {"{a: {template: [arm]}}", "7:27 wrong-type: 'instances.a.template' must be a word or text, not a list"},
    {"{a: {template: amr, with: {k: 1}}}", "7:27 unknown-name: unknown template 'amr' | arm"},
    {"{a: {template: arm}}", "7:13 missing-key: missing key 'k' in 'instances.a.with'"},
    {"{a: {template: arm, with: 3}}", "7:38 wrong-type: 'instances.a.with' must be a map, not a scalar"},
    {"{a: {template: arm, with: {k: 1, z: 2}}}", "7:45 unknown-key: the template has no parameter 'z'"},
    {"{a: {template: arm, with: {k: [1]}}}", "7:42 wrong-type: 'instances.a.with.k' must be a quantity, not a list"},
    {"{a: {template: arm, count: 0, with: {k: 1}}}", "7:39 out-of-range: 'instances.a.count' must be >= 1, not 0"},
    {"{a: {template: arm, count: 1.5, with: {k: 1}}}",
     "7:39 wrong-type: 'instances.a.count' must be an integer, not 1.5"},
    {"{a: {template: arm, count: [2], with: {k: 1}}}",
     "7:39 wrong-type: 'instances.a.count' must be a quantity, not a list"},
    {"{a: {template: arm, count: 1e9, with: {k: 1}}}",
     "7:39 too-large: the model would have more than 200000 elements"},
    {"{a b: {template: arm, with: {k: 1}}}",
     "7:13 bad-name: 'a b' is not a valid name | a name has letters, digits, '_' and '-' and begins with a letter or "
     "'_'"},
    {"{a: {template: arm, with: {k: 1}, x: 3}}", "7:46 unknown-key: unknown key 'x' in 'instances.a'"},
    {"{a: {template: arm, with: {k: x}}}", "7:42 bad-expression: 'x' is not a number | exp"},
    {"{ground: {template: arm, with: {k: 1}}}",
     "4:31 unused: parameter 'c' is not used\n5:51 unused: frame 'tip' is not used"},
};

constexpr Answer of_templates[] = {
    {"parameters: 3",
     "4:17 wrong-type: 'templates.arm.parameters' must be a map, not a scalar\n5:26 unknown-name: unknown parameter "
     "'k'\n7:39 unknown-key: the template has no parameter 'k'"},
    {"parameters: {k: required, 1x: 2}",
     "4:31 bad-name: '1x' is not a valid name of a parameter | it has letters, digits and '_' and begins with a letter "
     "or '_'"},
    {"parameters: {k: required, t: 2}", "4:31 reserved-name: the parameter name 't' is reserved"},
    {"parameters: {k: [1]}", "5:51 unused: frame 'tip' is not used"},
    {"parameters: {k: $j}", "5:51 unused: frame 'tip' is not used"},
    {"parameters: {k: 1, pi: 3}", "4:24 reserved-name: the parameter name 'pi' is reserved"},
    {"bodees: {}",
     "4:5 unknown-key: unknown key 'bodees' in 'templates.arm' | bodies\n5:26 unknown-name: unknown parameter "
     "'k'\n7:39 unknown-key: the template has no parameter 'k'"},
    {"parameters: {k: required}\n    templates: {}", "5:5 unknown-key: unknown key 'templates' in 'templates.arm'"},
    {"x-note: 3\n    parameters: {k: required}", "6:51 unused: frame 'tip' is not used"},
};

constexpr Answer of_made_names[] = {
    {"rod", "4:31 unused: parameter 'c' is not used\n5:51 unused: frame 'tip' is not used"},
    {"rod{$c-1}", "6:54 unknown-name: unknown body 'rod1' | rod"},
    {"rod{$c-0.5}", "6:54 wrong-type: '{$c-0.5}' must be an integer, not 1.5"},
    {"rod{$c", "6:54 unknown-name: unknown body 'rod{$c' | rod"},
    {"rod{$q}", "6:59 unknown-name: unknown parameter 'q'"},
    {"rod{${c}-1}", "6:54 unknown-name: unknown body 'rod1' | rod"},
    {"rod{}", "6:59 bad-expression: a number or expression is missing"},
    {"rod{[1]}", "6:59 bad-expression: unexpected '['"},
};

TEST(Answers, ToTemplates) {
  expect_answers(test::replaced(arms, "{a: {template: arm, with: {k: 1}}}", "@"), of_instances);
  expect_answers(test::replaced(arms, "parameters: {k: required, c: 2}", "@"), of_templates);
  const std::string two = test::replaced(arms, "arm, with", "arm, count: 2, with");
  expect_answers(test::replaced(two, "ground, rod]", "ground, '@']"), of_made_names);
}

constexpr Answer of_presets[] = {
    {"3", "2:10 wrong-type: 'presets' must be a map, not a scalar\n3:21 unknown-name: unknown preset 'steel'"},
    {"{steel: 3}", "2:18 wrong-type: 'presets.steel' must be a map, not a scalar"},
    {"{steal: {mass: 1}}", "3:21 unknown-name: unknown preset 'steel' | steal"},
    {"{steel: {use: 3}}", "2:24 unknown-name: unknown preset '3'"},
    {"{steel: {use: [3]}}", "2:25 unknown-name: unknown preset '3'"},
    {"{steel: {use: [[3]]}}", "2:25 wrong-type: 'presets.steel.use[0]' must be a word or text, not a list"},
    {"{steel: {use: steel}}", "2:24 cyclic-preset: preset 'steel' uses itself"},
    {"{steel: {mas: 1}}", "2:19 unknown-key: unknown key 'mas' in 'presets.steel' | mass"},
    {"{steel: {use: {a: 1}}}", "2:24 wrong-type: 'presets.steel.use' must be a name or a list of names, not a map"},
    {"{a/b: {mass: 1}, steel: {mass: 1}}",
     "2:11 bad-name: 'a/b' is not a valid name | a name has letters, digits, '_' and '-' and begins with a letter or "
     "'_'"},
};

constexpr Answer of_parameters[] = {
    {"3", "2:13 wrong-type: 'parameters' must be a map, not a scalar\n3:22 unknown-name: unknown parameter 'm'"},
    {"{m: [1]}", "2:17 wrong-type: 'parameters.m' must be a quantity, not a list"},
    {"{m: }", "2:14 wrong-type: 'parameters.m' is empty; it must be a quantity"},
    {"{m: $m}", "2:14 cyclic-parameter: parameter 'm' depends on itself: m -> m"},
    {"{m: $a, a: $m}", "2:14 cyclic-parameter: parameter 'm' depends on itself: m -> a -> m"},
    {"{m: 1, b: 2}", "2:20 unused: parameter 'b' is not used"},
    {"{m: 1 kgg}", "2:19 bad-unit: 'kgg' is not a unit | kg"},
    {"{m: -1}", "3:22 out-of-range: 'bodies.rod.mass' must be > 0 kg, not -1 kg"},
    {"{m: 0}", "3:22 out-of-range: 'bodies.rod.mass' must be > 0 kg, not 0 kg"},
    {"{m: 1/0}", "2:18 bad-expression: division by zero"},
    {"{m: t}", "2:17 time-not-allowed: 't' is not allowed here: the value must be constant"},
    {"{1m: 1}",
     "2:14 bad-name: '1m' is not a valid name of a parameter | it has letters, digits and '_' and begins with a letter "
     "or '_'\n3:22 unknown-name: unknown parameter 'm' | 1m"},
    {"{m: 1, pi: 3}", "2:20 reserved-name: the parameter name 'pi' is reserved"},
    {"{m: nan}", "2:17 bad-number: a number must be finite"},
    {"{m: 1 kg + 1 m}", "2:17 dimension-mismatch: mass and length cannot be added or compared"},
    {"{m: $q}", "2:17 unknown-name: unknown parameter 'q'"},
    {"{m: ${n}, n: 1 kg}", "2:13 yaml-syntax: this '{' is not closed before the text goes on | add '}' or a comma"},
};

TEST(Answers, ToPresetsAndParameters) {
  expect_answers(
      "freeplay: 1\npresets: @\nbodies: {rod: {use: steel, mass: 1, inertia: 1}}\nsimulation: {end: 1, step: 1 ms}\n",
      of_presets);
  expect_answers(
      "freeplay: 1\nparameters: @\nbodies: {rod: {mass: $m, inertia: 1}}\nsimulation: {end: 1, step: 1 ms}\n",
      of_parameters);
}

}  // namespace
}  // namespace freeplay
