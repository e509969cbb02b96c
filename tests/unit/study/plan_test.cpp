#include "study/plan.h"

#include <cmath>
#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/sha256.h"
#include "unit/study/planning_fixture.h"

namespace freeplay {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(StudyPlanning, TheLastAxisOfAGridIsTheFastest) {
  const auto plan = of_ball("  axes:\n    g: [1, 2 mm/s^2]\n    v: {linspace: [0 m/s, 1 m/s, 3]}\n");
  ASSERT_TRUE(plan);
  EXPECT_THAT(cells(*plan), ElementsAre("1,0", "1,0.5", "1,1", "0.002,0", "0.002,0.5", "0.002,1"));
  EXPECT_EQ(plan->axis_columns()[1].unit, "m/s");
  const StudyPoint point = plan->point(4);
  EXPECT_EQ(point.index, 4u);
  ASSERT_EQ(point.settings.size(), 2u);
  EXPECT_EQ(point.settings[0].target, "g");
  EXPECT_EQ(point.settings[0].text, "0.002 m/s^2");
  EXPECT_EQ(plan->name(), "ball");
}

TEST_F(StudyPlanning, AxesGoSideBySide) {
  EXPECT_THAT(cells(*of_ball("  combine: zip\n  axes: {g: [1, 2, 3], v: [4, 5, 6]}\n")),
              ElementsAre("1,4", "2,5", "3,6"));
  EXPECT_THAT(
      cells(*of_ball("  zip: [[g, bodies.ball.mass]]\n  axes: {g: [1, 2], v: [3, 4], bodies.ball.mass: [5, 6]}\n")),
      ElementsAre("1,3,5", "1,4,5", "2,3,6", "2,4,6"));
}

TEST_F(StudyPlanning, AStarTakesOneAxisAtATime) {
  const auto plan = of_ball("  combine: star\n  axes: {g: [1, 2], v: [4]}\n");
  EXPECT_THAT(cells(*plan), ElementsAre("-,-", "1,-", "2,-", "-,4"));
  EXPECT_TRUE(plan->point(0).settings.empty());
  EXPECT_EQ(plan->point(3).settings.size(), 1u);
}

TEST_F(StudyPlanning, CasesAndTablesSetSeveralTargets) {
  const auto cases = of_ball("  axes:\n    way: {cases: {slow: {g: 1, v: 0}, fast: {g: 2, v: 9}}}\n");
  EXPECT_THAT(cells(*cases), ElementsAre("slow", "fast"));
  EXPECT_EQ(cases->point(1).settings[1].text, "9");
  write("points.csv", "\"g\", v\n1.5e+00,0\n2 mm/s^2,1\n");
  const auto table = of_ball("  axes: {design: {table: points.csv}}\n");
  EXPECT_THAT(cells(*table), ElementsAre("1.5,0", "0.002,1"));
  EXPECT_EQ(table->axis_columns()[0].name, "g");
}

TEST_F(StudyPlanning, AllModelsSeeTheSameSample) {
  write("a/one.yaml", plain_ball);
  write("a/two.yaml", std::string(plain_ball) + "description: another\n");
  write("s.yaml",
        "freeplay: 1\nstudy:\n  models: {one: a/one.yaml, two: a/two.yaml}\n  axes: {v: [1, 2], g: {uniform: [1, 2]}}\n"
        "  sample: {method: random, points: 3, seed: 5}\n");
  const auto plan = read("s.yaml");
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->points(), 12u);
  EXPECT_TRUE(plan->has_model_column() && plan->has_sample_column());
  for (std::uint64_t i = 0; i < 12; ++i) {
    const StudyPoint point = plan->point(i);
    EXPECT_EQ(point.model, i / 6);
    EXPECT_EQ(point.sample, i % 3);
    EXPECT_EQ(point.cells[0], i / 3 % 2 == 0 ? "1" : "2");
    EXPECT_EQ(point.cells[1], plan->point(i % 3).cells[1]);
  }
  EXPECT_EQ(plan->models()[1].name, "two");
  EXPECT_EQ(plan->name(), "s");
}

