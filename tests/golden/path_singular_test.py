"""Paths of inverse kinematics that touch, cross or come close to singular places: the numbers of the smooth motion, or a word."""
import json
import math
import re
import unittest

from model_cases import ModelTest
from path_reach_test import legs

ARM = """freeplay: 1
gravity: [0, -9.81]
bodies:
  a1: {mass: 3 kg, inertia: 0.03, com: [0.15, 0], frames: {t: [0.3, 0]}, pose: {angle: 60 deg}}
  a2: {mass: 2 kg, inertia: 0.015, com: [0.125, 0], frames: {t: [0.25, 0]}, pose: {angle: -30 deg}}
joints:
  q1: {type: revolute, between: [ground, a1]}
  q2: {type: revolute, between: [a1/t, a2]}
drivers: {path: {inverse_kinematics: {frame: a2/t, path: {%s}, joints: [%s]}}}
simulation: {end: %s, accuracy: 1 um}
"""
IN_SPACE = """freeplay: 1
space: spatial
gravity: [0, 0, -9.81]
bodies:
  a1: {mass: 3 kg, inertia: [0.001, 0.03, 0.03], com: [0.15, 0, 0], frames: {t: [0.3, 0, 0]}, pose: {rpy: [0, -60 deg, 0]}}
  a2: {mass: 2 kg, inertia: [0.001, 0.015, 0.015], com: [0.125, 0, 0], frames: {t: [0.25, 0, 0]}, pose: {rpy: [0, 30 deg, 0]}}
joints:
  q1: {type: revolute, between: [ground, a1], axis: [0, 1, 0]}
  q2: {type: revolute, between: [a1/t, a2], axis: [0, 1, 0]}
drivers: {path: {inverse_kinematics: {frame: a2/t, path: {x: "0.35 + 0.2*sin(pi*t)", z: 0}, joints: [q1, q2]}}}
simulation: {end: 2 s, accuracy: 1 um}
"""
OVERHEAD = """freeplay: 1
space: spatial
gravity: [0, 0, -9.81]
bodies:
  base: {mass: 3, inertia: [0.02, 0.02, 0.01], frames: {sh: [0, 0, 0.2]}}
  arm: {mass: 1.2, inertia: [1e-3, 0.02, 0.02], com: [0.15, 0, 0], frames: {el: [0.3, 0, 0]}, pose: {position: [0, 0, 0.2], rpy: [0, -90 deg, 0]}}
  fore: {mass: 0.7, inertia: [4e-4, 6e-3, 6e-3], com: [0.125, 0, 0], frames: {hand: [0.25, 0, 0]}, pose: {position: [0, 0, 0.5], rpy: [0, 40 deg, 0]}}
joints:
  yaw: {type: revolute, between: [ground, base]}
  sh: {type: revolute, between: [base/sh, arm], axis: [0, 1, 0]}
  el: {type: revolute, between: [arm/el, fore], axis: [0, 1, 0]}
drivers:
  p: {inverse_kinematics: {frame: fore/hand, path: {x: "0.2 - 0.4*smooth(t, 0, 1)", y: %s, z: 0.45}, joints: [yaw, sh, el]}}
simulation: {end: 1 s, accuracy: 1 um}
"""
SLIDER = """freeplay: 1
gravity: [0, -9.81]
bodies:
  crank: {mass: 0.8, inertia: 8e-4, frames: {pin: [45 mm, 0]}}
  rod: {mass: 0.5, inertia: 1.2e-3, com: [60 mm, 0], frames: {s: [140 mm, 0]}, pose: {position: [0, 45 mm], angle: -18 deg}}
  piston: {mass: 0.6, inertia: 4e-4}
joints:
  main: {type: revolute, between: [ground, crank]}
  big: {type: revolute, between: [crank/pin, rod]}
  small: {type: revolute, between: [rod/s, piston]}
  bore: {type: prismatic, between: [ground, piston]}
drivers: {p: {inverse_kinematics: {frame: piston, path: {x: "0.14 + 0.045*sin(2*pi*t)"}, joints: [main]}}}
simulation: {end: 1 s, accuracy: 1 um}
"""
EDGE = "x: \"0.35 + %.10g*sin(pi*t)\", y: 0"


