#include <algorithm>

#include <gtest/gtest.h>

#include "model_text.h"
#include "unit/scratch_folder.h"

namespace freeplay {
namespace {

/// A rod on a pin that a table drives; `table` stands on line 6 from column 41 on.
Built driven(const std::string& table, const std::string& kind = "angle") {
  return build(
      with_rod("joints: {A: {type: pin, between: [ground, rod/tip]}}\n"
               "drivers:\n"
               "  motor: {joint: A, kind: " +
               kind + ", table: " + table + "}\n"));
}

double value_at(const Built& built, double t) {
  Jet jet;
  EvaluationFailure failure;
  EXPECT_TRUE(built.model->drivers.front().table->evaluate(t, jet, failure));
  return jet.value;
}

TEST(DriverTable, ReadsPointsWithUnits) {
  const Built built = driven("{points: [[0, 0], [500 ms, 90 deg], [1, pi]], interpolation: linear}");
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_NEAR(value_at(built, 0.25), M_PI / 4, 1e-15);
  EXPECT_NEAR(value_at(built, 1.0), M_PI, 1e-15);
}

TEST(DriverTable, GivesBareNumbersTheUnitOfTheirColumn) {
  const Built built =
      driven("{points: [[0, 0], [1000, 90], [2 s, (pi) rad]], time_unit: ms, unit: deg, interpolation: linear}");
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_NEAR(value_at(built, 1.0), M_PI / 2, 1e-15);
  EXPECT_NEAR(value_at(built, 2.0), M_PI, 1e-15);
}

TEST(DriverTable, TimesMustIncrease) {
  EXPECT_EQ(driven("{points: [[0, 1], [1, 2], [1, 3]]}").places, "6:68 bad-table ");
}

TEST(DriverTable, NeedsEnoughRows) {
  EXPECT_EQ(driven("{points: [[0, 1]]}").places, "6:50 bad-table ");
  EXPECT_EQ(driven("{points: [[0, 1], [1, 1]], ends: periodic}").places, "6:50 bad-table ");
  EXPECT_EQ(driven("{points: [[0, 1], [1, 2], [2, 3]], ends: periodic}").places, "6:50 bad-table ");
}

TEST(DriverTable, ChecksUnitsAgainstTheKind) {
  EXPECT_EQ(driven("{points: [[0, 1], [1, 2]], unit: mm}").places, "6:74 dimension-mismatch ");
  EXPECT_EQ(driven("{points: [[0, 1], [1, 2]], time_unit: m}").places, "6:79 dimension-mismatch ");
  EXPECT_EQ(driven("{points: [[0, 1], [1, 2]], unit: furlong}").places, "6:74 bad-unit ");
  EXPECT_EQ(driven("{points: [[0, 1], [1, 2 mm]]}").places, "6:63 dimension-mismatch ");
}

TEST(DriverTable, NeedsOneSourceOfPoints) {
  EXPECT_EQ(driven("{ends: natural}").places, "6:34 missing-key ");
  EXPECT_EQ(driven("{file: a.csv, points: [[0, 1], [1, 2]]}").places, "6:55 conflicting-keys ");
  EXPECT_EQ(driven("{points: [[0, 1], [1, 2]], value: x}").places, "6:68 conflicting-keys ");
  EXPECT_EQ(driven("[1, 2]").places, "6:41 wrong-type ");
}

TEST(DriverTable, IsTriedAtTheStart) {
  EXPECT_EQ(driven("{points: [[1, 1], [2, 2]], outside: error}").places, "6:41 bad-table ");
  EXPECT_TRUE(driven("{points: [[1, 1], [2, 2]]}").model);
}

TEST(DriverTable, ReadsColumnsOfAFileOnceAndKeepsItAsAnInput) {
  const ScratchFolder folder;
  folder.write("motor.csv", "# of the test bench\nt,speed,angle\n0,1,0\n1000,2,90\n");
  const std::string file = folder.file("motor.csv").string();
  const Built built = driven("{file: " + file + ", value: angle, time_unit: ms, unit: deg}");
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_NEAR(value_at(built, 0.5), M_PI / 4, 1e-15);
  ASSERT_EQ(built.model->inputs.size(), 1u);
  EXPECT_EQ(built.model->inputs.front().name, "motor.csv");
  EXPECT_EQ(built.model->inputs.front().text, folder.read("motor.csv"));
}

TEST(DriverTable, IsSharedByAllThatReadTheSameColumnsTheSameWay) {
  const ScratchFolder folder;
  folder.write("motor.csv", "t,x\n0,1\n1,2\n");
  const auto table = [&](const std::string& name) { return folder.file(name).string(); };
  std::string text = "freeplay: 1\nbodies:\n", joints = "joints:\n", drivers = "drivers:\n";
  const std::string files[] = {table("motor.csv"), table("./motor.csv"),
                               "{file: " + table("motor.csv") + ", unit: deg}"};
  for (int i = 0; i < 3; ++i) {
    const std::string n = std::to_string(i);
    text += "  b" + n + ": {mass: 1, inertia: 1}\n";
    joints += "  j" + n + ": {type: pin, between: [ground, b" + n + "]}\n";
    drivers += "  d" + n + ": {joint: j" + n + ", kind: angle, table: " + files[i] + "}\n";
  }
  const Built built = build(text + joints + drivers);
  ASSERT_TRUE(built.model) << built.report;
  const auto& made = built.model->drivers;
  EXPECT_EQ(made[0].table, made[1].table);
  EXPECT_NE(made[0].table, made[2].table);
  EXPECT_EQ(built.model->inputs.size(), 1u);
}

TEST(DriverTable, RefusesAFileWithTooManyColumns) {
  const ScratchFolder folder;
  folder.write("wide.csv", std::string(20'000, ',') + "\n0,1\n1,2\n");
  EXPECT_EQ(driven(folder.file("wide.csv").string()).places, "6:41 too-large ");
}

TEST(DriverTable, ReportsMistakesInTheFile) {
  const ScratchFolder folder;
  const std::string file = folder.file("motor.csv").string();
  const auto report = [&](const std::string& text, const std::string& more = "") {
    folder.write("motor.csv", text);
    const Built built = driven("{file: " + file + more + "}");
    return built.places;
  };
  EXPECT_EQ(report("t,x\n0,1\n1,two\n"), "3:3 bad-table ");
  EXPECT_EQ(report("t,x\n0,1\n1\n"), "3:2 bad-table ");
  EXPECT_EQ(report("t,x\n0,1\n 0,2\n"), "3:2 bad-table ");
  EXPECT_EQ(report("t,x\n0,1\n"), "2:1 bad-table ");
  EXPECT_EQ(report("t\n0\n1\n"), "1:1 bad-table ");
  EXPECT_EQ(report(""), "1:1 bad-table ");
  EXPECT_EQ(report("t,x\n0,1\n1,2\n", ", value: y").substr(0, 2), "6:");
  EXPECT_EQ(driven(folder.file("none.csv").string()).places, "6:41 file-not-found ");
  EXPECT_EQ(driven("/dev/zero").places, "6:41 file-not-found ");
}

/// Places of the messages on a file with this text.
std::string places_in(const std::string& text, const std::string& more = "") {
  const ScratchFolder folder;
  folder.write("motor.csv", text);
  return driven("{file: " + folder.file("motor.csv").string() + more + "}").places;
}

TEST(DriverTable, RefusesRowsWithMoreFieldsThanTheHeader) {
  EXPECT_EQ(places_in("t,x\n0,0\n1,1,5\n2,3\n"), "3:5 bad-table ");
  EXPECT_EQ(places_in("t,x\n0,0\n1,1,\n"), "3:5 bad-table ");
  EXPECT_EQ(places_in("t,x,note\n0,0\n1,1,5\n"), "");  // fewer are none that is read
}

TEST(DriverTable, NeedsAHeaderOfNames) {
  EXPECT_EQ(places_in("# bench\n0,7\n1,1\n2,3\n"), "2:1 bad-table ");
  EXPECT_EQ(places_in("t, 7\n1,1\n2,3\n"), "1:4 bad-table ");
  EXPECT_EQ(places_in("t,7\n0,1\n2,3\n", ", value: 7"), "");  // a name that was asked for
}

TEST(DriverTable, RefusesTwoColumnsOfOneName) {
  EXPECT_EQ(places_in("time,angle,angle\n0,7,1\n1,1,3\n", ", value: angle"), "1:12 bad-table ");
  EXPECT_EQ(places_in("time,angle,,\n0,5,1,2\n1,1,3,2\n"), "");  // columns without names are not read
}

TEST(DriverTable, ReportsAllMistakesOfAFileUpToALimit) {
  EXPECT_EQ(places_in("t,x\n0,a\n1,nan\n2,1e999\n1,3\n"), "2:3 bad-table 3:3 bad-table 4:3 bad-table 5:1 bad-table ");
  // One time out of order is one mistake.
  EXPECT_EQ(places_in("t,x\n0,1\n5,1\n2,1\n3,1\n"), "4:1 bad-table ");
  std::string many = "t,x\n";
  for (int i = 0; i < 1000; ++i) many += std::to_string(i) + ",\n";
  const std::string places = places_in(many);
  EXPECT_EQ(std::ranges::count(places, ' '), 2 * 101);
  EXPECT_NE(places.find(" 102:1 bad-table "), std::string::npos);
}

TEST(DriverTable, ReportsALineThatExists) {
  EXPECT_EQ(places_in("# bench\nt;v\n0;1\n1;2\n"), "2:1 bad-table ");
  EXPECT_EQ(places_in("# bench\nt,v\n"), "2:1 bad-table ");
  EXPECT_EQ(places_in("# nothing\n"), "1:1 bad-table ");
}

TEST(DriverTable, SaysThatAFileIsNotUtf8) {
  const ScratchFolder folder;
  const auto report = [&](const std::string& text) {
    folder.write("motor.csv", text);
    return driven("{file: " + folder.file("motor.csv").string() + "}");
  };
  const Built latin = report("t,x\n0,1 \xB0\n1,2\n");
  EXPECT_EQ(latin.places, "2:5 bad-table ");
  EXPECT_NE(latin.report.find("not UTF-8"), std::string::npos) << latin.report;
  EXPECT_EQ(report("\xFF\xFEt").places, "1:1 bad-table ");
  EXPECT_EQ(report(std::string("t\0,\0x\0\n\0", 8)).places, "1:2 bad-table ");
}

}  // namespace
}  // namespace freeplay