TEST_F(StudyPlanning, WordsListsAndMapsAreValues) {
  write("crank.yaml",
        std::string(loose_crank) +
            "study:\n  set: {simulation.end: 3 ms}\n  axes:\n    law: {target: joints.a.clearance.contact.law, "
            "list: [lankarani-nikravesh, flores]}\n    joints.b.clearance.contact: [{law: flores, restitution: "
            "0.8, K: 2e9}]\n    bodies.rod.mass: 2 kg\n    simulation.integrator: bathe\n");
  const auto plan = read("crank.yaml");
  ASSERT_TRUE(plan) << messages_;
  EXPECT_EQ(plan->point(0).settings[0].text, "3 ms");
  EXPECT_EQ(plan->point(0).settings[1].text, "lankarani-nikravesh");
  EXPECT_EQ(plan->point(0).settings[2].text, "{law: flores, restitution: 0.8, K: 2e9}");
  EXPECT_EQ(plan->point(0).cells[1], "{law: flores; restitution: 0.8; K: 2e9}");
}

TEST_F(StudyPlanning, EachIsAnAxisForEveryPathThatFits) {
  write("crank.yaml", loose_crank);
  write("ball.yaml", plain_ball);
  write("s.yaml",
        "freeplay: 1\nstudy:\n  models: [ball.yaml, crank.yaml]\n  axes:\n    play: {each: "
        "'joints.*.radial_clearance', fit: "
        "H7/g6, diameter: 10 mm, where_present: true}\n    g: {list: [1, 2], where_present: true}\n"
        "  sample: {method: latin-hypercube, points: 5, seed: 1}\n");
  const auto plan = read("s.yaml");
  ASSERT_TRUE(plan) << messages_;
  ASSERT_EQ(plan->axis_columns().size(), 3u);
  EXPECT_EQ(plan->axis_columns()[1].name, "joints.b.clearance.radial_clearance");
  EXPECT_EQ(plan->axis_columns()[1].unit, "m");
  EXPECT_EQ(plan->points(), 15u);  // two values of g in the ball, none in the crank
  EXPECT_THAT(plan->point(0).cells, ElementsAre("", "", "1"));
  const StudyPoint last = plan->point(14);
  EXPECT_NE(last.cells[0], last.cells[1]);
  EXPECT_EQ(last.cells[2], "");
  EXPECT_EQ(last.settings.size(), 2u);
}

TEST_F(StudyPlanning, SeveralFitsAreAChoiceForAllThatTheAxisSets) {
  write("crank.yaml", loose_crank);
  write("ball.yaml", plain_ball);
  write("s.yaml",
        "freeplay: 1\nstudy:\n  models: {1-ball: ball.yaml, crank: crank.yaml}\n  axes:\n    play: {each: "
        "'joints.*.radial_clearance', fit: [H7/g6, H7/f7], diameter: 10 mm, where_present: true}\n"
        "  sample: {method: random, points: 3, seed: 1}\n");
  const auto plan = read("s.yaml");
  ASSERT_TRUE(plan) << messages_;
  ASSERT_EQ(plan->axis_columns().size(), 3u);
  EXPECT_EQ(plan->axis_columns()[0].name, "play.fit");
  EXPECT_TRUE(plan->axis_columns()[0].words);
  EXPECT_EQ(plan->models()[0].name, "1-ball");
  ASSERT_EQ(plan->points(), 3u + 2u * 3u);  // nothing is to be chosen in the ball
  EXPECT_THAT(plan->point(0).cells, ElementsAre("", "", ""));
  EXPECT_EQ(plan->point(3).cells[0], "H7/g6");
  EXPECT_EQ(plan->point(6).cells[0], "H7/f7");
  EXPECT_EQ(plan->point(6).settings.size(), 2u);
  EXPECT_EQ(plan->point(6).sample, plan->point(3).sample);
  const auto value = [&](std::uint64_t point, std::size_t cell) { return std::stod(plan->point(point).cells[cell]); };
  // The same numbers give the same place in both zones of the hole, and that of a shaft in g6 and f7.
  for (const std::size_t cell : {1u, 2u}) {
    EXPECT_GE(value(3, cell), 2.5e-6);
    EXPECT_LE(value(3, cell), 14.5e-6);
    EXPECT_GE(value(6, cell), 6.5e-6);
    EXPECT_LE(value(6, cell), 21.5e-6);
  }
  EXPECT_NE(plan->hash(3), plan->hash(6));
}

