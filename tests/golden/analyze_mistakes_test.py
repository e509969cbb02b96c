"""freeplay analyze: poses that no mechanism takes, and words that are none."""
import json
import math
import os
import unittest

from analyze_cases import FOUR_BAR, KINDS, AnalyzeTest
from program import mechanism

PARALLEL = """freeplay: 1
bodies:
  ground: {frames: {A1: [0, 0], A2: [0.2, 0], A3: [0.4, 0]}}
  crank1: {mass: 0.3, inertia: 1e-3, frames: {tip: [0.1, 0]}, pose: {angle: 60 deg}}
  crank2: {mass: 0.3, inertia: 1e-3, frames: {tip: [0.1, 0]}, pose: {position: [0.2, 0], angle: 60 deg}}
  crank3: {mass: 0.3, inertia: 1e-3, frames: {tip: [0.1, 0]}, pose: {position: [0.4, 0], angle: 60 deg}}
  bar: {mass: 0.9, inertia: 6e-3, frames: {B1: [0, 0], B2: [0.2, 0], B3: [0.4, 0]}, pose: {position: [0.05, 0.0866025403784]}}
joints:
  A1: {type: revolute, between: [ground/A1, crank1]}
  A2: {type: revolute, between: [ground/A2, crank2]}
  A3: {type: revolute, between: [ground/A3, crank3]}
  B1: {type: revolute, between: [crank1/tip, bar/B1]}
  B2: {type: revolute, between: [crank2/tip, bar/B2]}
  B3: {type: revolute, between: [crank3/tip, bar/B3]}
drivers:
  m1: {joint: A1, kind: angle, value: 60 deg}
analysis: {frame: bar/B2, joints: [A1], error: {clearance: {B3: 0.1 mm}}}
simulation: {end: 1 s, step: 1 ms}
"""


