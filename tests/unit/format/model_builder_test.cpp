#include "format/model_builder.h"

#include <gtest/gtest.h>

#include "model_text.h"

namespace freeplay {
namespace {

TEST(ModelBuilder, BuildsTheSmallestModel) {
  const Built built = build(with_rod("joints:\n  a: {type: pin, between: [ground, rod/tip]}\n"));
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_EQ(built.report, "");
  const Model& model = *built.model;
  EXPECT_EQ(model.name, "m");
  ASSERT_EQ(model.bodies.size(), 1u);
  ASSERT_EQ(model.joints.size(), 1u);
  EXPECT_EQ(model.joints[0].location.line, 5);
  EXPECT_EQ(model.joints[0].layout.coordinate, Coordinate::angle);
  EXPECT_EQ(model.markers[static_cast<std::size_t>(model.joints[0].marker_a)].name, "ground/origin");
  EXPECT_EQ(model.markers[static_cast<std::size_t>(model.joints[0].marker_b)].name, "rod/tip");
  EXPECT_DOUBLE_EQ(model.markers[static_cast<std::size_t>(model.joints[0].marker_b)].position[0], 1.0);
  EXPECT_DOUBLE_EQ(model.settings.interval, 1e-3);
  EXPECT_TRUE(model.settings.integrator);
  EXPECT_STREQ(model.settings.integrator_parameters.component->description.name, "stepper");
}

TEST(ModelBuilder, ReadsBodies) {
  const Built built = build(
      "freeplay: 1\n"
      "gravity: [0, -9.81]\n"
      "bodies:\n"
      "  a: {mass: 2 kg, inertia: 3 kg*m^2, com: [1 mm, 2 mm], pose: {position: [1, 2], angle: 90 deg},\n"
      "      velocity: {linear: [3, 4], angular: 60 rpm}}\n"
      "  b: {mass: 1, inertia: 0}\n"
      "forces:\n"
      "  g: {type: gravity, on: [b*], value: [1, 0]}\n");
  ASSERT_TRUE(built.model) << built.report;
  const Body& a = built.model->bodies[0];
  EXPECT_DOUBLE_EQ(a.inertia[8], 3.0);
  EXPECT_DOUBLE_EQ(a.com[1], 0.002);
  EXPECT_DOUBLE_EQ(a.angle.value(), 1.5707963267948966);
  EXPECT_DOUBLE_EQ(a.position.value()[1], 2.0);
  EXPECT_DOUBLE_EQ(a.velocity[1], 4.0);
  EXPECT_DOUBLE_EQ(a.angular_velocity[2], 6.283185307179586);
  EXPECT_DOUBLE_EQ(a.gravity[1], -9.81);
  EXPECT_FALSE(built.model->bodies[1].position.has_value());
  EXPECT_DOUBLE_EQ(built.model->bodies[1].gravity[0], 1.0);
  EXPECT_DOUBLE_EQ(built.model->bodies[1].gravity[1], 0.0);
}

TEST(ModelBuilder, PrintsAnUnknownKeyWithASuggestion) {
  const Built built = build("freeplay: 1\nbodies:\n  crank: {mass: 0.2 kg, intertia: 1e-4, inertia: 1}\n");
  EXPECT_FALSE(built.model);
  EXPECT_EQ(built.report,
            "m.yaml:3:25: error: unknown key 'intertia' in 'bodies.crank' [unknown-key]\n"
            "    3 |   crank: {mass: 0.2 kg, intertia: 1e-4, inertia: 1}\n"
            "      |                         ^~~~~~~~\n"
            "      = did you mean 'inertia'?\n");
}

TEST(ModelBuilder, PrintsWhatIsWrongInsideAnExpression) {
  const Built built = build("freeplay: 1\nbodies:\n  crank: {mass: 2 kg + 3 gramm, inertia: 1}\n");
  EXPECT_EQ(built.places, "3:26 bad-unit ");
}

TEST(ModelBuilder, ReportsAllMistakesAtOnceAndNoConsequences) {
  const Built built = build(
      "freeplay: 1\n"
      "name: []\n"
      "gravity: [0]\n"
      "parameters: {l: 1 q, k: $l, t: 1}\n"
      "bodies:\n"
      "  a: {mass: 0, inertia: -1, com: 5, frames: {tip: [$l, $k], com: [0, 0]}}\n"
      "  b: {mas: 1, inertia: 1}\n"
      "  4c: {mass: t, inertia: 1 kg}\n"
      "joints:\n"
      "  j: {type: pinn, between: [a/tip, b/tap]}\n"
      "  k: {type: pin, between: [a, a/tip]}\n"
      "drivers:\n"
      "  m: {joint: j, kind: angle, value: 1}\n"
      "  n: {joint: k, kind: position, value: 1}\n"
      "initial: {joints: {j: 1, x: 2}}\n");
  EXPECT_FALSE(built.model);
  EXPECT_EQ(built.places,
            "2:7 wrong-type 3:10 wrong-length 4:19 bad-unit 4:29 reserved-name "
            "6:13 out-of-range 6:25 out-of-range 6:34 wrong-type 6:61 reserved-name "
            "7:3 missing-key 7:7 unknown-key 8:3 bad-name 8:14 time-not-allowed 8:26 dimension-mismatch "
            "10:13 unknown-type 10:36 unknown-name 11:27 same-body 14:23 wrong-type 15:26 unknown-name ")
      << built.report;
}

struct Mistake {
  const char* name;
  const char* text;  ///< from line 4 on
  const char* places;
};
void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class Mistakes : public testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, AreReportedAtTheirPlace) {
  const Built built = build(with_rod(GetParam().text));
  EXPECT_FALSE(built.model);
  EXPECT_EQ(built.places, GetParam().places) << built.report;
}

INSTANTIATE_TEST_SUITE_P(
    TopLevel, Mistakes,
    testing::Values(Mistake{"unknown section", "simulaton: {}\n", "4:1 unknown-key "},
                    Mistake{"section is no map", "joints: 5\n", "4:9 wrong-type "},
                    Mistake{"wrong space", "space: plannar\n", "4:8 wrong-type "},
                    Mistake{"spatial", "space: spatial\nxx: 1\n", "3:27 wrong-type 3:44 wrong-length 5:1 unknown-key "},
                    Mistake{"urdf", "urdf: a.urdf\n", "4:1 unknown-key "},
                    Mistake{"bad frame key", "frames: {rod: [0, 0]}\n", "4:10 bad-name "},
                    Mistake{"frame twice", "frames: {rod/tip: [0, 0]}\n", "4:10 duplicate-name "},
                    Mistake{"frame of nobody", "frames: {rood/tip: [0, 0]}\n", "4:10 unknown-name "},
                    Mistake{"polar and position", "frames: {rod/a: {position: [0, 0], polar: [1, 0]}}\n",
                            "4:36 conflicting-keys "},
                    Mistake{"spatial frame", "frames: {rod/a: {rpy: [0, 0, 0]}}\n", "4:18 unknown-key "},
                    Mistake{"cut expression", "initial: {assembly: {tolerance: max(1, 2)}}\n",
                            "4:36 bad-expression 4:40 unknown-key "}));

INSTANTIATE_TEST_SUITE_P(
    Joints, Mistakes,
    testing::Values(
        Mistake{"no type", "joints:\n  a: {between: [ground, rod]}\n", "5:3 missing-key "},
        Mistake{"no ends", "joints:\n  a: {type: pin}\n", "5:3 missing-key "},
        Mistake{"one end", "joints:\n  a: {type: pin, ring: ground}\n", "5:3 missing-key "},
        Mistake{"both sorts of ends", "joints:\n  a: {type: pin, between: [ground, rod], ring: ground}\n",
                "5:42 conflicting-keys "},
        Mistake{"ends of another type", "joints:\n  a: {type: slide, between: [ground, rod], ring: rod}\n",
                "5:44 unknown-key "},
        Mistake{"three ends", "joints:\n  a: {type: pin, between: [ground, rod, rod]}\n", "5:27 wrong-length "},
        Mistake{"spatial type", "joints:\n  a: {type: ball, between: [ground, rod]}\n", "5:13 type-space "},
        Mistake{"block of another type", "joints:\n  a: {type: slide, between: [ground, rod], play: {gap: 1}}\n",
                "5:44 unknown-key "},
        Mistake{"misspelt block", "joints:\n  a: {type: pin, between: [ground, rod], plai: {gap: 1}}\n",
                "5:42 unknown-key "},
        Mistake{"twin without block", "joints:\n  a: {type: loose-pin, between: [ground, rod]}\n", "5:3 missing-key "},
        Mistake{"no law", "joints:\n  a: {type: pin, between: [ground, rod], play: {gap: 1 mm}}\n",
                "5:42 missing-key "},
        Mistake{"unknown law", "joints:\n  a: {type: pin, between: [ground, rod], play: {gap: 1, contact: pover}}\n",
                "5:66 unknown-type "},
        Mistake{"law without parameter",
                "joints:\n  a: {type: pin, between: [ground, rod], play: {gap: 1, contact: power}}\n",
                "5:57 missing-key "},
        Mistake{"key of a law",
                "joints:\n  a: {type: pin, between: [ground, rod], play: {gap: 1, contact: {law: power,\n"
                "    K: 1e9, ex: 2}}}\n",
                "6:13 unknown-key "},
        Mistake{"unit with exponent",
                "joints:\n  a: {type: pin, between: [ground, rod], play: {gap: 1, contact: {law: power,\n"
                "    K: 1 N/m^1.5, exponent: 2}}}\n",
                "6:8 dimension-mismatch "},
        Mistake{"nested range",
                "joints:\n  a: {type: pin, between: [ground, rod], play: {gap: 1, contact: {law: power, K: 1},\n"
                "    material: {nu: 0.5}}}\n",
                "6:20 out-of-range "},
        Mistake{"word or map",
                "joints:\n  a: {type: pin, between: [ground, rod], play: {gap: 1, contact: {law: power,\n"
                "    K: 1}, initial: loadet}}\n",
                "6:21 wrong-type "},
        Mistake{"key in place of the word",
                "joints:\n  a: {type: pin, between: [ground, rod], play: {gap: 1, contact: {law: power,\n"
                "    K: 1}, initial: {eccentricity: [1]}}}\n",
                "6:36 wrong-length "},
        Mistake{"fault of a constructor",
                "joints:\n  a: {type: pin, between: [ground, rod], play: {gap: 1,\n"
                "    limit: 1 mm, contact: {law: power, K: 1e9}}}\n",
                "5:54 doubtful-clearance 6:12 out-of-range "},
        Mistake{"fault of a law's constructor",
                "joints:\n  a: {type: pin, between: [ground, rod], play: {gap: 1,\n"
                "    contact: {law: power, K: 1e9, soft: 1}}}\n",
                "6:35 conflicting-keys "},
        Mistake{"fault of a whole law",
                "joints:\n  a: {type: pin, between: [ground, rod], play: {gap: 1,\n"
                "    contact: {law: power, K: 13e9}}}\n",
                "6:5 missing-key "},
        Mistake{"range in the unit of the table", "joints:\n  a: {type: rod, between: [ground, rod], length: 1 cm}\n",
                "5:50 out-of-range "}));

constexpr const char* pin = "joints: {a: {type: pin, between: [ground, rod]}}\n";
std::string after_pin(const char* text) { return with_rod(std::string(pin) + text); }

class MistakesAfterPin : public testing::TestWithParam<Mistake> {};

TEST_P(MistakesAfterPin, AreReportedAtTheirPlace) {
  const Built built = build(after_pin(GetParam().text));
  EXPECT_FALSE(built.model);
  EXPECT_EQ(built.places, GetParam().places) << built.report;
}

INSTANTIATE_TEST_SUITE_P(
    Drivers, MistakesAfterPin,
    testing::Values(
        Mistake{"unknown joint", "drivers:\n  m: {joint: b, kind: angle, value: 1}\n", "6:14 unknown-name "},
        Mistake{"no kind", "drivers:\n  m: {joint: a, value: 1}\n", "6:3 missing-key "},
        Mistake{"misfit", "drivers:\n  m: {joint: a, kind: force, value: 1}\n", "6:23 wrong-type "},
        Mistake{"dimension", "drivers:\n  m: {joint: a, kind: angle, value: 1 mm}\n", "6:37 dimension-mismatch "},
        Mistake{"no value", "drivers:\n  m: {joint: a, kind: angle}\n", "6:3 missing-key "},
        Mistake{"table", "drivers:\n  m: {joint: a, kind: angle, table: m.csv}\n", "6:37 file-not-found "},
        Mistake{"both", "drivers:\n  m: {joint: a, kind: angle, value: 1, table: m.csv}\n", "6:40 conflicting-keys "},
        Mistake{"at the start", "drivers:\n  m: {joint: a, kind: angle, value: 1 + sqrt(t - 1)}\n",
                "6:41 bad-expression "},
        Mistake{"twice",
                "drivers:\n  m: {joint: a, kind: angle, value: 1}\n  n: {joint: a, kind: velocity, value: t}\n",
                "7:3 duplicate-driver "},
        Mistake{"leading", "drivers:\n  m: {joint: a, kind: angle, value: 1}\ninitial: {joints: {a: 1}}\n",
                "7:20 conflicting-keys "},
        Mistake{"speed", "drivers:\n  m: {joint: a, kind: velocity, value: 1}\ninitial: {speeds: {a: 1}}\n",
                "7:20 conflicting-keys "},
        Mistake{"empty path", "drivers:\n  m: {inverse_kinematics: {frame: rod, path: {}, joints: a}}\n",
                "6:40 missing-key "},
        Mistake{"no match", "drivers:\n  m: {inverse_kinematics: {frame: rod, path: {x: 1}, joints: b*}}\n",
                "6:62 unknown-name "},
        Mistake{"elbow", "drivers:\n  m: {inverse_kinematics: {frame: rod, path: {x: 1}, joints: a, elbow: 0}}\n",
                "6:72 out-of-range "},
        Mistake{"elbows", "drivers:\n  m: {inverse_kinematics: {frame: rod, path: {x: 1}, joints: a, elbow: [1, 1]}}\n",
                "6:72 wrong-length "},
        Mistake{"clash",
                "drivers:\n  a: {joint: a, kind: torque, value: 1}\n"
                "  m: {inverse_kinematics: {frame: rod, path: {x: 1}, joints: a}}\n",
                "7:62 duplicate-name "}));

INSTANTIATE_TEST_SUITE_P(
    OtherSections, MistakesAfterPin,
    testing::Values(
        Mistake{"force type", "forces:\n  f: {type: thrust, at: rod}\n", "6:13 unknown-type "},
        Mistake{"force dimension", "forces:\n  f: {type: force, at: rod, value: [1 N, 1 m]}\n",
                "6:42 dimension-mismatch "},
        Mistake{"torque on nobody", "forces:\n  f: {type: torque, on: rood, value: 1}\n", "6:25 unknown-name "},
        Mistake{"gravity needs a list", "forces:\n  f: {type: gravity, on: rod, value: [0, 0]}\n", "6:26 wrong-type "},
        Mistake{"end before start", "simulation: {start: 1, end: 1}\n", "5:29 out-of-range "},
        Mistake{"accuracy and step", "simulation: {step: 1 ms, accuracy: 1 um}\n", "5:26 conflicting-keys "},
        Mistake{"accuracy is a length", "simulation: {accuracy: 1e-6 s}\n", "5:24 dimension-mismatch "},
        Mistake{"adaptive without estimate", "simulation: {integrator: stepper, step: {adaptive: true}}\n",
                "5:41 out-of-range "},
        Mistake{"tolerance below rounding", "simulation: {step: {tolerance: 1e-15}}\n", "5:32 out-of-range "},
        Mistake{"least step above the first", "simulation: {step: {size: 1 ms, min: 2 ms}}\n", "5:38 out-of-range "},
        Mistake{"word for adaptive", "simulation: {step: {adaptive: yes}}\n", "5:31 wrong-type "},
        Mistake{"no step", "simulation: {step: 0}\n", "5:20 out-of-range "},
        Mistake{"integrator", "simulation: {integrator: steper}\n", "5:26 unknown-type "},
        Mistake{"its parameter", "simulation: {integrator: {type: stepper, split: 1}}\n", "5:49 out-of-range "},
        Mistake{"its integer", "simulation: {integrator: {type: stepper, newton: {max_iterations: 1.5}}}\n",
                "5:67 wrong-type "},
        Mistake{"format", "simulation: {output: {format: xml}}\n", "5:31 wrong-type "},
        Mistake{"output frame", "simulation: {output: {frames: [rod/tap]}}\n", "5:32 unknown-name "},
        Mistake{"stop", "simulation: {stop: [{chanel: a, above: 1}]}\n", "5:21 missing-key 5:22 unknown-key "},
        Mistake{"stop limits", "simulation: {stop: [{channel: a, above: 1, below: 1}]}\n", "5:44 conflicting-keys "},
        Mistake{"grid", "analysis: {grid: {x: {linspace: [0, 1, 0]}}}\n", "5:40 out-of-range "},
        Mistake{"analysis key", "analysis: {elbows: 1}\n", "5:12 unknown-key "},
        Mistake{"study parameter", "study: {axes: {q: [1, 2]}}\n", "5:16 unknown-name "},
        Mistake{"study value", "parameters: {q: 1}\nstudy: {axes: {q: [$q]}}\n", "6:20 unknown-name "},
        Mistake{"old name of a study", "sweep: {parameters: {q: [1, 2]}}\n", "5:1 unknown-key "},
        Mistake{"tolerance", "initial: {assembly: {tolerance: 1 kg}}\n", "5:33 dimension-mismatch "}));

TEST(ModelBuilder, RefusesOtherVersionsAndEmptyModels) {
  EXPECT_EQ(build("freeplay: 2\nwhatever: 1\n").places, "1:11 bad-version ");
  EXPECT_EQ(build("# no version\nbodies: {a: {mass: 1, inertia: 1}}\n").places, "1:1 missing-key ");
  EXPECT_EQ(build("").places, "1:1 missing-key ");
  EXPECT_EQ(build("[1, 2]\n").places, "1:1 wrong-type ");
  EXPECT_EQ(build("freeplay: 1\nbodies: {ground: {frames: {a: [0, 0]}}}\n").places, "1:1 empty-model ");
  EXPECT_EQ(build("freeplay: 1\nbodies:\n  ground: {mass: 1}\n  a: {mass: 1, inertia: 1}\n").places,
            "3:12 unknown-key ");
}

TEST(ModelBuilder, TakesEmptySectionsAsNone) {
  EXPECT_TRUE(build(with_rod("joints:\ndrivers:\nsimulation:\nparameters:\ninstances:\n")).model);
}

TEST(ModelBuilder, IgnoresNotes) {
  EXPECT_EQ(
      build(
          with_rod(
              "x-data: [1, 2]\nsimulation: {x-why: {a: 1}, output: {x-b: 2, frames: [rod/tip]}}\ndrivers: {x-m: 1}\n"))
          .report,
      "");
}

TEST(ModelBuilder, WarnsOfWhatIsNotUsed) {
  const std::string text = with_rod("parameters: {a: 1, b: $a}\npresets: {p: {nonsense: 1 q}}\ntemplates: {t: {}}\n");
  const Built built = build(text);
  EXPECT_TRUE(built.model);
  EXPECT_EQ(built.places, "3:39 unused 4:20 unused 5:11 unused 6:13 unused ");
  EXPECT_FALSE(build(text, {}, true).model);
}

TEST(ModelBuilder, CountsAFrameOfATemplateAsUsedWhereOneInstanceUsesIt) {
  const std::string text =
      "freeplay: 1\n"
      "templates: {t: {bodies: {b: {mass: 1, inertia: 1, frames: {tip: [1, 0], end: [2, 0]}}}}}\n"
      "instances: {i: {template: t, count: 2}}\n"
      "joints: {J: {type: pin, between: [ground, i2.b/tip]}}\n";
  EXPECT_EQ(build(text).places, "2:73 unused ");
}

TEST(NamedPlugins, AreReportedWithTheirPlaces) {
  Diagnostics diagnostics(false);
  const auto document = parse_yaml("freeplay: 1\nplugins: [./mine.so, yours]\n", "model.yaml", diagnostics);
  ASSERT_TRUE(document);
  const std::vector<NamedPlugin> plugins = named_plugins(*document);
  ASSERT_EQ(plugins.size(), 2u);
  EXPECT_EQ(plugins[0].word, "./mine.so");
  EXPECT_EQ(plugins[1].word, "yours");
  EXPECT_EQ(plugins[1].location.line, 2);
  EXPECT_EQ(plugins[1].location.column, 22);
}

TEST(ModelBuilder, RefusesPluginsThatAreNoList) {
  EXPECT_NE(build(with_rod("plugins: mine\n")).report.find("[wrong-type]"), std::string::npos);
}

TEST(ModelBuilder, ReadsDriversForcesAndSimulation) {
  const Built built =
      build(after_pin("drivers:\n"
                      "  m: {joint: a, kind: velocity, value: 2*t}\n"
                      "initial: {joints: {a: 180 deg}}\n"
                      "forces:\n"
                      "  f: {type: force, at: rod/tip, value: [1 N, sin(t)], axes: frame}\n"
                      "  q: {type: torque, on: rod, value: 1 Nm}\n"
                      "simulation: {start: 1, end: 3, step: 2 ms, integrator: {type: stepper, split: optimal},\n"
                      "  output: {interval: 10 ms, channels: [body.*], frames: [rod/tip], discard: 1 s},\n"
                      "  stop: [{channel: body.rod.x, below: 1 mm, after: 2 s}]}\n"));
  ASSERT_TRUE(built.model) << built.report;
  const Model& model = *built.model;
  EXPECT_EQ(model.drivers[0].kind, DriverKind::velocity);
  EXPECT_DOUBLE_EQ(model.joints[0].start_coordinate.value().value, 3.141592653589793);
  ASSERT_EQ(model.forces.size(), 2u);
  EXPECT_TRUE(model.forces[0].frame_axes);
  EXPECT_EQ(model.markers[static_cast<std::size_t>(model.forces[1].marker)].name, "rod/com");
  EXPECT_DOUBLE_EQ(model.settings.start, 1.0);
  EXPECT_DOUBLE_EQ(model.settings.step, 0.002);
  EXPECT_EQ(model.settings.integrator_parameters.values.at("split").word, 0);
  EXPECT_EQ(model.settings.channels, std::vector<std::string>{"body.*"});
  ASSERT_EQ(model.settings.stop.size(), 1u);
  EXPECT_FALSE(model.settings.stop[0].above);
  EXPECT_DOUBLE_EQ(model.settings.stop[0].after, 2.0);
  EXPECT_EQ(model.settings.frames.size(), 1u);
}

TEST(ModelBuilder, LetsTheCommandLineChooseEndStepAndIntegrator) {
  BuildOptions options;
  options.end = 4.0;
  options.step = 0.5;
  options.integrator = "stumbler";
  const Built built = build(after_pin("simulation: {end: 2 s, integrator: {type: stepper, split: 0.3}}\n"), options);
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_DOUBLE_EQ(built.model->settings.end, 4.0);
  EXPECT_DOUBLE_EQ(built.model->settings.interval, 0.004);
  EXPECT_DOUBLE_EQ(built.model->settings.step, 0.5);
  EXPECT_STREQ(built.model->settings.integrator_parameters.component->description.name, "stumbler");
  options.integrator = "stepper";
  const Built same = build(after_pin("simulation: {integrator: {type: stepper, split: 0.3}}\n"), options);
  EXPECT_DOUBLE_EQ(same.model->settings.integrator_parameters.values.at("split").number, 0.3);
  options.integrator = "steper";
  EXPECT_THROW(build(after_pin(""), options), Error);
}

TEST(ModelBuilder, ExpandsInverseKinematicsToOneDriverPerJoint) {
  const Built model = build(
      "freeplay: 1\n"
      "bodies: {a: {mass: 1, inertia: 1}, b: {mass: 1, inertia: 1}}\n"
      "joints:\n"
      "  p: {type: pin, between: [ground, a]}\n"
      "  q: {type: slide, between: [a, b]}\n"
      "drivers:\n"
      "  ik: {inverse_kinematics: {frame: b/com, path: {x: t, y: 1}, joints: [q, p], elbow: [1, -1]}}\n");
  ASSERT_TRUE(model.model) << model.report;
  ASSERT_EQ(model.model->drivers.size(), 2u);
  EXPECT_EQ(model.model->drivers[0].name, "q");
  EXPECT_EQ(model.model->drivers[0].kind, DriverKind::position);
  EXPECT_EQ(model.model->drivers[1].kind, DriverKind::angle);
  EXPECT_EQ(model.model->drivers[1].elbow, -1);
  ASSERT_EQ(model.model->kinematics.size(), 1u);
  EXPECT_EQ(model.model->kinematics[0].driver_count, 2);
  EXPECT_FALSE(model.model->kinematics[0].path.gives(2));
  EXPECT_EQ(model.model->kinematics[0].frame_location.column, 36);
}

TEST(Messages, QuoteTheWholeExpressionThatCommasCut) {
  const std::string text = "freeplay: 1\nbodies: {a: {mass: max(1, min(2, 3), 4), inertia: 1}}\n";
  const std::string report = build(text).report;
  EXPECT_NE(report.find("quoted here: \"max(1, min(2, 3), 4)\""), std::string::npos) << report;
}

TEST(Messages, SayHowLongANameMayBe) {
  const std::string name(65, 'a');
  for (const std::string section : {"bodies", "parameters", "presets"}) {
    const std::string report = build(with_rod("").substr(0, 12) + section + ": {" + name + ": {mass: 1}}\n").report;
    EXPECT_NE(report.find("= a name has at most 64 characters, this one 65"), std::string::npos) << report;
  }
}

TEST(Messages, KnowTheSignForDegrees) {
  const std::string report = build(with_rod("parameters: {a: 10\u00b0}\n")).report;
  EXPECT_NE(report.find("did you mean 'deg'?"), std::string::npos) << report;
}

}  // namespace
}  // namespace freeplay
