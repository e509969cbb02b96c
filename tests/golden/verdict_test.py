"""Verdicts on forces that torques make, springs that drive, hills inside of steps, and second runs that end early."""
import json
import math
import os
import re
import unittest

from program import ROOT, ProgramTest

# An arm on a torsion spring of 2000 N m/rad that is slack at 30 degrees.
TORSION = """freeplay: 1
bodies: {a: {mass: 1, inertia: 0.01, com: [0.1, 0], frames: {tip: [0.2, 0]}}}
joints: {A: {type: revolute, between: [ground, a]}}
initial: {joints: {A: %.17g deg}}
forces: {s: {type: spring-damper, kind: rotational, between: [ground, a], stiffness: 2000, free_angle: 30 deg}}
simulation: {end: 0.2 s, accuracy: 1 um}
"""
# Too stiff for an explicit method.
STIFF = """freeplay: 1
bodies: {m: {mass: 1 kg, inertia: 1 kg*m^2}}
joints: {slide: {type: prismatic, between: [ground, m]}}
forces: {hold: {type: spring-damper, between: [ground, m], stiffness: 1e6, damping: 1e6, free_length: 1 m}}
initial: {joints: {slide: 1.1 m}}
simulation: {end: 2 s, integrator: bathe, accuracy: 1 um}
"""
# A spring or damper that a function of time changes.
CHANGING = """freeplay: 1
bodies: {m: {mass: 1, inertia: 1}}
joints: {p: {type: %s, between: [ground, m]}}
forces: {f: {type: spring-damper, kind: %s, between: [ground, m], %s}}
initial: {joints: {p: 1}}
simulation: {end: 2 s, accuracy: 1 um}
"""
# A bead on a wire with a hill.
HILL = """freeplay: 1
gravity: [0, -9.81]
bodies: {b: {mass: 0.5, inertia: 1e-5, pose: {position: [-0.5, 0]}, velocity: {linear: [0.1, 0], angular: 0}}}
joints: {T: {type: point-on-curve, between: [ground, b], curve: "%s*smooth(x, %d mm, %d mm)*(1 - smooth(x, %d mm, %d mm))"}}
simulation: {end: 10 s, accuracy: 1 um}
"""