// Three standard errors of the mean and of the deviation of 4000 independent numbers.
TEST_F(StudyPlanning, RandomValuesHaveTheirMoments) {
  const auto plan = of_ball("  axes: {g: {normal: [10, 2]}}\n  sample: {method: random, points: 4000, seed: 3}\n");
  double sum = 0.0, squares = 0.0;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    const double g = std::stod(plan->point(i).cells[0]);
    sum += g;
    squares += g * g;
  }
  const double mean = sum / 4000, deviation = std::sqrt(squares / 4000 - mean * mean);
  EXPECT_NEAR(mean, 10.0, 3 * 2 / std::sqrt(4000.0));
  EXPECT_NEAR(deviation / 2, 1.0, 3 / std::sqrt(2 * 4000.0));
}

TEST_F(StudyPlanning, MoreSamplesContainTheFewerOnes) {
  for (const std::string method : {"random", "sobol"}) {
    const auto few =
        of_ball("  axes: {g: {normal: [10, 2]}}\n  sample: {method: " + method + ", points: 7, seed: 3}\n");
    const auto more =
        of_ball("  axes: {g: {normal: [10, 2]}}\n  sample: {method: " + method + ", points: 70, seed: 3}\n");
    for (std::uint64_t i = 0; i < 7; ++i) EXPECT_EQ(few->hash(i), more->hash(i));
  }
}

// --- hashes --------------------------------------------------------------------------------------------------------

TEST_F(StudyPlanning, AHashIsThatOfModelAndSettings) {
  const auto plan =
      of_ball("  set: {simulation.accuracy: 1 um, simulation.end: 2*0.1 s}\n  axes: {g: [1, 2 mm/s^2]}\n");
  const std::string json =
      R"({"freeplay":"1","name":"ball","parameters":{"g":"9.81 m/s^2","v":"0 m/s"},"gravity":["0","-$g"],)"
      R"("bodies":{"ball":{"mass":"1 kg","inertia":"0.1","velocity":{"linear":["$v","0"]}}},)"
      R"("simulation":{"end":"0.1 s","step":"10 ms"}})";
  EXPECT_EQ(plan->models()[0].sha256, sha256(json));
  EXPECT_EQ(plan->hash(1), sha256("freeplay-point 1\nmodel " + sha256(json) +
                                  "\nsimulation.accuracy=1e-06\nsimulation.end=0.2\ng=0.002\n")
                               .substr(0, 24));
  EXPECT_EQ(plan->point(1).hash, plan->hash(1));
}

TEST_F(StudyPlanning, OtherPointsAndPlotsAreNotInAHash) {
  const auto plan = of_ball("  axes: {g: [1, 2, 3]}\n");
  const auto other = of_ball(
      "  name: other\n  axes: {g: [0, 3]}\n  reducers: {y: {channel: body.ball.y, reduce: max}}\n"
      "  plots: {p: {kind: line, x: g, y: y}}\n");
  EXPECT_EQ(plan->hash(2), other->hash(1));
  EXPECT_NE(plan->hash(2), plan->hash(1));
}

TEST_F(StudyPlanning, AnIdentityIsThatOfAllButNamesAndPlots) {
  const std::string axes = "  axes: {g: [1, 2]}\n";
  const std::string own = of_ball(axes)->identity();
  EXPECT_EQ(of_ball("  name: another\n  description: words\n" + axes + "  plots: {}\n")->identity(), own);
  EXPECT_NE(of_ball("  axes: {g: [1, 3]}\n")->identity(), own);
  StudyPlanOptions options;
  options.set = {{"v", "1 m/s"}};
  EXPECT_NE(of_ball(axes, options)->identity(), own);
}

