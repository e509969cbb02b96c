// Parameters that are lists of numbers or tables of points.
#include <fstream>

#include <gtest/gtest.h>

#include "component/instances.h"
#include "model_text.h"
#include "unit/scratch_folder.h"

namespace freeplay {
namespace {

const double* first_of_last = nullptr;  // where the list of the law that was made last stands

/// A law that refuses what it does not like at its place, and keeps no copy of its numbers.
class Measured final : public FrictionLaw {
 public:
  explicit Measured(const Parameters& p) : speeds_(p.list("speeds")), loads_(p.table("loads")) {
    first_of_last = speeds_.data;
    for (std::size_t i = 0; i < speeds_.size; ++i)
      if (speeds_[i] > 0.09) throw BadParameter("speeds", i, "out-of-range", "too fast");
    for (std::size_t i = 0; i < loads_.x.size; ++i)
      if (loads_.y[i] == 13.0) throw BadParameter("loads", i, "out-of-range", "thirteen");
  }
  FrictionForce evaluate(const FrictionState&, Span<double>) const override {
    double sum = 0.0;
    for (const double speed : speeds_) sum += speed;
    for (std::size_t i = 0; i < loads_.x.size; ++i) sum += 1e3 * loads_.x[i] + 1e6 * loads_.y[i];
    return {sum, 0.0, 0.0};
  }

