"""Robots of other people, from the folder that FREEPLAY_CASES names: they run, keep their motion when they are converted,
and accelerate as the recursive Newton-Euler method says.

    FREEPLAY_CASES=FOLDER python3 tests/cases/urdf_robots_test.py        as tests
    FREEPLAY_CASES=FOLDER python3 tests/cases/urdf_robots_test.py table  the table of docs/urdf.md
"""
import json
import os
import re
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "golden"))
from program import ProgramTest  # noqa: E402
from robot_cases import RobotTest  # noqa: E402

FOLDER = os.path.join(os.environ["FREEPLAY_CASES"], "urdf")
END = "0.5 s"

# What a side-car has to say so that a file that leaves it open runs.
SAID = {"four-bar-two-parents-a": "loops: two-parents"}
LIMIT = '<limit lower="-3" upper="3" effort="1" velocity="1"/>'
JOINTS = re.compile(r'<joint\b[^>]*type="(?:revolute|prismatic)".*?</joint>', re.S)


def with_limits(text):
    text = re.sub(r"<!--.*?-->", "", text, flags=re.S)
    return JOINTS.sub(lambda m: m[0] if "<limit" in m[0] else m[0].replace("</joint>", LIMIT + "</joint>"), text)


# Files that are refused because they leave out what URDF requires: with that written in, they run.
MENDED = {"seven-axis-arm": with_limits, "biped-cassie": with_limits,
          "slider": lambda text: re.sub(r"<limit\b[^>]*>", LIMIT, text),
          "acrobot": lambda text: re.sub(r"(<robot\b[^>]*>)", r'\1<link name="world"/>', text, count=1),
          "four-bar-loop-joint": lambda text: with_limits(re.sub(r"<limit\b[^>]*/>", LIMIT, text.replace(
              "<material>", '<material name="m">')))}
# Open chains, or so without their mimic elements, in which every body has an inertia.
CHAINS = ["arm-panda", "cart-pole", "cart-pole-gtd", "desk-arm-gazebo", "double-pendulum", "five-link-pendulum",
          "joint-parameters", "planar-biped", "quadruped-solo12", "test-robot", "three-links", "two-links",
          "ur5"]
FLOATING = ["cart-pole-gtd", "double-pendulum", "quadruped-solo12", "planar-biped"]


def cases():
    with open(os.path.join(FOLDER, "manifest.json"), encoding="utf-8") as file:
        return [(case["file"][:-len(".urdf")], case) for case in json.load(file)["cases"]]


def text_of(name):
    with open(os.path.join(FOLDER, name + ".urdf"), encoding="utf-8") as file:
        return file.read()


class Cases(ProgramTest):
    def model(self, name, mended=False):
        """The file itself, a copy with what it lacks, or a side-car that says what it leaves open."""
        path = os.path.join(FOLDER, name + ".urdf")
        if mended:
            return self.write(name + ".urdf", MENDED[name](text_of(name)))
        if name not in SAID:
            return path
        return self.write("model.yaml", "freeplay: 1\nurdf: {file: %s, %s}\nspace: spatial\ngravity: [0, 0, -9.81]\n"
                          % (path, SAID[name]))

    def outcome(self, name, expectation="accept", mended=False):
        """Space, bodies, joints, degrees of freedom and what became of the run; or why there was none."""
        model = self.model(name, mended)
        code = 3 if expectation == "refuse" and name not in SAID else 0
        verdict = json.loads(self.freeplay("validate", model, "--json", code=code)[0])
        if code:
            errors = [m for m in verdict["messages"] if m["severity"] == "error"]
            return None, "%s: %s" % (errors[0]["id"], errors[0]["message"])
        facts = verdict["facts"]
        self.freeplay("run", model, "--end", END, "--out", "out", "--quiet")
        summary = json.loads(self.read("out", "summary.json"))
        self.assertEqual("completed", summary["status"], name)
        return facts, "ran %s" % END


class Robots(Cases):
    def test_every_file_runs_or_is_refused_with_a_place(self):
        ran = 0
        for name, case in cases():
            with self.subTest(name=name):
                facts, _ = self.outcome(name, case["expectation"])
                ran += facts is not None
        self.assertGreaterEqual(ran, 29)

    def test_files_that_lack_what_urdf_requires_run_with_it(self):
        for name in MENDED:
            with self.subTest(name=name):
                self.outcome(name, mended=True)

    def test_a_converted_robot_moves_as_before_to_the_last_byte(self):
        for name, case in cases():
            if case["expectation"] == "refuse":
                continue
            with self.subTest(name=name):
                model = self.model(name)
                self.freeplay("convert", model, "robot.yaml", "--force", "--quiet")
                rows = []
                for file in (model, "robot.yaml"):
                    self.freeplay("run", file, "--end", "0.05 s", "--out", "out", "--quiet")
                    rows.append(self.read("out", "results.csv").split("\n", 1)[1])  # names may have got a '_'
                self.assertEqual(*rows)


class Dynamics(RobotTest):
    def without_mimic(self, name):
        text = re.sub(r"<mimic\b[^>]*/>|<mimic\b.*?</mimic>", "", text_of(name), flags=re.S)
        return self.write(name + ".urdf", text), text

    def test_open_chains_accelerate_as_newton_and_euler_say(self):
        self.assertGreaterEqual(len(CHAINS), 10)
        for seed, name in enumerate(CHAINS):
            with self.subTest(name=name):
                self.assertGreater(self.assert_accelerates(*self.without_mimic(name), seed), 0)

    def test_chains_with_a_floating_root_accelerate_as_newton_and_euler_say(self):
        for seed, name in enumerate(FLOATING):
            with self.subTest(name=name):
                self.assertGreater(self.assert_accelerates(*self.without_mimic(name), seed, floats=True), 0)


def table():
    class Table(Cases):
        """Prints, for docs/urdf.md, what becomes of every file."""

        def runTest(self):
            print("| file | space | bodies | joints | degrees of freedom | outcome |\n|---|---|---|---|---|---|")
            for name, case in cases():
                self.row(name, *self.outcome(name, case["expectation"]))
                if name in MENDED:
                    facts, outcome = self.outcome(name, mended=True)
                    self.row(name, facts, outcome + " with that written in")

        @staticmethod
        def row(name, facts, outcome):
            words = [facts[k] for k in ("space", "bodies", "joints", "dof")] if facts else ["", "", "", ""]
            print("| %s | %s | %s |" % (name, " | ".join(map(str, words)), outcome))

    return unittest.TextTestRunner(stream=sys.stderr).run(Table()).wasSuccessful()


if __name__ == "__main__":
    if sys.argv[1:] == ["table"]:
        sys.exit(not table())
    unittest.main()
