"""Drivers on joints with play: they hold or push the coordinate and leave the play alone."""
import csv
import json
import math
import unittest

from model_cases import EXACT, ModelTest
from program import mechanism

FINE = "integrator: verner7, step: {size: 0.1 ms, adaptive: true, tolerance: 1e-11}"
PIN = """
gravity: [0, -9.81]
bodies: {rotor: {mass: 2, inertia: 0.01}}
joints: {B: {type: revolute, between: [ground, rotor], clearance: {bearing_radius: 10 mm, radial_clearance: 0.2 mm%s,
         contact: {law: hertz, K: 1e9}%s}}}
drivers: {motor: {joint: B, %s}}
simulation: {end: 20 ms, %s, output: {interval: 0.1 ms}}
"""
SLIDE = """
gravity: [0, -9.81]
bodies: {block: {mass: 2, inertia: 0.01}}
joints: {G: {type: prismatic, between: [%s, block], clearance: {width: 40 mm, length: 100 mm, gap: 1 mm,
         contact: {law: hertz, K: 1e9}%s}}}
frames: {ground/wall: {angle: 20 deg}}
drivers: {motor: {joint: G, %s}}
simulation: {end: 10 ms, %s, output: {interval: 0.1 ms}}
"""
ARM = """
gravity: [0, -9.81]
presets: {bearing: {bearing_radius: 10 mm, radial_clearance: 0.1 mm, contact: {law: flores, K: 1e9, restitution: 0.5}}}
bodies:
  upper: {mass: 1 kg, inertia: 5e-3, com: [100 mm, 0], frames: {elbow: [200 mm, 0]}}
  lower: {mass: 0.5 kg, inertia: 2e-3, com: [75 mm, 0], frames: {hand: [150 mm, 0]}}
joints:
  shoulder: {type: revolute, between: [ground, upper], clearance: {use: bearing, initial: loaded}}
  elbow: {type: revolute, between: [upper/elbow, lower], clearance: {use: bearing, initial: loaded}}
drivers:
  hand: {inverse_kinematics: {frame: lower/hand, path: {x: 0.2 + 0.05*cos(20*t), y: 0.1 + 0.05*sin(20*t)}, joints: [shoulder, elbow], elbow: 1}}
simulation: {end: 50 ms, accuracy: 1 nm, output: {interval: 0.5 ms}}
"""