 private:
  Span<const double> speeds_;
  TablePoints loads_;
};

constexpr Parameter measured_parameters[] = {
    {.name = "speeds",
     .kind = ParameterKind::list,
     .unit = "mm/s",
     .minimum = 0.0,
     .maximum = 100.0,
     .open = Open::minimum,
     .least = 2,
     .most = 4},
    {.name = "loads",
     .kind = ParameterKind::table,
     .unit = "N",
     .default_value = optional,
     .maximum = 50.0,
     .variables = "depth: m",
     .least = 2,
     .most = 5},
};

Status publish_measured(const Host* host, Manifest* manifest) noexcept {
  static const Component components[] = {
      friction_law<Measured>({.name = "measured", .parameters = measured_parameters})};
  return publish(*host, *manifest, "measured", "1", components);
}

Built build_pin(const std::string& keys, const BuildOptions& options = {}) {
  static const Registry registry = [] {
    Registry all;
    all.add(&toy::publish_toys, "toys");
    all.add(&publish_measured, "measured");
    return all;
  }();
  Diagnostics diagnostics;
  Built built;
  const std::optional<Document> document = parse_yaml(with_rod("joints:\n"
                                                               "  a:\n"
                                                               "    type: pin\n"
                                                               "    between: [ground, rod]\n"
                                                               "    play:\n"
                                                               "      gap: 1 mm\n"
                                                               "      contact: {law: power, K: 1e9}\n"
                                                               "      friction:\n"
                                                               "        law: measured\n" +
                                                               keys),
                                                      "m.yaml", diagnostics);
  if (document) built.model = build_model(*document, registry, options, diagnostics);
  built.report = diagnostics.format(0);
  for (const Diagnostic& d : diagnostics.sorted()) {
    built.places += std::to_string(d.location.line) + ":" + std::to_string(d.location.column) + " " + d.id + " ";
  }
  return built;
}

const ParameterBlock& law_of(const Built& built) {
  return *built.model->joints[0].parameters->values.find("play.friction")->second.law;
}

TEST(PointParameters, AreReadWithTheUnitOfEachNumber) {
  const Built built = build_pin("        speeds: [0.03, 1 mm/s, 2 cm/s]\n        loads: [[0, 1], [10 mm, 1 kN/200]]\n");
  ASSERT_TRUE(built.model) << built.report;
  const ParameterPoints &speeds = *law_of(built).values.find("speeds")->second.points,
                        &loads = *law_of(built).values.find("loads")->second.points;
  EXPECT_EQ(speeds.y, (std::vector<double>{0.03, 1e-3, 2e-2}));
  EXPECT_TRUE(speeds.x.empty());
  EXPECT_EQ(loads.x, (std::vector<double>{0.0, 0.01}));
  EXPECT_EQ(loads.y, (std::vector<double>{1.0, 5.0}));
}

TEST(PointParameters, ThatAreOptionalMayBeAbsent) {
  const Built built = build_pin("        speeds: [1 mm/s, 2 mm/s]\n");
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_EQ(law_of(built).values.find("loads")->second.points, nullptr);
}

/// Keys of the law with its numbers in a file, and where that is. Tests run beside each other.
struct FromFile {
  FromFile(const char* name, const std::string& text) : path(folder.file(std::string(name) + ".csv").string()) {
    std::ofstream(path) << text;
  }
  ScratchFolder folder;
  std::string path;
};

TEST(PointParameters, AreColumnsOfAFile) {
  const FromFile file("measured", "# by hand\nspeed, depth, load\n30, 0, 0.001\n1, 10, 0.005\n20, 20, 0.007\n");
  const Built built = build_pin("        speeds: {file: " + file.path +
                                ", value: speed, unit: mm/s}\n        loads: {file: " + file.path +
                                ", x: depth, value: load, x_unit: mm, unit: kN}\n");
  ASSERT_TRUE(built.model) << built.report;
  const ParameterPoints &speeds = *law_of(built).values.find("speeds")->second.points,
                        &loads = *law_of(built).values.find("loads")->second.points;
  EXPECT_EQ(speeds.y, (std::vector<double>{0.03, 1e-3, 2e-2}));
  EXPECT_TRUE(speeds.x.empty());
  EXPECT_EQ(loads.x, (std::vector<double>{0.0, 0.01, 0.02}));
  EXPECT_EQ(loads.y, (std::vector<double>{1.0, 5.0, 7.0}));
  EXPECT_EQ(built.model->inputs.size(), 1u);  // kept with a result
}

TEST(PointParameters, AreTheFirstColumnsOfAFileThatIsNamedAlone) {
  const FromFile list("alone", "speed\n0.01\n0.02\n"), table("pair", "depth, load\n0, 1\n1, 2\n");
  const Built built = build_pin("        speeds: " + list.path + "\n        loads: " + table.path + "\n");
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_EQ(law_of(built).values.find("speeds")->second.points->y, (std::vector<double>{0.01, 0.02}));
  EXPECT_EQ(law_of(built).values.find("loads")->second.points->x, (std::vector<double>{0.0, 1.0}));
}

struct FileMistake {
  const char *name, *text, *keys, *place, *words;
};
void PrintTo(const FileMistake& m, std::ostream* out) { *out << m.name; }
class FileMistakes : public ::testing::TestWithParam<FileMistake> {};

// `FILE` in the keys is its path.
TEST_P(FileMistakes, AreReportedAtTheirPlace) {
  const FromFile file("mistake", GetParam().text);
  std::string keys = GetParam().keys;
  for (std::size_t at = keys.find("FILE"); at != std::string::npos; at = keys.find("FILE", at + file.path.size()))
    keys.replace(at, 4, file.path);
  const Built built = build_pin(keys);
  EXPECT_FALSE(built.model);
  EXPECT_TRUE(built.places.starts_with(GetParam().place)) << built.places << built.report;
  EXPECT_NE(built.report.find(GetParam().words), std::string::npos) << built.report;
}

INSTANTIATE_TEST_SUITE_P(
    All, FileMistakes,
    ::testing::Values(
        FileMistake{"no file", "", "        speeds: none.csv\n", "13:17 file-not-found ", "none.csv"},
        FileMistake{"too few rows", "speed\n0.01\n", "        speeds: {file: FILE}\n", "13:24 wrong-length ",
                    "must have 2 to 4 numbers, not 1"},
        FileMistake{"no number", "speed\n0.01\nfast\n", "        speeds: {file: FILE}\n", "3:1 bad-table ",
                    "'fast' is not a number"},
        FileMistake{"bounds", "speed\n10\n101\n", "        speeds: {file: FILE, unit: mm/s}\n", "3:1 out-of-range ",
                    "must be > 0 m/s and <= 0.1 m/s, not 0.101 m/s"},
        FileMistake{"fault of a constructor", "n, speed\n1, 0.01\n2, 0.095\n",
                    "        speeds: {file: FILE, value: speed}\n", "3:4 out-of-range ", "too fast"},
        FileMistake{"unknown column", "n, speed\n1, 0.01\n2, 0.02\n", "        speeds: {file: FILE, value: sped}\n",
                    "13:", "did you mean 'speed'?"},
        FileMistake{"unit", "speed\n1\n2\n", "        speeds: {file: FILE, unit: mm}\n", "13:", "must be a unit of"},
        FileMistake{"one column", "load\n1\n2\n", "        speeds: [0.01, 0.02]\n        loads: {file: FILE}\n",
                    "1:1 bad-table ", "a table needs two columns"},
        FileMistake{"x that falls", "depth, load\n0, 1\n2, 2\n2, 3\n",
                    "        speeds: [0.01, 0.02]\n        loads: {file: FILE}\n", "4:1 bad-table ",
                    "the first numbers of points must increase: 2 follows 2"},
        FileMistake{"x of a list", "speed\n0.01\n0.02\n", "        speeds: {file: FILE, x: speed}\n",
                    "13:", "unknown key 'x'"},
        FileMistake{"point that a constructor refuses", "depth, load\n0, 1\n1, 13\n",
                    "        speeds: [0.01, 0.02]\n        loads: {file: FILE}\n", "3:4 out-of-range ", "thirteen"}));

struct PointMistake {
  const char *name, *keys, *place, *words;
};
void PrintTo(const PointMistake& m, std::ostream* out) { *out << m.name; }
class PointMistakes : public ::testing::TestWithParam<PointMistake> {};

TEST_P(PointMistakes, AreReportedAtTheirPlace) {
  const Built built = build_pin(GetParam().keys);
  EXPECT_FALSE(built.model);
  EXPECT_EQ(built.places, GetParam().place) << built.report;
  EXPECT_NE(built.report.find(GetParam().words), std::string::npos) << built.report;
}

INSTANTIATE_TEST_SUITE_P(
    All, PointMistakes,
    ::testing::Values(
        PointMistake{"absent", "        loads: [[0, 1], [1, 2]]\n", "11:7 missing-key ", "'speeds'"},
        PointMistake{"no list", "        speeds: 3 mm/s\n", "13:17 wrong-type ", "must be a list of numbers"},
        PointMistake{"too short", "        speeds: [1 mm/s]\n", "13:17 wrong-length ",
                     "must have 2 to 4 numbers, not 1"},
        PointMistake{"too long", "        speeds: [0.01, 0.01, 0.01, 0.01, 0.01]\n", "13:17 wrong-length ", "not 5"},
        PointMistake{"unit", "        speeds: [1 mm/s, 2 mm]\n", "13:26 dimension-mismatch ", "expected velocity"},
        PointMistake{"bounds", "        speeds: [1 mm/s, 101 mm/s]\n", "13:26 out-of-range ", "speeds[1]"},
        PointMistake{"open end", "        speeds: [0, 1 mm/s]\n", "13:18 out-of-range ", "speeds[0]"},
        PointMistake{"two numbers", "        speeds: [-1, 101]\n", "13:18 out-of-range 13:22 out-of-range ", "speeds"},
        PointMistake{"fault of a constructor", "        speeds: [1 mm/s, 95 mm/s]\n", "13:26 out-of-range ",
                     "too fast"},
        PointMistake{"no points", "        speeds: [0.01, 0.02]\n        loads: [1, 2]\n",
                     "14:17 wrong-type 14:20 wrong-type ", "loads[0]"},
        PointMistake{"half a point", "        speeds: [0.01, 0.02]\n        loads: [[0, 1], [1]]\n",
                     "14:25 wrong-length ", "must have 2 items, not 1"},
        PointMistake{"one point", "        speeds: [0.01, 0.02]\n        loads: [[0, 1]]\n", "14:16 wrong-length ",
                     "must have 2 to 5 points [x, y], not 1"},
        PointMistake{"x that falls", "        speeds: [0.01, 0.02]\n        loads: [[0, 1], [2, 2], [2, 3]]\n",
                     "14:34 bad-table ", "'joints.a.play.friction.loads[2][0]' is 2 and follows 2"},
        PointMistake{"unit of x", "        speeds: [0.01, 0.02]\n        loads: [[0 s, 1], [1, 2]]\n",
                     "14:18 dimension-mismatch ", "expected length"},
        PointMistake{"bounds of y", "        speeds: [0.01, 0.02]\n        loads: [[0, 1], [1, 51 N]]\n",
                     "14:29 out-of-range ", "loads[1][1]"},
        PointMistake{"point that a constructor refuses",
                     "        speeds: [0.01, 0.02]\n        loads: [[0, 1], [1, 13 N]]\n", "14:25 out-of-range ",
                     "thirteen"}));

TEST(PointParameters, AreChangedByTheirPath) {
  BuildOptions options;
  options.set = {{"joints.a.play.friction.speeds.1", "7 mm/s"}, {"joints.a.play.friction.loads.1.0", "3"}};
  const Built built = build_pin("        speeds: [1 mm/s, 2 mm/s]\n        loads: [[0, 1], [1, 2]]\n", options);
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_EQ(law_of(built).values.find("speeds")->second.points->y, (std::vector<double>{1e-3, 7e-3}));
  EXPECT_EQ(law_of(built).values.find("loads")->second.points->x, (std::vector<double>{0.0, 3.0}));
}

// The law reads the host's own numbers, which live as long as it does: nothing is copied.
TEST(PointParameters, LiveAsLongAsTheComponent) {
  Built built = build_pin("        speeds: [1 mm/s, 2 mm/s]\n        loads: [[0, 1], [1, 2]]\n");
  ASSERT_TRUE(built.model) << built.report;
  auto block = std::make_unique<ParameterBlock>(law_of(built));
  built = {};
  Instances instances;
  CreationFault fault;
  const FrictionLawRef law = instances.create_friction_law(*block, fault);
  EXPECT_EQ(first_of_last, block->values.find("speeds")->second.points->y.data());
  block.reset();
  EXPECT_DOUBLE_EQ(law.evaluate({}, {}).tangential, 3e-3 + 1e3 * 1.0 + 1e6 * 3.0);
}

}  // namespace
}  // namespace freeplay