class PathSingular(ModelTest):
    def simulate(self, text, *words, code=0):
        self.write("m.yaml", text)
        self.said = "\n".join(self.freeplay("run", "m.yaml", "--force", "--out", "r", *words, code=code))
        self.summary = json.loads(self.read("r", "summary.json"))
        self.trust = self.summary["trust"]

    def rows(self):
        lines = [line for line in self.read("r", "results.csv").splitlines() if not line.startswith("#")]
        names = lines[0].split(",")
        return [dict(zip(names, map(float, line.split(",")))) for line in lines[1:]]

    def reasons(self, word):
        return [reason for reason in self.trust["reasons"] if reason["id"] == word]

    def assert_smooth(self, columns):
        """Each row lies on the cubic through its neighbours, which noise of a singular place does not."""
        rows = self.rows()
        for name in columns:
            values = [row[name] for row in rows]
            scale = max(1e-3, *map(abs, values))
            for i in range(2, len(values) - 2):
                cubic = (4.0 * (values[i - 1] + values[i + 1]) - values[i - 2] - values[i + 2]) / 6.0
                self.assertLess(abs(values[i] - cubic), 1e-5 * scale, (name, rows[i]))

    def test_an_arm_that_its_path_stretches_at_an_instant_goes_on_smoothly(self):
        for text in (ARM % (EDGE % 0.2, "q1, q2", "2 s"), IN_SPACE):
            for words in ([], ["--step", "1ms"], ["--interval", "3ms"]):
                self.simulate(text, *words)
                self.assertEqual([], self.reasons("singular-position"), words)
                self.assertEqual("good", self.trust["verdict"], (words, self.trust))
                self.assertAlmostEqual(51.14, self.summary["joints"]["q1"]["max_force"], delta=0.02)
                self.assertAlmostEqual(12.76, self.summary["drivers"]["q1"]["max_abs"], delta=0.02)
            # L is the reach: 2 L g = l1 l2 q2^2 beside it, with the gap g = 0.2 (pi tau)^2/2.
            speed = math.sqrt(2 * 0.55 * 0.2 * math.pi ** 2 / 2 / (0.3 * 0.25))
            self.simulate(text)
            there = min(self.rows(), key=lambda row: abs(row["time"] - 0.5))
            self.assertAlmostEqual(1.0, abs(there["joint.q2.speed"]) / speed, delta=1e-8)
            self.assert_smooth([name for name in there if re.match(r"driver\.q\d\.(torque|value)|joint\.q\d\.(speed|f)", name)])

    def test_other_paths_through_singular_places_that_are_smooth(self):
        for text in (ARM % ("x: \"0.35 + 0.2*sin(pi*t)^2\", y: 0", "q1, q2", "2 s"),
                     ARM % ("x: \"0.25 + 0.2*cos(pi*t)\", y: 0", "q1, q2", "1 s"), OVERHEAD % "0", SLIDER):
            self.simulate(text)
            self.assertEqual([], self.reasons("singular-position"), self.said)
            self.assertLess(max(joint["max_force"] for joint in self.summary["joints"].values()), 1000.0)
            self.assertLess(max(path["max_position"] for path in self.summary["paths"].values()), 1e-9)

    def test_a_path_close_to_the_edge_is_resolved_and_what_is_too_close_is_said(self):
        for gap, near in ((1e-3, False), (1e-4, False), (1e-5, True), (1e-7, True)):
            self.simulate(ARM % (EDGE % (0.2 - gap), "q1, q2", "2 s"))
            found = self.summary["joints"]["q1"]["max_force"]
            self.assertEqual(near, bool(self.reasons("singular-position")), (gap, self.said))
            if near:
                reason = self.reasons("singular-position")[0]
                self.assertAlmostEqual(gap, reason["value"], delta=0.02 * gap)
                self.assertIn("'q2'", reason["message"])
                continue
            self.simulate(ARM % (EDGE % (0.2 - gap), "q1, q2", "2 s"), "--step", "10us")
            self.assertAlmostEqual(1.0, found / self.summary["joints"]["q1"]["max_force"], delta=2e-3)

    def test_a_path_that_leaves_the_reach_names_the_joint(self):
        self.simulate(ARM % ("x: \"0.35 + 0.3*t\", y: 0", "q1, q2", "1 s"), code=4)
        self.assertRegex(self.said, r"a singular place, \S+ m from the edge of what is reached, at joint 'q2' \(at \S+ deg\)")

    def test_a_leg_that_is_touched_by_its_edge(self):
        half = 0.29 * math.sin(math.pi / 3)
        x = math.sqrt(half ** 2 + 0.48 ** 2 - 0.29 ** 2) - half
        self.simulate(legs("{x: %.17g - 0.9*(t - 0.2503)^2, y: 0, angle: 0}" % (x - 1e-14)), "--step", "1e-3")
        reason = self.reasons("singular-position")[0]
        self.assertEqual("bad", reason["level"])
        self.assertAlmostEqual(0.2503, float(re.search(r"t = (\S+) s", reason["message"])[1]), delta=1e-6)

    def test_a_frame_that_its_joints_do_not_hold_on_the_path(self):
        circle = "x: \"0.35 + 0.05*cos(2*pi*t)\", y: \"0.1 + 0.05*sin(2*pi*t)\""
        self.simulate(ARM % (circle, "q1", "1 s"))
        self.assertEqual("doubtful", self.reasons("path-missed")[0]["level"])
        self.assertAlmostEqual(0.424, self.reasons("path-missed")[0]["value"], delta=1e-3)
        self.simulate(ARM % (circle, "q1, q2", "1 s"))
        self.assertEqual("good", self.trust["verdict"])


if __name__ == "__main__":
    unittest.main()