class AnalyzeMistakes(AnalyzeTest):
    def test_no_platform(self):
        model = self.write("m.yaml", FOUR_BAR)
        for kind in KINDS:
            self.assertIn("[missing-key]", self.message(kind, model, code=3))
        self.assertIn("'analysis' needs 'grid'", self.message("error", model, "--frame", "coupler/P", code=3))

    def test_fewer_drivers_than_freedoms(self):
        model = self.write("m.yaml", self.text("3-rrr").replace(
            "analysis:\n", "analysis:\n  joints: [leg1.A, leg2.A]\n"))
        err = self.message("error", model, "--pose", "0.05,0,0", code=3)
        self.assertIn("fewer drivers than freedoms: with all 2 inputs held the mechanism still has 1 freedom", err)
        self.assertIn("joints: [leg1.A, leg2.A]", err)

    def test_unreachable_poses(self):
        for kind in ("ik", "inverse-dynamics"):
            err = self.message(kind, mechanism("3-rrr"), "--pose", "0.3,0,0", code=4)
            self.assertIn("the leg of 'leg1.A' does not reach it: its pins are 0.569902 m apart", err)
        out, err = self.freeplay("analyze", "error", mechanism("3-rrr"), "--pose", "0.3,0,0")
        self.assertTrue(out.splitlines()[1].startswith("0.3,0,0,0,,"))
        self.assertIn("leg1.A", err)
        error = json.loads(self.freeplay("analyze", "ik", mechanism("3-rrr"), "--pose", "0.3,0,0", "--json", code=4)[0])
        self.assertEqual("ik-unreachable", error["error"]["messages"][0]["id"])

    def test_singular_poses(self):
        theta = repr(-math.acos((0.16 + 0.35 ** 2 - 0.24 ** 2) / (0.8 * 0.35)))
        row, = self.rows("singularity", mechanism("3-rrr"), "--pose", "0,0," + theta)
        self.assertEqual("direct", row["kind"])
        out, err = self.freeplay("analyze", "error", mechanism("3-rrr"), "--pose", "0,0," + theta)
        self.assertTrue(out.splitlines()[1].endswith(",1,,,,,,,,"))
        self.assertIn("singular", err)
        self.assertIn("[singular]", self.message("inverse-dynamics", mechanism("3-rrr"), "--pose", "0,0," + theta, code=4))

    def test_poses_on_a_fold_are_reached_and_singular(self):
        # 0.35 m is the reach of a leg of the five-bar, 50 + 120 mm that of the crank's slider.
        for words, poses in ((("five-bar",), ("0.11,0.28", "0.25,0")), (("slider-crank", "--frame", "slider"), ("x=0.17", "x=0.07"))):
            for pose in poses:
                row, = self.rows("singularity", mechanism(words[0]), *words[1:], "--pose", pose)
                self.assertEqual(("1", "inverse"), (row["reachable"], row["kind"]), pose)
        # On a path through it the speeds have no value, and the leg goes back to its side.
        model = self.write("m.yaml", self.text("five-bar").replace("250 mm + 40 mm*sin(4*pi*t/1 s)", "280 mm").replace(
            "x: 40 mm*cos(4*pi*t/1 s)", "x: 80 mm + 30 mm*sin(4*pi*t/1 s)"))
        before, at, after = self.rows("ik", model, "--time", "0.115:0.135:3")
        self.assertEqual("", at["joint.A1.speed"])
        self.assertAlmostEqual(float(before["joint.A1.angle"]), float(after["joint.A1.angle"]), 9)
        self.assertAlmostEqual(math.atan2(0.28, 0.21), float(at["joint.A1.angle"]), 6)
        # Three parallel cranks in one line.
        self.write("p.yaml", PARALLEL)
        row, = self.rows("singularity", "p.yaml", "--pose", "x=0.3")
        self.assertEqual(("1", "inverse"), (row["reachable"], row["kind"]))

    def test_a_grid_without_a_reachable_point(self):
        for kind in ("workspace", "singularity", "error"):
            out, err = self.freeplay("analyze", kind, mechanism("3-rrr"), "--grid", "x=1:2:3", "--grid", "y=1:2:3",
                                     "--svg", "m.svg")
            self.assertEqual(10, len(out.splitlines()))
            self.assertIn("no point of the grid can be reached", err)

    def test_mistypes(self):
        model = mechanism("3-rrr")
        for words, code, text in (
                (("eror", model), 2, "did you mean 'error'?"),
                (("error",), 2, "analyze needs a kind and a model file"),
                (("error", model, "--pose", "0.05"), 2, "gives 1 of x, y and angle"),
                (("error", model, "--pose", "x=0.05,angel=0"), 2, "did you mean 'angle'?"),
                (("error", model, "--pose", "x=0.05,0"), 2, "either all values have a name"),
                (("error", model, "--pose", "1,2,3,4"), 2, "at most x, y and angle"),
                (("error", model, "--pose", "0 s,0,0"), 2, "[bad-value]"),
                (("error", model, "--pose", "x=0,x=1"), 2, "'x' is given twice"),
                (("error", model, "--grid", "x=0:1"), 2, "FROM:TO:COUNT is needed"),
                (("error", model, "--grid", "z=0:1:2"), 2, "'z' is none of x, y and angle"),
                (("error", model, "--grid", "x=0:1:0"), 2, "the count must be a whole number"),
                (("error", model, "--grid", "x=0:1:2", "--grid", "x=0:1:2"), 2, "given twice"),
                (("error", model, "--grid", "x=0:1:1000000"), 2, "at most 10^6 points"),
                (("error", model, "--time", "0:1:2", "--pose", "0,0,0"), 2, "exclude each other"),
                (("error", model, "--elbow", "2", "--pose", "0,0,0"), 2, "1 or -1"),
                (("error", model, "--elbow", "1,1", "--pose", "0,0,0"), 2, "2 values, but 3 joints"),
                (("error", model, "--input", "leg1.a=1"), 2, "did you mean 'leg1.A'?"),
                (("error", model, "--input", "leg1.A=1"), 2, "gives 1 input, but the mechanism has 3 freedoms"),
                (("error", model, "--frame", "platfrom", "--pose", "0,0,0"), 2, "did you mean 'platform'?"),
                (("error", model, "--frame", "ground", "--pose", "0,0,0"), 3, "is on ground"),
                (("ik", model, "--samples", "9"), 2, "--samples is for error, not for ik"),
                (("error", model, "--pose", "0,0,0", "--samples", "many"), 2, "[bad-value]"),
                (("error", model, "--pose", "0,0,0", "--samples", "9", "--distribution", "norml"), 2, "did you mean 'normal'?"),
                (("error", model, "--pose", "0,0,0", "--samples", "9", "--distribution", "gamma"), 2, "one of uniform, rim"),
                (("error", model, "--pose", "0,0,0", "--samples", "9", "--distribution", "normal:0"), 2, "greater than 0"),
                (("error", model, "--pose", "0,0,0", "--samples", "9", "--distribution", "normal:"), 2, "[bad-value]"),
                (("error", model, "--pose", "0,0,0", "--samples", "9", "--distribution", "normal:1 mm"), 2, "[bad-value]"),
                (("error", model, "--pose", "0,0,0", "--samples", "9", "--distribution", "rim:1"), 2, "'rim' takes no number"),
                (("error", model, "--pose", "0,0,0", "--distribution", "rim"), 2, "--distribution is given without --samples"),
                (("error", model, "--pose", "0,0,0", "--seed", "1"), 2, "--seed is given without --samples"),
                (("ik", model, "--distribution", "rim"), 2, "--distribution is for error, not for ik"),
                (("error", model, "--pose", "0,0,0", "--svg", "m.svg"), 2, "--svg draws a map"),
                (("inverse-dynamics", model, "--pose", "0,0,0", "--preload", "1"), 2, "no driver is redundant"),
                (("inverse-dynamics", mechanism("4-rrr"), "--pose", "0,0,0", "--preload", "1 N"), 2, "expected torque"),
                (("inverse-dynamics", mechanism("3-rpr"), "--pose", "0,0,0.1", "--preload", "1 N*m"), 2, "expected force"),
                (("error", model, "--pos", "0,0,0"), 2, "did you mean '--pose'?"),
                (("ik", mechanism("five-bar"), "--pose", "0,0.2,0"), 2, "leaves its frame 2 freedoms"),
                (("error", "missing.yaml"), 3, "missing.yaml")):
            with self.subTest(words=words):
                self.assertIn(text, self.message(*words, code=code))

    def test_files_that_are_no_tables_or_maps_are_kept(self):
        command = ("error", mechanism("3-rrr"), "--grid", "x=0:1cm:2", "--grid", "y=0:1cm:2")
        for option, name, what in (("--out", "t.csv", "table"), ("--svg", "t.csv", "picture"), ("--out", "t.csv.provenance.json", "record of a table")):
            for other in ("t.csv", "t.csv.provenance.json"):
                if os.path.exists(self.path(other)):
                    os.remove(self.path(other))
            self.write(name, "time,a\n0,1\n")
            err = self.message(*command, option, "t.csv", code=6)
            self.assertIn("cannot write '%s': it is there already, and no %s of this program [cannot-write]" % (name, what), err)
            self.assertIn("--force", err)
            self.assertEqual(["time,a\n0,1\n"], [self.read(other) for other in ("t.csv", "t.csv.provenance.json") if os.path.exists(self.path(other))])
            for force in (("--force",), ()):  # then it is its own
                self.rows(*command, option, "t.csv", *force)
            self.assertNotEqual("time,a\n0,1\n", self.read(name))

    def test_table_and_map_are_two_files(self):
        command = ("workspace", mechanism("3-rrr"), "--grid", "x=0:1cm:2", "--grid", "y=0:1cm:2")
        self.assertIn("--out and --svg name the same file 't'", self.message(*command, "--out", "t", "--svg", "t", code=2))
        self.assertFalse(os.path.exists(self.path("t")))

    def test_mistakes_of_the_section_have_a_place(self):
        text = self.text("five-bar")
        for piece, message in (("{frame: coupler1/D", "has no frame 'D'"), ("{joints: [A3]", "unknown joint 'A3'"),
                               ("{joints: [A1, A1]", "named as an input twice"), ("{elbow: [1, 1, 1]", "3 values"),
                               ("{frame: ground/A1", "is on ground"), ("{error: {input: 1 kg}", "must be of angle"),
                               ("{error: {input: 10 um}", "is a length, but the input 'A1' turns"),
                               ("{error: {input: -1e-5}", "must be >= 0")):
            model = self.write("m.yaml", text[:text.index("analysis:")] + "analysis: %s}\n" % piece)
            err = self.message("error", model, "--pose", "0.05,0.25", code=3)
            self.assertIn(message, err)
            self.assertRegex(err, r"(?m)^m\.yaml:\d+:\d+: error")


if __name__ == "__main__":
    unittest.main()