class Pin(ModelTest):
    def test_a_driven_angle_is_kept_while_the_journal_floats(self):
        columns = self.run_model(PIN % ("", "", "kind: angle, value: 0.5*sin(20*t)", EXACT))
        self.assert_column(columns, "joint.B.angle", lambda t: 0.5 * math.sin(20 * t), 1e-12)
        fallen = {name: values[:60] for name, values in columns.items()}
        self.assert_column(fallen, "joint.B.ey", lambda t: -9.81 / 2 * t * t, 1e-12)
        self.assert_column(fallen, "driver.motor.torque", lambda t: -0.01 * 0.5 * 400 * math.sin(20 * t), 1e-9)
        self.assertGreater(max(columns["joint.B.fn"]), 1.0)
        self.assertLess(json.loads(self.read("out", "summary.json"))["residuals"]["energy_max"], 1e-9)

    def test_a_driven_speed_is_kept(self):
        columns = self.run_model(PIN % ("", "", "kind: velocity, value: 3 rad/s", EXACT))
        self.assert_column(columns, "joint.B.angle", lambda t: 3.0 * t, 1e-12)

    def test_a_torque_turns_the_journal_against_its_friction(self):
        friction = ", friction: {law: coulomb-tanh, mu: 0.2, vs: 1 mm/s}"
        columns = self.run_model(PIN % (", initial: loaded", friction, "kind: torque, value: 0.5 N*m", FINE))
        # Sliding friction at the radius of the journal; the journal climbs its bearing only slowly.
        braking = 0.2 * 2 * 9.81 * 9.8e-3
        self.assertAlmostEqual((0.5 - braking) / 0.01 * 1e-3, columns["joint.B.speed"][10], delta=0.05)
        self.assert_column(columns, "driver.motor.torque", lambda t: 0.5, 1e-12)

    def test_a_torque_acts_on_both_bodies(self):
        text = (PIN % ("", "", "kind: torque, value: 0.1 N*m", EXACT)).replace("gravity: [0, -9.81]", "").replace(
            "{rotor:", "{case: {mass: 1, inertia: 0.02}, rotor:").replace("[ground, rotor]", "[case, rotor]")
        columns = self.run_model(text)
        self.assert_column(columns, "body.rotor.omega", lambda t: 10.0 * t, 1e-9)
        self.assert_column(columns, "body.case.omega", lambda t: -5.0 * t, 1e-9)
        self.assert_column(columns, "joint.B.ex", lambda t: 0.0, 1e-12)

    def test_a_pin_in_space_is_driven_too(self):
        text = (PIN % (", length: 20 mm", "", "kind: angle, value: 2*t", EXACT)).replace("gravity: [0, -9.81]", "gravity: [0, 0, 0]").replace(
            "inertia: 0.01", "inertia: [0.01, 0.01, 0.01]")
        self.model(text, head="freeplay: 1\nspace: spatial\n")
        self.freeplay("run", "m.yaml", "--out", "out", "--quiet")
        rows = list(csv.DictReader(self.read("out", "results.csv").splitlines()))
        for row in rows:
            self.assertLess(abs(float(row["joint.B.angle"]) - 2 * float(row["time"])), 1e-10)

    def test_inverse_kinematics_drives_an_arm_of_loose_pins(self):
        self.model(ARM)
        runs = {}
        for name, options in (("loose", ()), ("ideal", ("--ideal", "all"))):
            self.freeplay("run", "m.yaml", "--out", name, "--quiet", *options)
            runs[name] = list(csv.DictReader(self.read(name, "results.csv").splitlines()))
        off = 0.0
        for loose, ideal in zip(runs["loose"], runs["ideal"], strict=True):
            for joint in "shoulder", "elbow":
                self.assertLess(abs(float(loose["joint.%s.angle" % joint]) - float(ideal["joint.%s.angle" % joint])), 1e-9)
            off = max(off, abs(float(loose["body.lower.y"]) - float(ideal["body.lower.y"])))
        # Both pins rest at their bearings: the hand hangs two clearances too low, and no farther.
        self.assertGreater(off, 1.5e-4)
        self.assertLess(off, 3e-4)


class Slide(ModelTest):
    def test_a_driven_way_is_kept_while_the_block_falls(self):
        for frame in ("ground", "ground/wall"):
            columns = self.run_model(SLIDE % (frame, "", "kind: position, value: 0.01*sin(100*t)", EXACT))
            self.assert_column(columns, "joint.G.position", lambda t: 0.01 * math.sin(100 * t), 1e-12)
            fall = math.cos(math.radians(20.0)) if frame != "ground" else 1.0
            self.assert_column(columns, "joint.G.shift", lambda t: -9.81 / 2 * fall * t * t, 1e-11)
            self.assert_column(columns, "joint.G.tilt", lambda t: 0.0, 1e-12)

    def test_a_driven_speed_is_kept(self):
        columns = self.run_model(SLIDE % ("ground", "", "kind: velocity, value: 1 m/s", EXACT))
        self.assert_column(columns, "joint.G.position", lambda t: t, 1e-12)

    def test_a_force_pushes_it(self):
        columns = self.run_model(SLIDE % ("ground", "", "kind: force, value: 4 N", EXACT))
        self.assert_column(columns, "joint.G.position", lambda t: t * t, 1e-12)

    def test_the_driven_slider_crank_goes_round(self):
        with open(mechanism("slider-in-guide"), encoding="utf-8") as file:
            text = file.read()
        text = text.replace("initial: {joints: {main: 0 deg}, speeds: {main: 150 rad/s}}",
                            "drivers: {push: {joint: guide, kind: position, value: 0.4 + 0.02*sin(100*t)}}").replace("end: 20 ms", "end: 5 ms")
        self.model(text, head="")
        self.freeplay("run", "m.yaml", "--out", "out", "--quiet")
        for row in csv.DictReader(self.read("out", "results.csv").splitlines()):
            self.assertLess(abs(float(row["joint.guide.position"]) - 0.4 - 0.02 * math.sin(100 * float(row["time"]))), 1e-10)


if __name__ == "__main__":
    unittest.main()