TEST_F(StudyPlanning, ACopyIsTheSameStudy) {
  write("models/table.csv", "0,0\n");
  write("models/m.yaml", std::string(plain_ball) + "x-note: 1\n");
  write("design.csv", "g\n1\n2\n");
  write("s.yaml", "freeplay: 1\nstudy:\n  models: [models/m.yaml]\n  axes: {d: {table: design.csv}}\n");
  StudyPlanOptions options;
  options.set = {{"v", "1 m/s"}};
  const auto plan = read("s.yaml", options);
  ASSERT_TRUE(plan) << messages_;
  for (const KeptFile& file : plan->kept_files()) write("dir/" + file.path, file.bytes);
  for (const char* gone : {"models/m.yaml", "design.csv", "s.yaml"}) std::filesystem::remove(folder_.file(gone));
  options.set.clear();
  options.kept = true;
  const auto copy = read("dir/study.yaml", options);
  ASSERT_TRUE(copy) << messages_;
  EXPECT_EQ(copy->identity(), plan->identity());
  EXPECT_EQ(copy->hash(1), plan->hash(1));
  EXPECT_EQ(copy->name(), "s");
  EXPECT_EQ(copy->models()[0].name, "ball");
  EXPECT_EQ(copy->models()[0].file, "models/m.yaml");
  EXPECT_EQ(copy->point(0).settings[0].target, "v");
}

TEST_F(StudyPlanning, FilesThatAnAxisNamesAreKept) {
  const std::string moved =
      "freeplay: 1\nname: moved\nbodies: {a: {mass: 1 kg, inertia: 1 kg*m^2}}\n"
      "joints: {j: {type: revolute, between: [ground, a]}}\n"
      "drivers: {d: {joint: j, kind: angle, table: {file: one.csv}}}\n"
      "simulation: {end: 1 ms, step: 1 ms}\n"
      "study:\n  axes: ";
  write("one.csv", "t,x\n0,0\n1,1\n");
  write("two.csv", "t,x\n0,0\n1,2\n");
  write("other/one.csv", "t,x\n0,0\n1,3\n");
  write("m.yaml", moved + "{drivers.d.table.file: [one.csv, two.csv]}\n");
  const auto plan = read("m.yaml", {});
  ASSERT_TRUE(plan) << messages_;
  for (const KeptFile& file : plan->kept_files()) write("dir/" + file.path, file.bytes);
  for (const char* gone : {"m.yaml", "one.csv", "two.csv"}) std::filesystem::remove(folder_.file(gone));
  StudyPlanOptions options;
  options.kept = true;
  for (const bool look : {false, true}) {
    options.look = look;
    const auto copy = read("dir/study.yaml", options);
    ASSERT_TRUE(copy) << messages_;
    EXPECT_EQ(copy->identity(), plan->identity());
  }
  write("one.csv", "t,x\n0,0\n1,1\n");
  write("m.yaml",
        moved + "{f: {cases: {a: {drivers.d.table.file: one.csv}, b: {drivers.d.table.file: other/one.csv}}}}\n");
  EXPECT_FALSE(read("m.yaml", {}));
  EXPECT_NE(messages_.find("different files that are called 'one.csv'"), std::string::npos) << messages_;
}

TEST_F(StudyPlanning, ACopyThatIsDamagedIsNone) {
  const auto plan = of_ball("  axes: {g: [1]}\n");
  for (const KeptFile& file : plan->kept_files()) write(file.path, file.bytes);
  StudyPlanOptions options;
  options.kept = true;
  EXPECT_TRUE(read("study.yaml", options));
  for (const char* record :
       {"", "{}", "[]", R"({"name": 1, "set": [], "models": []})", R"({"name": "a", "set": [], "models": []})",
        R"({"name": "a", "set": [["g"]], "models": [{"name": "b", "file": "c"}]})",
        R"({"name": "a", "set": [], "models": [{"name": "b"}]})"}) {
    write("inputs/study.json", record);
    EXPECT_THROW(read("study.yaml", options), Error) << record;
  }
}

// --- units ---------------------------------------------------------------------------------------------------------

void expect_units_are_all_points(const StudyPlan& plan) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t unit = 0; unit < plan.units(); ++unit) {
    for (std::uint64_t place = 0; place < plan.unit_size(unit); ++place) {
      const std::uint64_t point = plan.unit_point(unit, place);
      EXPECT_LT(point, plan.points());
      EXPECT_TRUE(seen.insert(point).second);
      EXPECT_EQ(plan.place_of(point).unit, unit);
      EXPECT_EQ(plan.place_of(point).place, place);
    }
  }
  EXPECT_EQ(seen.size(), plan.points());
}

