"""Paths that leave what the mechanism reaches: the run says at which instant and where, whatever its steps are."""
import math
import os
import re
import unittest

from model_cases import ModelTest
from program import MECHANISMS

STEPS = (["--step", "1e-3"], ["--accuracy", "1 um"], ["--accuracy", "1e-7"])

FIVE_BAR = """freeplay: 1
bodies:
  ground: {frames: {A1: [-0.1, 0], A2: [0.1, 0]}}
  crank1: {mass: 0.2, inertia: 4e-4, frames: {B: [0.15, 0]}, pose: {angle: 1.8}}
  coupler1: {mass: 0.25, inertia: 9e-4, frames: {C: [0.2, 0]}, pose: {angle: 0.6}}
  crank2: {mass: 0.2, inertia: 4e-4, frames: {B: [0.15, 0]}, pose: {angle: 1.2}}
  coupler2: {mass: 0.25, inertia: 9e-4, frames: {C: [0.2, 0]}, pose: {angle: 2.4}}
joints:
  A1: {type: revolute, between: [ground/A1, crank1]}
  B1: {type: revolute, between: [crank1/B, coupler1]}
  A2: {type: revolute, between: [ground/A2, crank2]}
  B2: {type: revolute, between: [crank2/B, coupler2]}
  C: {type: revolute, between: [coupler1/C, coupler2/C]}
drivers:
  path: {inverse_kinematics: {frame: coupler1/C, path: %s, joints: [A1, A2]}}
simulation: {end: 0.5, output: {interval: 10 ms}}
"""


def shipped(name):
    with open(os.path.join(MECHANISMS, name + ".yaml"), encoding="utf-8") as file:
        return file.read()


def legs(path):
    text = re.sub(r", clearance: \{use: bearing\}", "", shipped("3-rrr")).replace("bearing: ", "between: [")
    text = re.sub(r"between: \[(\S+), journal: (\S+)\}", r"between: [\1, \2]}", text)
    return re.sub(r"(?m)^      path: \{x.*$", lambda _: "      path: " + path, text)


def delta(path):
    text = re.sub(r"(?ms)^    drivers:\n.*?(?=^\w)", "", shipped("spatial/delta"))
    text = re.sub(r"(?m)^simulation:.*\n", "simulation: {end: 0.5, output: {interval: 10 ms}}\n", text)
    return text + "drivers: {path: {inverse_kinematics: {frame: platform, path: %s, joints: leg*.shoulder}}}\n" % path


class PathReach(ModelTest):
    """Each path moves evenly along one axis until a leg is stretched, at a place that is known in closed form."""

    def write_poses(self, names, rows):
        self.write("poses.csv", "\n".join([",".join(["time"] + names)] + [",".join("%.17g" % x for x in row) for row in rows]) + "\n")

    def assert_lost(self, text, axis, lost, start, rate):
        self.write("m.yaml", text)
        for steps in STEPS:
            err = self.freeplay("run", "m.yaml", "--out", "out", "--quiet", "--force", *steps, code=4)[1]
            with self.subTest(steps=steps):
                found = re.search(r"t = (\S+) s: driver '\w+': .* the path at t = (\S+) s, where .*\b%s = (\S+) m.* \[ik-unreachable\]" % axis, err)
                self.assertTrue(found, err)
                self.assertEqual(found[1], found[2])
                self.assertAlmostEqual(lost, float(found[1]), delta=2e-9)
                self.assertAlmostEqual(start + rate * lost, float(found[3]), delta=2e-9)

    def test_of_legs_in_the_plane(self):
        # The pins of the leg at 210 degrees are 0.48 m apart: x^2 + 2 x 0.29 sin(60 deg) + 0.29^2 = 0.48^2.
        half = 0.29 * math.sin(math.pi / 3)
        x = math.sqrt(half ** 2 + 0.48 ** 2 - 0.29 ** 2) - half
        self.assert_lost(legs("{x: 0.9*t, y: 0, angle: 0}"), "x", x / 0.9, 0, 0.9)
        self.write_poses(["x", "y", "angle"], [(0.05 * i, 0.045 * i, 0, 0) for i in range(11)])
        self.assert_lost(legs("poses.csv"), "x", x / 0.9, 0, 0.9)

    def test_of_a_whole_mechanism_in_the_plane(self):
        y = math.sqrt(0.35 ** 2 - 0.1 ** 2)
        self.assert_lost(FIVE_BAR % "{x: 0, y: 0.26 + 0.4*t}", "y", (y - 0.26) / 0.4, 0.26, 0.4)
        self.write_poses(["x", "y"], [(0.05 * i, 0, 0.26 + 0.02 * i) for i in range(11)])
        self.assert_lost(FIVE_BAR % "poses.csv", "y", (y - 0.26) / 0.4, 0.26, 0.4)

    def test_in_space(self):
        # Arms and rods are in line.
        z = -math.sqrt(0.8 ** 2 - 0.15 ** 2)
        self.assert_lost(delta("{x: 0, y: 0, z: -0.5 - 1.2*t}"), "z", (-0.5 - z) / 1.2, -0.5, -1.2)
        self.write_poses(["x", "y", "z"], [(0.05 * i, 0, 0, -0.5 - 0.05 * i) for i in range(11)])
        self.assert_lost(delta("poses.csv"), "z", -0.5 - z, -0.5, -1.0)


if __name__ == "__main__":
    unittest.main()