class Verdict(ProgramTest):
    def run_model(self, text, *words):
        self.write("model.yaml", text)
        out, _ = self.freeplay("run", "model.yaml", "--force", "--out", "r", *words)
        self.summary = json.loads(self.read("r", "summary.json"))
        self.trust = self.summary["trust"]
        return out

    def ids(self):
        return [reason["id"] for reason in self.trust["reasons"]]

    def test_forces_that_torsion_springs_and_decays_make_are_those_of_no_singular_position(self):
        for deflection in (1e-3, 1e-6, 0.0):
            self.run_model(TORSION % (30.0 + math.degrees(deflection)))
            # At a deflection q: m r k q/I with the moment of inertia about the pin.
            self.assertAlmostEqual(1e4 * deflection, self.summary["joints"]["A"]["max_force"], delta=1e-2 * (1e4 * deflection + 0.1))
            self.assertEqual("good", self.trust["verdict"], (deflection, self.trust))
        self.run_model("""freeplay: 1
bodies: {a: {mass: 2, inertia: 0.02, com: [0.05, 0]}}
joints: {A: {type: revolute, between: [ground, a]}}
drivers: {m: {joint: A, kind: torque, value: "200 N*m*smooth(t, 0, 0.01)*(1 - smooth(t, 0.02, 0.03))"}}
forces: {d: {type: torque, on: a, value: "-0.2 N*m*s/rad*joint.A.speed"}}
simulation: {end: 3 s, accuracy: 10 um, output: {discard: 2 s}}
""")
        self.assertNotIn("largest-force", self.ids(), self.trust)

    def test_a_stiffness_or_a_damping_that_becomes_negative_is_doubtful(self):
        for kind, joint in (("linear", "prismatic"), ("rotational", "revolute")):
            for keys, found in (("stiffness: 10, damping: '2*cos(3*t)'", "The damping is negative"),
                                ("stiffness: '10*cos(3*t)'", "The stiffness is negative"),
                                ("stiffness: '10*(2 + cos(3*t))', damping: '2*cos(t)^2'", None)):
                with self.subTest(kind=kind, keys=keys):
                    self.run_model(CHANGING % (joint, kind, keys))
                    if found is None:
                        self.assertEqual("good", self.trust["verdict"], self.trust)
                    else:
                        self.assertEqual(["law-range"], self.ids(), self.trust)
                        self.assertIn(found, self.trust["reasons"][0]["message"])

    def test_a_torsion_spring_that_starts_wound_by_a_turn_is_doubtful(self):
        keys = "stiffness: 2000, free_angle: 30 deg"
        for start, free, found in ((-10, 350, -10), (390, 30, 390), (20, -300, 60), (10, -280, None), (0, 720, None), (-10, -10, None)):
            with self.subTest(start=start, free=free):
                self.run_model((TORSION % start).replace(keys, "stiffness: 20, free_angle: %d deg" % free))
                if found is None:
                    self.assertEqual("good", self.trust["verdict"], self.trust)
                    continue
                self.assertEqual(["doubtful-input"], self.ids(), self.trust)
                torque = 20 * math.radians(found - free)
                self.assertIn("'s' starts wound by %d deg, from its free angle of %d deg to %d deg, where it starts: write 'free_angle: %d deg' if no turn "
                              "is meant; if one is, write its torque besides, 'preload: %.4g N*m'" % (start - free, free, start, found, torque),
                              self.trust["reasons"][0]["message"])
                wound = self.summary["forces"]["s"]["max_torque"]
                self.run_model((TORSION % start).replace(keys, "stiffness: 20, free_angle: %d deg, preload: %.17g" % (found, torque)))
                self.assertEqual("good", self.trust["verdict"], self.trust)
                self.assertAlmostEqual(wound, self.summary["forces"]["s"]["max_torque"], delta=1e-6 * wound)
        self.run_model((TORSION % -10).replace(keys, "damping: 0.1, free_angle: 350 deg"))
        self.assertEqual("good", self.trust["verdict"], self.trust)
        self.write("model.yaml", (TORSION % -10).replace(keys, "spring: 2 kN*m*x^3, free_angle: 350 deg"))
        messages = json.loads(self.freeplay("validate", "model.yaml", "--json")[0])["messages"]
        self.assertIn(("doubtful-angle", 5, 10), [(m["id"], m["line"], m["column"]) for m in messages])

    def test_a_stiffness_of_steel_in_another_unit_is_the_cause_of_a_journal_that_goes_through_its_bearing(self):
        with open(os.path.join(ROOT, "mechanisms", "slider-crank.yaml"), encoding="utf-8") as file:
            steel = file.read().replace("restitution: 0.9}", "restitution: 0.9, K: %s}")
        self.run_model(steel % "2.1e6 N/mm^1.5")
        self.assertEqual("good", self.trust["verdict"], self.trust)
        for text in (steel, steel.replace("      material: {E: 207 GPa, nu: 0.3}\n", "")):
            self.write("model.yaml", text % "2.1e6")
            _, err = self.freeplay("run", "model.yaml", "--force", "--out", "r", code=4)
            self.assertIn("; likely cause: K of joint 'wrist' is 2.1e+06 N/m^1.5: as of rubber; is it meant in N/mm^1.5", err)
            self.assertEqual("material" in text, "its material makes 1.1e+11 Pa; check the number and its unit, as in '2.1e+06 N/mm^1.5'" in err)

    def test_a_path_whose_points_leap_is_named_as_the_cause(self):
        """From 0.3 s on it goes by 72 mm in 1 ms."""
        with open(os.path.join(ROOT, "mechanisms", "3-rrr.yaml"), encoding="utf-8") as file:
            circle = file.read()
        head, _, tail = circle.partition("path: {x")
        text = head + "path: %s" + tail[tail.index("\n"):]
        self.write("poses.csv", "time,x,y,angle\n" + "".join(
            "%r,%r,%r,0\n" % row for row in ((0, 0.05, 0), (0.1, 0.04, 0.01), (0.2, 0.03, 0.02), (0.3, 0.02, 0.03), (0.301, 0.06, -0.03), (0.6, 0.03, -0.03))))
        self.write("model.yaml", text % "{file: poses.csv, interpolation: linear}")
        _, err = self.freeplay("run", "model.yaml", "--force", "--out", "r", "--accuracy", "1um", code=4)
        cause = re.search(r"; likely cause: driver '(leg\d.A)' on the path of 'circle' jumps at t = 0.3 s: its speed from (\S+) to (\S+) rad/s", err)
        self.assertIsNotNone(cause, err)
        self.assertIn("driver '%s' at t = 0.3 s: the speed that it prescribes jumps from %s to %s rad/s" % cause.groups(), err)
        self.write("model.yaml", text % "poses.csv")
        found = [m for m in json.loads(self.freeplay("validate", "model.yaml", "--json")[0])["messages"] if "cubic" in m["message"]]
        self.assertEqual([("doubtful-value", 57, 13)] * 2, [(m["id"], m["line"], m["column"]) for m in found])
        self.assertRegex(found[0]["message"], r"'drivers.circle.inverse_kinematics.path' comes to \S+ in 'x' at t = \S+ s, but its points lie "
                                              "between 0.02 and 0.06: write 'interpolation: linear', or give more points")

    def test_a_hill_that_is_short_against_a_step_is_met(self):
        # A bead with 0.1 m/s rises by 0.51 mm.
        for height, width, over in (("1 mm", 3, False), ("0.4 mm", 3, True), ("0.4 mm", 200, True), ("1 mm", 200, True)):
            with self.subTest(height=height, width=width):
                self.run_model(HILL % (height, width, 2 * width, 2 * width, 3 * width))
                self.assertEqual("good", self.trust["verdict"], self.trust)
                self.assertEqual(over, self.summary["bodies"]["b"]["x"] > 0.0)
        # The same of arcs.
        for top, over in (("-2 mm", False), ("-2.6 mm", True)):
            with self.subTest(top=top):
                arcs = "curve: {arcs: [[-2, 0], [-4 mm, 3 mm, 3 mm], [0, %s, -3 mm], [4 mm, 3 mm, 3 mm], [2, 0]]}}}\n" % top
                self.run_model(HILL[:HILL.index("curve:")] + arcs + HILL[HILL.index("simulation:"):])
                self.assertEqual("good", self.trust["verdict"], self.trust)
                self.assertEqual(over, self.summary["bodies"]["b"]["x"] > 0.0)

    def test_what_a_second_run_did_not_come_to_is_not_verified(self):
        out = self.run_model(STIFF, "--verify")
        verified = self.summary["verification"]
        self.assertEqual("agree", verified["agreement"])
        self.assertLess(verified["until"], 2.0)
        self.assertIn("until %.6g s, where the second run ended" % verified["until"], out)
        self.assertNotIn("throughout", out)
        self.assertEqual(("doubtful", ["verify"]), (self.trust["verdict"], self.ids()))


if __name__ == "__main__":
    unittest.main()
