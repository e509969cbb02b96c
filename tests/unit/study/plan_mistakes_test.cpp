#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "unit/study/planning_fixture.h"

namespace freeplay {
namespace {

using testing::HasSubstr;

TEST_F(StudyPlanning, TargetsExist) {
  EXPECT_THAT(refused("  axes: {gg: [1]}\n"), HasSubstr("8:10 unknown-name"));
  EXPECT_THAT(messages_, HasSubstr("'g'"));
  EXPECT_THAT(refused("  axes: {bodies.bal.mass: [1]}\n"), HasSubstr("bodies.ball.mass"));
  EXPECT_THAT(refused("  axes: {bodies.ball.mas: [1]}\n"), HasSubstr("unknown-name"));
  EXPECT_THAT(refused("  axes: {study.name: [1]}\n"), HasSubstr("unknown-name"));
  EXPECT_THAT(refused("  axes: {x: {each: 'joints.*.mass', list: [1]}}\n"), HasSubstr("unknown-name"));
  EXPECT_THAT(refused("  axes: {x: {each: '*odies', list: [1]}}\n"), HasSubstr("unknown-name"));  // a whole section
  EXPECT_THAT(refused("  set: {gg: 1}\n"), HasSubstr("8:9 unknown-name"));
  EXPECT_THAT(refused("  axes: {x: {cases: {a: {gg: 1}}}}\n"), HasSubstr("unknown-name"));
}

TEST_F(StudyPlanning, ValuesHaveTheDimensionOfTheirTarget) {
  EXPECT_THAT(refused("  axes: {g: [1 kg]}\n"), HasSubstr("dimension-mismatch"));
  EXPECT_THAT(refused("  axes: {v: [1 m/s], bodies.ball.mass: {triangular: [1 m, 2 m, 2 m]}}\n"
                      "  sample: {method: sobol, points: 2, seed: 1}\n"),
              HasSubstr("8:40 dimension-mismatch"));
  EXPECT_THAT(refused("  axes: {simulation.integrator: [bathe, bath]}\n"), HasSubstr("unknown-type"));
  EXPECT_THAT(refused("  set: {bodies.ball.mass: 1 s}\n"), HasSubstr("8:27 dimension-mismatch"));
  EXPECT_TRUE(of_ball("  axes: {bodies.ball.mass: [1, -1]}\n"));  // a fact of its point
}

TEST_F(StudyPlanning, PlacesOfMistakesAreThoseOfTheStudy) {
  EXPECT_THAT(refused("  combine: zip\n  axes: {g: [1, 2], v: [1]}\n"), HasSubstr("9:21 wrong-length"));
  EXPECT_THAT(refused("  axes: {g: [1], other: {target: g, list: [2]}}\n"), HasSubstr("8:18 duplicate-name"));
  EXPECT_THAT(messages_, HasSubstr("line 8"));
  EXPECT_THAT(refused("  set: {g: 2}\n  axes: {g: [1]}\n"), HasSubstr("9:10 duplicate-name"));
  EXPECT_THAT(refused("  axes: {d: {table: none.csv}}\n"), HasSubstr("8:21 file-not-found"));
  EXPECT_THAT(
      refused("  axes: {g: {uniform: [1, 2]}}\n  sample: {method: random, points: 3, seed: 9223372036854775808}\n"),
      HasSubstr("must be <= 9223372036854775807, not 9223372036854775808"));
  EXPECT_TRUE(
      of_ball("  axes: {g: {uniform: [1, 2]}}\n  sample: {method: random, points: 3, seed: 9223372036854775807}\n"));
  EXPECT_THAT(refused("  models: [ball.yaml]\n"), HasSubstr("8:3 conflicting-keys"));
  EXPECT_THAT(refused("  axes: {sample: {target: g, list: [1]}}\n"), HasSubstr("reserved-name"));
  const std::string reducer = "  axes: {g: [1]}\n  reducers: {force: {channel: body.ball.y, reduce: max}}\n  plots: ";
  EXPECT_THAT(refused(reducer + "{p: {kind: line, x: h, y: force}}\n"), HasSubstr("10:30 unknown-name"));
  EXPECT_THAT(refused(reducer + "{p: {kind: line, x: g, value: forse}}\n"), HasSubstr("'forse' force"));
  EXPECT_TRUE(of_ball(reducer + "{p: {kind: line, x: g, y: force.a, by: model}}\n"));
  for (const auto& [plot, key] : {std::pair("line", "x"),
                                  {"line, x: g", "y"},
                                  {"heat, x: g, value: force", "y"},
                                  {"heat, x: g, y: g", "value"},
                                  {"bifurcation, value: force", "x"},
                                  {"bifurcation, x: g, y: force", "value"},
                                  {"histogram", "value"},
                                  {"tornado", "value"}}) {
    EXPECT_THAT(refused(reducer + "{p: {kind: " + plot + "}}\n"),
                HasSubstr(std::string("10:11 missing-key missing key '") + key + "' in 'study.plots.p'"));
  }
  EXPECT_THAT(refused(reducer + "{p: {kind: bifurcation, x: g, value: force}}\n"),
              HasSubstr("wrong-type a bifurcation shows a reducer of `reduce: poincare`; 'force' is none"));
  EXPECT_TRUE(of_ball(reducer + "{p: {kind: histogram, y: force}, q: {kind: tornado, y: force}}\n"));
  EXPECT_THAT(refused("  axes: {g: {linspace: [1, 2, 100000]}, v: {linspace: [1, 2, 1001]}}\n"),
              HasSubstr("7:1 too-large"));
  EXPECT_THAT(messages_, HasSubstr("100100000 points: 100000 (g) x 1001 (v)"));
  EXPECT_THAT(messages_, HasSubstr("--yes"));
}

TEST_F(StudyPlanning, AFileWithoutAStudyIsNone) {
  write("m.yaml", plain_ball);
  EXPECT_EQ(read("m.yaml"), nullptr);
  EXPECT_THAT(messages_, HasSubstr("missing-key missing key 'study'"));
  write("s.yaml", "freeplay: 1\nstudy: {axes: {g: [1]}}\n");
  EXPECT_EQ(read("s.yaml"), nullptr);
  EXPECT_THAT(messages_, HasSubstr("missing-key missing key 'models'"));
  write("s.yaml", "freeplay: 1\nstudy: {models: [none.yaml]}\n");
  EXPECT_EQ(read("s.yaml"), nullptr);
  EXPECT_THAT(messages_, HasSubstr("2:18 file-not-found"));
  EXPECT_EQ(read("nothing.yaml"), nullptr);
  EXPECT_THAT(messages_, HasSubstr("file-not-found"));
}

TEST_F(StudyPlanning, WhatTheCommandLineSetsIsItsOwnMistake) {
  write("ball.yaml", std::string(plain_ball) + "study: {axes: {g: [1]}}\n");
  StudyPlanOptions options;
  options.set = {{"gg", "1"}};
  EXPECT_THROW(read("ball.yaml", options), Error);
}

}  // namespace
}  // namespace freeplay