TEST_F(StudyPlanning, AUnitIsAPoint) {
  const auto plan = of_ball("  axes: {g: [1, 2], v: [3, 4]}\n");
  expect_units_are_all_points(*plan);
  EXPECT_EQ(plan->unit_point(3, 0), 3u);
  EXPECT_FALSE(plan->chained());
}

TEST_F(StudyPlanning, AChainGoesAlongItsAxisInPieces) {
  for (const char* direction : {"up", "down", "both"}) {
    const auto plan = of_ball(std::string("  axes: {v: [7, 8], g: {linspace: [1, 7, 7]}, bodies.ball.mass: [1, 2, 3]}\n"
                                          "  warm_start: {along: g, pieces: 3, direction: ") +
                              direction + "}\n");
    ASSERT_TRUE(plan) << messages_;
    expect_units_are_all_points(*plan);
    EXPECT_EQ(plan->units(), 2u * 3 * 3);
    EXPECT_EQ(plan->points(), 42u * (std::string(direction) == "both" ? 2 : 1));
  }
}

TEST_F(StudyPlanning, AChainGoesUpAndBackFromTheLastPoint) {
  const auto plan = of_ball("  axes: {g: [1, 2, 3]}\n  warm_start: {along: g, direction: both}\n");
  std::string way;
  for (std::uint64_t place = 0; place < plan->unit_size(0); ++place) {
    const StudyPoint point = plan->point(plan->unit_point(0, place));
    way += point.direction + point.cells[0] + " ";
  }
  EXPECT_EQ(way, "up1 up2 up3 down3 down2 down1 ");
  EXPECT_TRUE(plan->has_direction_column());
}

TEST_F(StudyPlanning, AHashInAChainFollowsFromThoseBefore) {
  const auto plan = of_ball("  axes: {g: [1, 1, 1]}\n  warm_start: {along: g}\n");
  const std::string head = "freeplay-point 1\nmodel " + plan->models()[0].sha256 + "\ng=1\n";
  const std::string first = sha256(head).substr(0, 24), second = sha256(head + "after " + first + "\n").substr(0, 24);
  EXPECT_EQ(plan->hash(2), sha256(head + "after " + second + "\n").substr(0, 24));
  EXPECT_EQ(plan->hash(0), first);
  EXPECT_EQ(plan->hash(1), second);
  const auto chains = of_ball("  axes: {v: [3, 4], g: [1, 2]}\n  warm_start: {along: g}\n");
  const std::string one = chains->hash(1), other = chains->hash(3);
  EXPECT_NE(one, other);
  EXPECT_EQ(chains->hash(1), one);
}

TEST_F(StudyPlanning, WithARuleForTheEndSamplesComeInOrder) {
  const auto plan = of_ball(
      "  axes: {v: [1, 2], g: {normal: [10, 2]}}\n  sample: {method: random, points: 5, seed: 1}\n"
      "  reducers: {y: {channel: body.ball.y, reduce: final}}\n"
      "  stop: {reducer: y, of: p95, relative: 0.1}\n");
  ASSERT_TRUE(plan) << messages_;
  expect_units_are_all_points(*plan);
  for (std::uint64_t unit = 0; unit < 10; ++unit) {
    EXPECT_EQ(plan->point(plan->unit_point(unit, 0)).sample, unit / 2);
  }
  EXPECT_EQ(plan->samples(), 5u);
  EXPECT_EQ(plan->section().stop->percentile, 95.0);
}

TEST_F(StudyPlanning, HugeStudiesTakeNoMemory) {
  StudyPlanOptions options;
  options.many_points = true;
  const auto plan = of_ball("  axes: {g: {linspace: [1, 2, 1000000]}, v: {linspace: [0, 1, 1000000]}}\n", options);
  ASSERT_TRUE(plan) << messages_;
  EXPECT_EQ(plan->points(), 1'000'000'000'000u);
  EXPECT_THAT(plan->point(999'999'999'999).cells, ElementsAre("2", "1"));
  EXPECT_EQ(of_ball("  axes: {g: {linspace: [1, 2, 10000000]}, v: {linspace: [0, 1, 1000000]}}\n", options), nullptr);
}

}  // namespace
}  // namespace freeplay
