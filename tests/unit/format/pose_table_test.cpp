// Files with the path of a frame: what is read, and what mistakes are answered.
#include "answers.h"
#include "unit/scratch_folder.h"

namespace freeplay {
namespace {

struct PathFile {
  const char *keys, *text;  ///< of the section beside the file, and the file
  const char* said;
};

constexpr PathFile in_the_plane[] = {
    {"", "", "1:1 bad-table: a table needs two columns and a header row | fields are separated by commas"},
    {"", "t,x\n", "1:1 bad-table: a table needs at least 2 rows"},
    {"", "t,x\n0,1\n", "2:1 bad-table: a table needs at least 2 rows"},
    {"", "t,x\n0,1\n1,2\n", "3:39 unused: frame 'tip' is not used"},
    {"", "t,xx\n0,1\n1,2\n", "1:3 unknown-name: 'xx' is no column of a path: after the time they are x, y, angle | x"},
    {"", "t,qw\n0,1\n1,2\n", "1:3 unknown-name: 'qw' is no column of a path: after the time they are x, y, angle"},
    {"", "t\n0\n1\n", "1:1 bad-table: a table needs two columns and a header row | fields are separated by commas"},
    {"", "t,x\n0,1\n0,2\n", "3:1 bad-table: times must increase: 0 s follows 0 s"},
    {"", "t,x\n0,a\n1,2\n", "2:3 bad-table: 'a' is not a number"},
    {"", "t,x\n0,1\n1\n", "3:2 bad-table: a number is missing"},
    {"", "t,x\n0,1\n1,2,3\n", "3:5 bad-table: this row has 3 fields, the header 2 | a decimal mark is a point: 1.5"},
    {"time: u", "t,x\n0,1\n1,2\n", "6:38 unknown-name: 'p.csv' has no column 'u'"},
    {"time: x", "t,x\n0,1\n1,2\n", "1:1 unknown-name: 't' is no column of a path: after the time they are x, y, angle"},
    {"time: t", "x,t\n0,1\n1,2\n", "3:39 unused: frame 'tip' is not used"},
    {"time: t", "x,t\n1,0\n2,1\n", "3:39 unused: frame 'tip' is not used"},
    {"time: [t]", "t,x\n0,1\n1,2\n", "6:38 wrong-type: 'analysis.path.time' must be a word or text, not a list"},
    {"time_unit: kg", "t,x\n0,1\n1,2\n",
     "6:43 dimension-mismatch: 'analysis.path.time_unit' must be a unit of time, not of mass"},
    {"unit: s", "t,x\n0,1\n1,2\n",
     "6:38 dimension-mismatch: 'analysis.path.unit' must be a unit of length, not of time"},
    {"unit: mm", "t,x\n0,1\n1,2\n", "3:39 unused: frame 'tip' is not used"},
    {"angle_unit: deg", "t,angle\n0,1\n1,2\n", "3:39 unused: frame 'tip' is not used"},
    {"ends: closed", "t,x\n0,1\n1,2\n",
     "6:38 wrong-type: 'analysis.path.ends' must be natural, clamped or periodic, not 'closed'"},
    {"ends: periodic", "t,x\n0,1\n1,2\n", "2:1 bad-table: a table needs at least 3 rows"},
    {"ends: periodic", "t,x\n0,1\n1,2\n2,3\n",
     "2:1 bad-table: first and last value of a periodic table must agree: 'x' is 1 and 3"},
    {"ends: periodic", "t,x\n0,1\n1,2\n2,1\n", "3:39 unused: frame 'tip' is not used"},
    {"ends: periodic, interpolation: linear", "t,x\n0,1\n1,2\n", "3:39 unused: frame 'tip' is not used"},
    {"outside: stop", "t,x\n0,1\n1,2\n",
     "6:41 wrong-type: 'analysis.path.outside' must be hold, repeat or error, not 'stop'"},
    {"outside: error", "t,x\n1,1\n2,2\n", "6:18 bad-table: the time is outside of the table: 0 s"},
    {"x: t", "t,x\n0,1\n1,2\n", "6:32 conflicting-keys: 'file' and 'x' exclude each other"},
    {"", "t,x,x\n0,1,2\n1,2,3\n", "1:5 bad-table: column 2 has the name 'x' already"},
    {"", "\"t\",\"x\"\n0,1\n1,2\n",
     "1:5 unknown-name: '\"x\"' is no column of a path: after the time they are x, y, angle | x"},
    {"", "t,x\n0,1\n1,1e999\n", "3:3 bad-table: the number '1e999' is too large"},
    {"", "# a comment\nt,x\n0,1\n1,2\n", "3:39 unused: frame 'tip' is not used"},
    {"", "t,,x\n0,1,2\n1,2,3\n", "1:3 unknown-name: '' is no column of a path: after the time they are x, y, angle"},
};

constexpr PathFile in_space[] = {
    {"", "t,x,y,z\n0,1,1,1\n1,2,2,2\n", "4:47 unused: frame 'tip' is not used"},
    {"", "t,angle\n0,1\n1,2\n",
     "1:3 unknown-name: 'angle' is no column of a path: after the time they are x, y, z, qw, qx, qy, qz"},
    {"", "t,qw\n0,1\n1,1\n",
     "1:1 bad-table: the column 'qx' is missing: a quaternion has qw, qx, qy and qz\n1:1 bad-table: the column 'qy' is "
     "missing: a quaternion has qw, qx, qy and qz\n1:1 bad-table: the column 'qz' is missing: a quaternion has qw, qx, "
     "qy and qz"},
    {"", "t,qw,qx,qy,qz\n0,1,0,0,0\n1,1,0,0,0\n", "4:47 unused: frame 'tip' is not used"},
    {"", "t,qw,qx,qy,qz\n0,1,0,0,0\n1,1,1,0,0\n", "3:3 bad-table: the quaternion has the length 1.41421, not 1"},
    {"", "t,qw,qx,qy,qz\n0,1,0,0,0\n1,0,1,0,0\n",
     "3:3 bad-table: the frame turns by about half a turn since the row before, one way or the other | give more rows, "
     "less than 170 deg apart"},
    {"", "t,qw,qx,qy,qz\n0,1,0,0,0\n1,-1,0,0,0\n", "4:47 unused: frame 'tip' is not used"},
    {"", "t,qw,qx,qy,qz\n0,1,0,0,0\n1,0.8,0.6,0,0\n2,0,1,0,0\n3,-0.8,0.6,0,0\n4,-1,0,0,0\n",
     "4:47 unused: frame 'tip' is not used"},
    {"ends: periodic", "t,qw,qx,qy,qz\n0,1,0,0,0\n1,0.6,0.8,0,0\n2,-0.6,0.8,0,0\n3,-1,0,0,0\n",
     "2:1 bad-table: first and last value of a periodic table must agree: 'qw' is 1 and -1 | after an odd number of "
     "turns the quaternion comes back with the other sign"},
    {"angle_unit: deg", "t,qw,qx,qy,qz\n0,1,0,0,0\n1,1,0,0,0\n", "4:47 unused: frame 'tip' is not used"},
};

void expect_files_answered(const std::string& model, std::span<const PathFile> files) {
  const ScratchFolder folder;
  for (const PathFile& file : files) {
    folder.write("p.csv", file.text);
    const std::string keys = std::string(*file.keys == '\0' ? "" : ", ") + file.keys;
    EXPECT_EQ(said_of(test::replaced(model, "@", keys), {}, folder.file("m.yaml").string()), file.said)
        << file.keys << "\n"
        << file.text;
  }
}

TEST(PoseTable, MistakesHaveTheirPlace) {
  expect_files_answered(
      "freeplay: 1\nbodies:\n  rod: {mass: 1, inertia: 1, frames: {tip: [1, 0]}}\njoints:\n  A: {type: revolute, "
      "between: "
      "[ground, rod]}\nanalysis: {path: {file: p.csv@}}\n",
      in_the_plane);
  expect_files_answered(
      "freeplay: 1\nspace: spatial\nbodies:\n  rod: {mass: 1, inertia: [1, 1, 1], frames: {tip: [1, 0, 0]}}\njoints:\n "
      " A: "
      "{type: revolute, between: [ground, rod]}\nanalysis: {path: {file: p.csv@}}\n",
      in_space);
}

}  // namespace
}  // namespace freeplay
