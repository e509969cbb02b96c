#include "format/template.h"

#include <gtest/gtest.h>

#include "model_text.h"

namespace freeplay {
namespace {

const std::string head =
    "freeplay: 1\n"
    "parameters: {l: 2, k: 3}\n"
    "bodies: {plate: {mass: 1, inertia: 1, frames: {hub: [9, 0]}}}\n"
    "templates:\n"
    "  leg:\n"
    "    parameters: {at: required, l: $k + 1}\n"
    "    bodies: {bar: {mass: $l, inertia: 1, frames: {end: [$at, 0]}}}\n"
    "    frames: {ground/A: [$i, $n], plate/C: [$at, 1], bar/mid: [0, 0]}\n"
    "    joints:\n"
    "      A: {type: pin, between: [ground/A, bar/mid]}\n"
    "      C: {type: pin, between: [bar/end, plate/C]}\n"
    "      H: {type: rod, between: [bar, plate/hub]}\n";

const Marker& marker(const Model& model, int index) { return model.markers[static_cast<std::size_t>(index)]; }

TEST(Templates, NameWhatTheyDeclareAfterTheInstance) {
  const Built built = build(head + "instances: {leg: {template: leg, count: 2, with: {at: 10*$i/$n}}}\n");
  ASSERT_TRUE(built.model) << built.report;
  const Model& model = *built.model;
  ASSERT_EQ(model.bodies.size(), 3u);
  EXPECT_EQ(model.bodies[0].name, "plate");
  EXPECT_EQ(model.bodies[1].name, "leg1.bar");
  EXPECT_EQ(model.bodies[2].name, "leg2.bar");
  EXPECT_DOUBLE_EQ(model.bodies[1].mass, 4.0);  // the template's l hides the outer one
  ASSERT_EQ(model.joints.size(), 6u);
  EXPECT_EQ(model.joints[3].name, "leg2.A");
  EXPECT_EQ(marker(model, model.joints[3].marker_a).name, "ground/leg2.A");
  EXPECT_EQ(marker(model, model.joints[3].marker_b).name, "leg2.bar/mid");
  EXPECT_EQ(marker(model, model.joints[4].marker_b).name, "plate/leg2.C");
  EXPECT_EQ(marker(model, model.joints[5].marker_b).name, "plate/hub");
  EXPECT_DOUBLE_EQ(marker(model, model.joints[3].marker_a).position[0], 2.0);
  EXPECT_DOUBLE_EQ(marker(model, model.joints[1].marker_a).position[0], 5.0);
  EXPECT_DOUBLE_EQ(marker(model, model.joints[4].marker_b).position[0], 10.0);
}

TEST(Templates, AreReferredToFromOutside) {
  const Built built = build(head +
                            "instances: {one: {template: leg, with: {at: 1}}}\n"
                            "frames: {one.bar/probe: [7, 0]}\n"
                            "forces: {f: {type: force, at: one.bar/probe, value: [1, 0]}}\n"
                            "initial: {joints: {one.A: 1}}\n"
                            "simulation: {output: {frames: [ground/one.A]}}\n");
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_DOUBLE_EQ(marker(*built.model, built.model->forces[0].marker).position[0], 7.0);
  EXPECT_TRUE(built.model->joints[0].start_coordinate.has_value());
}

TEST(Templates, ReachTheNeighbourByComputedNames) {
  const Built built = build(
      "freeplay: 1\n"
      "bodies: {link0.bar: {mass: 1, inertia: 1}}\n");
  EXPECT_EQ(built.places, "2:10 bad-name ");
  const Built chain = build(
      "freeplay: 1\n"
      "bodies: {base0: {mass: 1, inertia: 1}}\n"
      "templates:\n"
      "  t:\n"
      "    bodies: {bar: {mass: 1, inertia: 1}}\n"
      "    joints: {J: {type: pin, between: [\"base{$i - 1}\", bar]}}\n"
      "  u:\n"
      "    bodies: {bar: {mass: 1, inertia: 1}}\n"
      "    joints: {J: {type: pin, between: [\"a{${i}}.bar/com\", bar]}}\n"
      "instances:\n"
      "  a: {template: t, count: 1}\n"
      "  b: {template: u, count: 1}\n");
  ASSERT_TRUE(chain.model) << chain.report;
  EXPECT_EQ(marker(*chain.model, chain.model->joints[0].marker_a).name, "base0/origin");
  EXPECT_EQ(marker(*chain.model, chain.model->joints[1].marker_a).name, "a1.bar/com");
}

TEST(Templates, ReportAMistakeOnceAndNameTheInstance) {
  const Built built = build(
      "freeplay: 1\n"
      "templates:\n"
      "  t:\n"
      "    bodies: {bar: {mass: -1, inertia: 1}}\n"
      "    joints: {J: {type: pin, between: [ground, bar/tip]}}\n"
      "instances: {a: {template: t, count: 3}}\n");
  EXPECT_EQ(built.report,
            "m.yaml:4:26: error: 'templates.t.bodies.bar.mass' must be > 0 kg, not -1 kg [out-of-range]\n"
            "    4 |     bodies: {bar: {mass: -1, inertia: 1}}\n"
            "      |                          ^~\n"
            "      = in instance 'a1'\n"
            "m.yaml:5:47: error: body 'bar' has no frame 'tip' [unknown-name]\n"
            "    5 |     joints: {J: {type: pin, between: [ground, bar/tip]}}\n"
            "      |                                               ^~~~~~~\n"
            "      = in instance 'a1'\n");
}

TEST(Instances, HoldALimitedNumberOfValues) {
  const auto places = [](int frames, long count) {
    std::string list;
    for (int i = 0; i < frames; ++i) list += (i > 0 ? ", f" : "f") + std::to_string(i) + ": [0, 0]";
    return build(
               "freeplay: 1\n"
               "templates: {t: {bodies: {b: {mass: 1, inertia: 1, frames: {" +
               list + "}}}}}\ninstances: {i: {template: t, count: " + std::to_string(count) + "}}\n")
        .places;
  };
  EXPECT_EQ(places(100, 10).find("too-large"), std::string::npos);
  EXPECT_EQ(places(100, 10'000), "3:37 too-large ");  // 300 values each
}

TEST(Instances, AreChecked) {
  const auto places = [](const std::string& instances) { return build(head + "instances:\n" + instances).places; };
  EXPECT_EQ(places("  a: {template: lag, with: {at: 1}}\n"), "14:17 unknown-name ");
  EXPECT_EQ(places("  a: {template: leg}\n"), "14:3 missing-key ");
  EXPECT_EQ(places("  a: {with: {at: 1}}\n"), "14:3 missing-key ");
  EXPECT_EQ(places("  a: {template: leg, count: 0, with: {at: 1}}\n"), "14:29 out-of-range ");
  EXPECT_EQ(places("  a: {template: leg, count: 1.5, with: {at: 1}}\n"), "14:29 wrong-type ");
  EXPECT_EQ(places("  a: {template: leg, count: 1e12, with: {at: 1}}\n"), "14:29 too-large ");
  EXPECT_EQ(places("  a: {template: leg, with: {at: 1, att: 2}}\n"), "14:36 unknown-key ");
  EXPECT_EQ(places("  a: {template: leg, with: {at: 1 q}}\n"), "14:35 bad-unit ");
  EXPECT_EQ(places("  a: {template: leg, count: 1, with: {at: 1}}\n  a1: {template: leg, with: {at: 1}}\n"),
            "15:3 duplicate-name ");
}

TEST(Instances, ThatAreBrokenExcuseReferencesToThem) {
  EXPECT_EQ(build(head + "instances: {a: {template: lag, count: 2}}\ninitial: {joints: {a1.A: 0}}\n").places,
            "13:27 unknown-name ");
}

TEST(Templates, DriveTheirOwnJoints) {
  const Built built = build(head +
                            "    drivers: {m: {joint: A, kind: angle, value: $i*t}}\n"
                            "instances: {leg: {template: leg, count: 2, with: {at: 1}}}\n");
  ASSERT_TRUE(built.model) << built.report;
  ASSERT_EQ(built.model->drivers.size(), 2u);
  EXPECT_EQ(built.model->drivers[1].name, "leg2.m");
  EXPECT_EQ(built.model->drivers[1].joint, 3);
}

}  // namespace
}  // namespace freeplay
