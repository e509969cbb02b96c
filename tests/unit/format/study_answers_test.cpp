// Mistakes in the section `study` of a model that is sound otherwise.
#include "answers.h"

namespace freeplay {
namespace {

const std::string studied_ball =
    "freeplay: 1\n"
    "parameters: {g: 9.81 m/s^2, v: 0 m/s}\n"
    "gravity: [0, -$g]\n"
    "bodies: {ball: {mass: 1 kg, inertia: 0.1, velocity: {linear: [$v, 0]}}}\n"
    "simulation: {end: 0.1 s, step: 10 ms}\n";
const std::string sampled = "sample: {method: random, points: 3, seed: 1}";
const std::string highest = "reducers: {y: {channel: body.ball.y, reduce: max}";

constexpr Answer of_axes[] = {
    {"[]", "6:19 wrong-length: 'study.axes.a' must have at least 1 item"},
    {"", "6:16 wrong-type: 'study.axes.a' is empty; it must be a value or a list of values"},
    {"[1, null]", "6:16 unknown-name: unknown parameter 'a'\n6:31 unused: no axis is random: `sample` is not used"},
    {"{}",
     "6:16 missing-key: 'study.axes.a' says no values | one of linspace, logspace, list, cases, table, normal, "
     "uniform, triangular or fit"},
    {"{truncate: [1, 2]}",
     "6:16 missing-key: 'study.axes.a' says no values | one of linspace, logspace, list, cases, table, normal, "
     "uniform, triangular or fit"},
    {"{target: g, each: g, list: [1]}", "6:31 conflicting-keys: 'target' and 'each' exclude each other"},
    {"{target: [g], list: [1]}", "6:28 wrong-type: 'study.axes.a.target' must be a word or text, not a list"},
    {"{each: '', list: [1]}", "6:26 wrong-type: 'study.axes.a.each' must not be empty"},
    {"{target: '', list: [1]}", "6:28 wrong-type: 'study.axes.a.target' must not be empty"},
    {"{target: g, list: [1], linspace: [0, 1, 2]}", "6:31 conflicting-keys: 'linspace' and 'list' exclude each other"},
    {"{cases: {}}", "6:27 wrong-length: there is no case"},
    {"{cases: 3}", "6:27 wrong-type: 'study.axes.a.cases' must be a map, not a scalar"},
    {"{cases: {b: 3}}", "6:31 wrong-type: 'study.axes.a.cases.b' must be a map, not a scalar"},
    {"{cases: {b: {g: }}}", "6:32 wrong-type: 'study.axes.a.cases.b.g' is empty; it must be a value"},
    {"{cases: {' b': {g: 1}}}",
     "6:28 bad-name: ' b' cannot stand in a table | a name without commas, quotes and line feeds, and no blank at its "
     "ends\n6:45 unused: no axis is random: `sample` is not used"},
    {"{cases: {'': {g: 1}}}",
     "6:28 bad-name: '' cannot stand in a table | a name without commas, quotes and line feeds, and no blank at its "
     "ends\n6:43 unused: no axis is random: `sample` is not used"},
    {"{cases: {'b,': {g: 1}}}",
     "6:28 bad-name: 'b,' cannot stand in a table | a name without commas, quotes and line feeds, and no blank at its "
     "ends\n6:45 unused: no axis is random: `sample` is not used"},
    {"{target: g, cases: {b: {g: 1}}}", "6:20 conflicting-keys: 'cases' and 'target' exclude each other"},
    {"{each: g, cases: {b: {g: 1}}}", "6:20 conflicting-keys: 'cases' and 'each' exclude each other"},
    {"{table: [3]}", "6:27 wrong-type: 'study.axes.a.table' must be a word or text, not a list"},
    {"{target: g, table: t.csv}", "6:20 conflicting-keys: 'table' and 'target' exclude each other"},
    {"{target: g, linspace: [0, 1]}", "6:41 wrong-length: 'study.axes.a.linspace' must have 3 items, not 2"},
    {"{target: g, logspace: [0, 1, 3]}",
     "6:42 out-of-range: 'study.axes.a.logspace[0]' must be > 0 m/s^2, not 0 m/s^2"},
    {"{target: g, linspace: [0, 1 kg, 3]}",
     "6:45 dimension-mismatch: expected acceleration, but this is mass | write a unit such as 'm/s^2'"},
    {"{where_present: 3, target: g, list: [1]}",
     "6:35 wrong-type: 'study.axes.a.where_present' must be true or false, not '3'\n6:62 unused: no axis is random: "
     "`sample` is not used"},
    {"{target: g, normal: [1 m/s^2, 0]}", "6:49 out-of-range: the standard deviation must be > 0"},
    {"{target: g, normal: [1 m/s^2, -1]}", "6:49 out-of-range: the standard deviation must be > 0"},
    {"{target: g, uniform: [2, 1]}", "6:44 out-of-range: the high end must be above the low one"},
    {"{target: g, uniform: [2]}", "6:40 wrong-length: 'study.axes.a.uniform' must have 2 items, not 1"},
    {"{target: g, uniform: 3}", "6:40 wrong-type: 'study.axes.a.uniform' must be a list of 2, not a scalar"},
    {"{target: g, triangular: [1, 0, 2]}", "6:47 out-of-range: a triangle is [low, mode, high], in this order"},
    {"{target: g, triangular: [1, 3, 2]}", "6:47 out-of-range: a triangle is [low, mode, high], in this order"},
    {"{target: g, triangular: [1, 1, 1]}", "6:47 out-of-range: a triangle is [low, mode, high], in this order"},
    {"{target: g, triangular: [1, [2], 3]}",
     "6:47 wrong-type: 'study.axes.a.triangular[1]' must be a quantity, not a list"},
    {"{target: g, uniform: [1, 2], truncate: [3, 4]}",
     "6:58 out-of-range: all values are between 1 and 2: nothing is left"},
    {"{target: g, uniform: [1, 2], truncate: [0, 1]}",
     "6:58 out-of-range: all values are between 1 and 2: nothing is left"},
    {"{target: g, normal: [1, 2], truncate: [2, 1]}", "6:61 out-of-range: the high end must be above the low one"},
    {"{target: g, triangular: [1, 2, 3], truncate: [4, 5]}",
     "6:64 out-of-range: all values are between 1 and 3: nothing is left"},
    {"{target: g, normal: [1, 2], truncate: 3}",
     "6:57 wrong-type: 'study.axes.a.truncate' must be a list of 2, not a scalar"},
    {"{target: g, normal: [1 kg, 2], truncate: [0, 1]}",
     "6:40 dimension-mismatch: expected acceleration, but this is mass | write a unit such as 'm/s^2'"},
    {"{target: b, uniform: [1 kg, 2 m]}",
     "6:47 dimension-mismatch: expected mass, but this is length | write a unit such as 'kg'"},
    {"{target: g, normal: [1, 2], truncate: [0, 1 kg]}",
     "6:61 dimension-mismatch: expected acceleration, but this is mass | write a unit such as 'm/s^2'"},
};

constexpr Answer of_fits[] = {
    {"{fit: H7/g6}", "6:16 missing-key: missing key 'diameter' in 'study.axes.a'"},
    {"{fit: {x: 1}, diameter: 10 mm}",
     "6:25 wrong-type: 'study.axes.a.fit' must be a name or a list of names, not a map"},
    {"{fit: [], diameter: 10 mm}", "6:25 wrong-length: 'study.axes.a.fit' must have at least 1 item"},
    {"{fit: [[1]], diameter: 10 mm}", "6:26 wrong-type: 'study.axes.a.fit[0]' must be a word or text, not a list"},
    {"{fit: H7/g6, diameter: 0}", "6:42 out-of-range: 'study.axes.a.diameter' must be > 0 m, not 0 m"},
    {"{fit: H7/g6, diameter: 10 mm, law: beta}",
     "6:54 wrong-type: 'study.axes.a.law' must be normal or uniform, not 'beta'"},
    {"{fit: H7/g6, diameter: 10 mm, truncate: [2 um, 1 um]}",
     "6:66 out-of-range: the high end must be above the low one"},
    {"{fit: H7/g6, diameter: 10 mm, truncate: [20 um, 30 um]}",
     "6:59 out-of-range: the radial clearance of H7/g6 is 2.5 to 14.5 um: nothing is left"},
    {"{fit: H7/g6, diameter: 10 mm, truncate: [1 um, 2 um]}",
     "6:59 out-of-range: the radial clearance of H7/g6 is 2.5 to 14.5 um: nothing is left"},
    {"{fit: H7/h6, diameter: 10 mm}",
     "6:25 out-of-range: the radial clearance of H7/h6 on 10 mm is 0 to 12 um; it must be > 0 | another fit, or "
     "`truncate: [low, high]`"},
    {"{target: g, fit: [H7/g6, H7/g6], diameter: 10 mm}", "6:44 duplicate-name: 'H7/g6' stands there twice"},
    {"{fit: Q7/g6, diameter: 10 mm}",
     "6:25 bad-fit: 'Q7/g6' on 10 mm is no fit that is known | holes D to H and JS, shafts d to h and js, grades 5 to "
     "11, up to 500 mm, such as H7/g6"},
    {"{fit: H7/g6, diameter: 600 mm}",
     "6:25 bad-fit: 'H7/g6' on 600 mm is no fit that is known | holes D to H and JS, shafts d to h and js, grades 5 to "
     "11, up to 500 mm, such as H7/g6"},
    {"{fit: H7/g6, diameter: 10 mm, truncate: 3}",
     "6:59 wrong-type: 'study.axes.a.truncate' must be a list of 2, not a scalar"},
    {"{fit: H7-g6, diameter: 10 mm}",
     "6:25 bad-fit: 'H7-g6' on 10 mm is no fit that is known | holes D to H and JS, shafts d to h and js, grades 5 to "
     "11, up to 500 mm, such as H7/g6"},
    {"{fit: H4/g6, diameter: 10 mm}",
     "6:25 bad-fit: 'H4/g6' on 10 mm is no fit that is known | holes D to H and JS, shafts d to h and js, grades 5 to "
     "11, up to 500 mm, such as H7/g6"},
    {"{fit: H7/q6, diameter: 10 mm}",
     "6:25 bad-fit: 'H7/q6' on 10 mm is no fit that is known | holes D to H and JS, shafts d to h and js, grades 5 to "
     "11, up to 500 mm, such as H7/g6"},
    {"{fit: H7/g12, diameter: 10 mm}",
     "6:25 bad-fit: 'H7/g12' on 10 mm is no fit that is known | holes D to H and JS, shafts d to h and js, grades 5 to "
     "11, up to 500 mm, such as H7/g6"},
    {"{fit: JS7/js6, diameter: 10 mm}",
     "6:25 out-of-range: the radial clearance of JS7/js6 on 10 mm is -6 to 6 um; it must be > 0 | another fit, or "
     "`truncate: [low, high]`"},
    {"{fit: H7/g, diameter: 10 mm}",
     "6:25 bad-fit: 'H7/g' on 10 mm is no fit that is known | holes D to H and JS, shafts d to h and js, grades 5 to "
     "11, up to 500 mm, such as H7/g6"},
    {"{fit: /g6, diameter: 10 mm}",
     "6:25 bad-fit: '/g6' on 10 mm is no fit that is known | holes D to H and JS, shafts d to h and js, grades 5 to "
     "11, up to 500 mm, such as H7/g6"},
    {"{fit: H7/, diameter: 10 mm}",
     "6:25 bad-fit: 'H7/' on 10 mm is no fit that is known | holes D to H and JS, shafts d to h and js, grades 5 to "
     "11, up to 500 mm, such as H7/g6"},
};

TEST(Answers, ToAxesOfStudies) {
  expect_answers(studied_ball + "study: {axes: {a: @}, " + sampled + "}\n", of_axes);
  expect_answers(studied_ball + "study: {axes: {a: @}, " + sampled + "}\n", of_fits);
}

constexpr Answer of_studies[] = {
    {"models: [a.yaml], axes: {g: [1]}",
     "6:9 conflicting-keys: a study that stands in a model is of that model | give the study a file of its own"},
    {"set: 3", "6:14 wrong-type: 'study.set' must be a map, not a scalar"},
    {"set: {g: }", "6:15 wrong-type: 'study.set.g' is empty; it must be a value"},
    {"axes: 3", "6:15 wrong-type: 'study.axes' must be a map, not a scalar"},
    {"axes: ", ""},
    {"axes: {g: [1], v: [1]}, combine: grip",
     "6:42 wrong-type: 'study.combine' must be grid, zip or star, not 'grip' | grid"},
    {"axes: {g: {uniform: [1, 2]}}, combine: star, sample: {method: random, points: 3, seed: 1}",
     "6:48 conflicting-keys: random axes have no values to take one at a time"},
    {"axes: {g: [1], v: [1]}, combine: zip, zip: [[g, v]]",
     "6:47 conflicting-keys: `zip` names axes of a grid; `combine` is no grid"},
    {"axes: {g: [1], v: [1]}, zip: 3", "6:38 wrong-type: 'study.zip' must be a list, not a scalar"},
    {"axes: {g: [1], v: [1]}, zip: [3]", "6:39 wrong-type: 'study.zip[0]' must be a list, not a scalar"},
    {"axes: {g: [1], v: [1]}, zip: [[g, w]]", "6:43 unknown-name: unknown axis 'w'"},
    {"axes: {g: [1], v: [1]}, zip: [[g, [v]]]",
     "6:43 wrong-type: 'study.zip[0][1]' must be a word or text, not a list"},
    {"axes: {g: [1], v: [1]}, zip: [[g, g]]",
     "6:43 duplicate-name: the axis 'g' goes side by side with others already"},
    {"axes: {g: [1], v: [1]}, zip: [[g, v], [v, g]]",
     "6:48 duplicate-name: the axis 'v' goes side by side with others already\n6:51 duplicate-name: the axis 'g' goes "
     "side by side with others already"},
    {"axes: {g: {uniform: [1, 2]}, v: [1]}, zip: [[g, v]], sample: {method: random, points: 3, seed: 1}",
     "6:54 conflicting-keys: the values of a random axis follow the samples"},
    {"axes: {g: {uniform: [1, 2]}}",
     "6:16 missing-key: the axis 'g' is random: the study needs `sample` | sample: {method: latin-hypercube, points: "
     "1000, seed: 1}"},
    {"axes: {g: [1]}, sample: {method: random, points: 3, seed: 1}",
     "6:25 unused: no axis is random: `sample` is not used"},
    {"axes: {g: {uniform: [1, 2]}}, sample: {method: dice, points: 3, seed: 1}",
     "6:56 wrong-type: 'study.sample.method' must be random, latin-hypercube or sobol, not 'dice'"},
    {"axes: {g: {uniform: [1, 2]}}, sample: {method: random, points: 0, seed: 1}",
     "6:72 out-of-range: 'study.sample.points' must be >= 1, not 0"},
    {"axes: {g: {uniform: [1, 2]}}, sample: {method: random, points: 3, seed: -1}",
     "6:81 out-of-range: 'study.sample.seed' must be >= 0, not -1"},
    {"axes: {g: {uniform: [1, 2]}}, sample: {method: random, points: 3, seed: [1]}",
     "6:81 wrong-type: 'study.sample.seed' must be a quantity, not a list"},
    {"axes: {g: {uniform: [1, 2]}}, sample: {method: random, points: 3, seed: 99999999999999999999}",
     "6:81 out-of-range: 'study.sample.seed' must be <= 9223372036854775807, not 99999999999999999999"},
    {"axes: {g: {uniform: [1, 2]}}, sample: {method: random, points: 3, seed: 1.5}",
     "6:81 wrong-type: 'study.sample.seed' must be an integer, not 1.5"},
    {"axes: {g: {uniform: [1, 2]}}, sample: {}",
     "6:39 missing-key: missing key 'method' in 'study.sample'\n6:39 missing-key: missing key 'points' in "
     "'study.sample'\n6:39 missing-key: missing key 'seed' in 'study.sample'"},
    {"axes: {g: {uniform: [1, 2]}}, sample: 3", "6:47 wrong-type: 'study.sample' must be a map, not a scalar"},
    {"do: ran", "6:13 wrong-type: 'study.do' must be run, not 'ran' | run"},
    {"do: {analyze: errors}",
     "6:23 wrong-type: 'study.do.analyze' must be ik, workspace, singularity, error or inverse-dynamics, not 'errors' "
     "| error"},
    {"do: [1]", "6:13 wrong-type: 'study.do' must be run, not a list"},
    {"axes: {g: [1]}, warm_start: {along: v}", "6:45 unknown-name: unknown axis 'v'"},
    {"axes: {g: [1]}, warm_start: {direction: up}", "6:25 missing-key: missing key 'along' in 'study.warm_start'"},
    {"axes: {g: [1]}, warm_start: {along: g, direction: left}",
     "6:59 wrong-type: 'study.warm_start.direction' must be up, down or both, not 'left'"},
    {"axes: {g: [1]}, warm_start: {along: g, pieces: 0}",
     "6:56 out-of-range: 'study.warm_start.pieces' must be >= 1, not 0"},
    {"axes: {g: [1]}, warm_start: {along: [g]}",
     "6:45 wrong-type: 'study.warm_start.along' must be a word or text, not a list"},
    {"axes: {g: {uniform: [1, 2]}}, sample: {method: random, points: 3, seed: 1}, warm_start: {along: g}",
     "6:105 conflicting-keys: a random axis has no order to go along | an axis with a grid"},
    {"axes: {g: [1], v: [1]}, combine: star, warm_start: {along: g}",
     "6:68 conflicting-keys: with `combine: star` there is no way along an axis"},
    {"axes: {g: [1]}, do: {analyze: error}, warm_start: {along: g}",
     "6:47 conflicting-keys: points that are analyses have no end to begin from"},
    {"axes: {g: [1]}, warm_start: 3", "6:37 wrong-type: 'study.warm_start' must be a map, not a scalar"},
    {"axes: {g: [1]}, reducers: 3", "6:35 wrong-type: 'study.reducers' must be a map, not a scalar"},
    {"axes: {g: [1]}, reducers: {a b: {channel: body.ball.x, reduce: max}}",
     "6:36 bad-name: 'a b' is not a valid name | a name has letters, digits, '_' and '-' and begins with a letter or "
     "'_'"},
    {"axes: {g: [1]}, reducers: {a: {channel: body.ball.x, reduce: maks}}",
     "6:70 wrong-type: 'study.reducers.a.reduce' must be min, max, absmax, first, final, peak-to-peak, mean, rms, std, "
     "percentile, median, time-fraction, count or poincare, not 'maks' | max"},
    {"name: [1]", "6:15 wrong-type: 'study.name' must be a word or text, not a list"},
    {"description: [1]", "6:22 wrong-type: 'study.description' must be a word or text, not a list"},
    {"models: ",
     "6:9 conflicting-keys: a study that stands in a model is of that model | give the study a file of its own"},
    {"zip: [[g]]", "6:16 unknown-name: unknown axis 'g'"},
    {"combine: [zip]", "6:18 wrong-type: 'study.combine' must be grid, zip or star, not a list"},
};

constexpr Answer of_ended_samples[] = {
    {"axes: {g: [1]}, reducers: {y: {channel: body.ball.y, reduce: max}}, stop: {reducer: y, of: mean, relative: 0.1}",
     "6:77 conflicting-keys: no axis is random: there are no samples to end"},
    {"axes: {g: {uniform: [1, 2]}}, sample: {method: sobol, points: 3, seed: 1}, reducers: {y: {channel: body.ball.y, "
     "reduce: max}}, stop: {reducer: y, of: mean, relative: 0.1}",
     "6:136 conflicting-keys: only samples of `method: random` can end early"},
    {"axes: {g: {uniform: [1, 2]}}, sample: {method: random, points: 3, seed: 1}, stop: {reducer: y, of: mean, "
     "relative: 0.1}",
     "6:101 unknown-name: unknown reducer 'y'"},
};

TEST(Answers, ToStudies) {
  expect_answers(studied_ball + "study: {@}\n", of_studies);
  expect_answers(studied_ball + "study: {@}\n", of_ended_samples);
}

constexpr Answer of_stops[] = {
    {"3", "6:143 wrong-type: 'study.stop' must be a map, not a scalar"},
    {"{}",
     "6:137 missing-key: missing key 'reducer' in 'study.stop'\n6:137 missing-key: missing key 'of' in "
     "'study.stop'\n6:137 missing-key: missing key 'half_width' in 'study.stop'"},
    {"{reducer: x, of: mean, relative: 0.1}", "6:153 unknown-name: unknown reducer 'x'"},
    {"{reducer: [y], of: mean, relative: 0.1}",
     "6:153 wrong-type: 'study.stop.reducer' must be a word or text, not a list"},
    {"{reducer: y, of: p0, relative: 0.1}",
     "6:160 wrong-type: 'of' is mean or a percentile such as p50 or p99, not 'p0'"},
    {"{reducer: y, of: p100, relative: 0.1}",
     "6:160 wrong-type: 'of' is mean or a percentile such as p50 or p99, not 'p100'"},
    {"{reducer: y, of: p, relative: 0.1}",
     "6:160 wrong-type: 'of' is mean or a percentile such as p50 or p99, not 'p'"},
    {"{reducer: y, of: q5, relative: 0.1}",
     "6:160 wrong-type: 'of' is mean or a percentile such as p50 or p99, not 'q5'"},
    {"{reducer: y, of: p5x, relative: 0.1}",
     "6:160 wrong-type: 'of' is mean or a percentile such as p50 or p99, not 'p5x'"},
    {"{reducer: y, of: [1], relative: 0.1}", "6:160 wrong-type: 'study.stop.of' must be a word or text, not a list"},
    {"{reducer: y, of: mean, relative: 0}", "6:176 out-of-range: 'study.stop.relative' must be > 0, not 0"},
    {"{reducer: y, of: mean, half_width: 0}", "6:178 out-of-range: 'half_width' must be > 0"},
    {"{reducer: y, of: mean, half_width: [1]}",
     "6:178 wrong-type: 'study.stop.half_width' must be a quantity, not a list"},
    {"{reducer: y, of: mean, half_width: 1 mm, relative: 0.1}",
     "6:184 conflicting-keys: 'half_width' and 'relative' exclude each other"},
    {"{reducer: y, of: mean}", "6:137 missing-key: missing key 'half_width' in 'study.stop'"},
    {"{reducer: y, of: mean, relative: 0.1, confidence: 1}",
     "6:193 out-of-range: 'study.stop.confidence' must be > 0 and < 1, not 1"},
    {"{reducer: y, of: mean, relative: 0.1, min_points: 1}",
     "6:193 out-of-range: 'study.stop.min_points' must be >= 2, not 1"},
    {"{reducer: y, of: mean, relative: 0.1, block: 0}", "6:188 out-of-range: 'study.stop.block' must be >= 1, not 0"},
};

constexpr Answer of_plots[] = {
    {"3", "6:145 wrong-type: 'study.plots.p' must be a map, not a scalar"},
    {"{}", "6:142 missing-key: missing key 'kind' in 'study.plots.p'"},
    {"{kind: lines}",
     "6:152 wrong-type: 'study.plots.p.kind' must be line, heat, bifurcation, histogram or tornado, not 'lines' | "
     "line"},
    {"{kind: line, x: g}", "6:142 missing-key: missing key 'y' in 'study.plots.p'"},
    {"{kind: line, x: [g], y: y}", "6:161 wrong-type: 'study.plots.p.x' must be a word or text, not a list"},
    {"{kind: line, x: gg, y: y}", "6:161 unknown-name: unknown axis 'gg' | g"},
    {"{kind: line, x: g, y: yy}", "6:167 unknown-name: unknown axis or reducer 'yy' | y"},
    {"{kind: line, x: g, y: y, by: v}", "6:174 unknown-name: unknown axis 'v'"},
    {"{kind: line, x: g, y: y, value: y}", "6:170 unused: a plot of kind line does not look at 'value'"},
    {"{kind: heat, x: g, y: g, value: y, by: model}", "6:180 unused: a plot of kind heat does not look at 'by'"},
    {"{kind: histogram, value: y, x: g, percentiles: [101]}",
     "6:173 unused: a plot of kind histogram does not look at 'x'\n6:193 out-of-range: 'study.plots.p.percentiles[0]' "
     "must be >= 0 and <= 100, not 101"},
    {"{kind: histogram, value: y, percentiles: 3}",
     "6:186 wrong-type: 'study.plots.p.percentiles' must be a list, not a scalar"},
    {"{kind: line, x: g, y: y, percentiles: [5]}", "6:170 unused: a plot of kind line does not look at 'percentiles'"},
    {"{kind: bifurcation, x: g, y: g, value: z}", "6:171 unused: a plot of kind bifurcation does not look at 'y'"},
    {"{kind: bifurcation, x: g, value: y}",
     "6:178 wrong-type: a bifurcation shows a reducer of `reduce: poincare`; 'y' is none"},
    {"{kind: tornado, y: y, value: y}", "6:161 unused: a plot of kind tornado does not look at 'y'"},
    {"{kind: tornado, value: y, by: g}", "6:171 unused: a plot of kind tornado does not look at 'by'"},
};

TEST(Answers, ToStopsAndPlotsOfStudies) {
  expect_answers(studied_ball + "study: {axes: {g: {uniform: [1, 2]}}, " + sampled + ", " + highest + "}, stop: @}\n",
                 of_stops);
  expect_answers(studied_ball + "study: {axes: {g: [1]}, " + highest +
                     ", z: {channel: body.ball.y, reduce: poincare, every: 1 s}}, plots: {p: @}}\n",
                 of_plots);
}

}  // namespace
}  // namespace freeplay
