"""Mechanisms in space: what bodies and joints do there agrees with formulas, with the plane, and with a program of its
own kind written here."""
import json
import math
import os
import re
import unittest

from model_cases import EXACT, ModelTest, rk4
from program import ROOT

G = 9.81


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def rotation(w, x, y, z):
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def product(matrix, vector):
    return [sum(m * v for m, v in zip(row, vector)) for row in matrix]


def transposed(matrix):
    return [list(column) for column in zip(*matrix)]


class SpatialTest(ModelTest):
    def rows(self, columns, body, *names):
        return list(zip(*(columns["body.%s.%s" % (body, name)] for name in names)))

    def spins(self, columns, body, inertia):
        """Angular momentum about the centre of mass at each row, world axes; `inertia` in body axes."""
        out = []
        for turn, w in zip(self.rows(columns, body, "qw", "qx", "qy", "qz"), self.rows(columns, body, "wx", "wy", "wz")):
            r = rotation(*turn)
            out.append(product(r, product(inertia, product(transposed(r), w))))
        return out


class FreeBody(SpatialTest):
    TENSOR = [[1.0, 0.2, -0.1], [0.2, 2.0, 0.3], [-0.1, 0.3, 2.5]]
    MODEL = """
space: spatial
bodies:
  stone: {mass: 2, inertia: [1.0, 2.0, 2.5, 0.2, -0.1, 0.3], velocity: {linear: [1, 2, 3], angular: [0.1, 6, 0.2]}}
"""

    def test_a_free_asymmetric_body_keeps_energy_and_momentum_over_a_hundred_turns(self):
        columns = self.run_model(self.MODEL + "simulation: {end: 100 s, output: {interval: 1 s}, integrator: dopri5, "
                                 "step: {size: 1 ms, adaptive: true, tolerance: 1e-13}}")
        energy = columns["energy.kinetic"]
        self.assertLess(max(abs(e - energy[0]) for e in energy), 1e-10 * energy[0])
        spins = self.spins(columns, "stone", self.TENSOR)
        size = math.hypot(*spins[0])
        for spin in spins:
            self.assertLess(math.dist(spin, spins[0]), 1e-10 * size)
        for turn in self.rows(columns, "stone", "qw", "qx", "qy", "qz"):
            self.assertLess(abs(math.hypot(*turn) - 1.0), 1e-14)
        self.assert_column(columns, "body.stone.z", lambda t: 3 * t)

    def test_a_body_that_turns_about_its_middle_axis_tips_over_as_eulers_equations_say(self):
        text = """
space: spatial
bodies: {tee: {mass: 1, inertia: [1, 2, 3], velocity: {angular: [0.01, 5, 0.01]}}}
simulation: {end: 6 s, output: {interval: 0.5 s}, %s}
""" % EXACT
        columns = self.run_model(text)
        rates = lambda t, w: [(2 - 3) / 1 * w[1] * w[2], (3 - 1) / 2 * w[2] * w[0], (1 - 2) / 3 * w[0] * w[1]]
        w, t = [0.01, 5.0, 0.01], 0.0
        rows = zip(columns["time"], self.rows(columns, "tee", "qw", "qx", "qy", "qz"),
                   self.rows(columns, "tee", "wx", "wy", "wz"))
        tipped = False
        for time, turn, world in rows:
            if time > t:
                w, t = rk4(rates, w, time - t, 4000), time
            for x, y in zip(w, product(transposed(rotation(*turn)), world)):
                self.assertLess(abs(x - y), 1e-7)
            tipped = tipped or w[1] < -4.9
        self.assertTrue(tipped)


class Tops(SpatialTest):
    MODEL = """
space: spatial
gravity: [0, 0, -9.81]
bodies:
  top: {mass: 0.5, inertia: [6e-4, 6e-4, 2e-4], com: [0, 0, 0.04], pose: {rpy: [0, 30 deg, 0]},
        velocity: {linear: [%r, %r, %r], angular: [%r, %r, %r]}}
joints: {tip: {type: spherical, between: [ground, top]}}
simulation: {end: %s, output: {interval: 20 ms}, %s}
"""
    TILT, SPIN = math.radians(30), 250.0
    ACROSS, ALONG, REACH = 6e-4 + 0.5 * 0.04 ** 2, 2e-4, 0.04

    def steady(self):
        """Rate of steady precession: A W^2 cos + m g l = C s W with the whole spin s about the axis."""
        a, b, c = self.ACROSS * math.cos(self.TILT), -self.ALONG * self.SPIN, 0.5 * G * self.REACH
        return (-b - math.sqrt(b * b - 4 * a * c)) / (2 * a)

    def text(self, end, steps):
        rate, axis = self.steady(), [math.sin(self.TILT), 0.0, math.cos(self.TILT)]
        # W about z, the rest of the spin about the axis.
        own = self.SPIN - rate * axis[2]
        w = [own * axis[0], 0.0, own * axis[2] + rate]
        return self.MODEL % (*[0.0, 0.0, 0.0], *w, end, steps)

    def test_a_heavy_top_precesses_steadily(self):
        columns = self.run_model(self.text("0.5 s", EXACT))
        rate = self.steady()
        sideways = self.REACH * math.sin(self.TILT)
        self.assert_column(columns, "body.top.x", lambda t: sideways * math.cos(rate * t), 1e-8)
        self.assert_column(columns, "body.top.y", lambda t: sideways * math.sin(rate * t), 1e-8)
        self.assert_column(columns, "body.top.z", lambda t: self.REACH * math.cos(self.TILT), 1e-8)

    def test_bathe_has_order_two_on_the_heavy_top(self):
        rate, sideways = self.steady(), self.REACH * math.sin(self.TILT)
        errors = []
        for step in ("0.4 ms", "0.2 ms", "0.1 ms"):
            columns = self.run_model(self.text("0.2 s", "integrator: bathe, step: " + step))
            end = columns["time"][-1]
            errors.append(math.hypot(columns["body.top.x"][-1] - sideways * math.cos(rate * end),
                                     columns["body.top.y"][-1] - sideways * math.sin(rate * end)))
        for coarse, fine in zip(errors, errors[1:]):
            self.assertTrue(1.8 < math.log2(coarse / fine) < 2.3, errors)


def slider_crank(space, clearance, steps):
    """One mechanism in the plane and in space."""
    planar = space == "planar"
    v = lambda x, y: "[%s, %s]" % (x, y) if planar else "[%s, %s, 0]" % (x, y)
    inertia = lambda i: "%s" % i if planar else "[%s, %s, %s]" % (i, i, i)
    return """
space: %s
gravity: %s
bodies:
  crank: {mass: 0.3, inertia: %s, com: %s, frames: {tip: %s}}
  rod: {mass: 0.21, inertia: %s, com: %s, frames: {tip: %s}}
  slider: {mass: 0.14, inertia: %s}
joints:
  A: {type: revolute, between: [ground, crank]}
  B: {type: revolute, between: [crank/tip, rod]}
  C: {type: revolute, between: [rod/tip, slider]%s}
  D: {type: prismatic, between: [ground, slider]}
drivers: {motor: {joint: A, kind: angle, value: 60*t}}
simulation: {end: 20 ms, %s, output: {interval: 0.1 ms}}
""" % (space, v(0, -9.81), inertia(1e-4), v(0.025, 0), v(0.05, 0), inertia(2.5e-5), v(0.06, 0), v(0.12, 0),
       inertia(1e-5), ", clearance: " + clearance if clearance else "", steps)


CLEARANCE = ("{bearing_radius: 10 mm, radial_clearance: 0.2 mm, length: 20 mm, "
             "contact: {law: lankarani-nikravesh, K: 1e9, restitution: 0.9}, friction: {law: coulomb-tanh, mu: 0.05}}")


LUGRE = CLEARANCE.replace("{law: coulomb-tanh, mu: 0.05}",
                          "{law: lugre, mu_s: 0.1, mu_k: 0.05, v_stribeck: 0.01, sigma0: 1e5, sigma1: 10}")


class PlanarInSpace(SpatialTest):
    def assert_same(self, clearance, steps, tolerance, joint="revolute"):
        plane = self.run_model(slider_crank("planar", clearance, steps))
        text = slider_crank("spatial", clearance, steps)
        if joint == "spherical":
            text = text.replace("C: {type: revolute", "C: {type: spherical").replace(" length: 20 mm,", "")
            self.assertIn("spherical", text)
        space = self.run_model(text)
        for name in ("body.slider.x", "body.rod.x", "body.rod.y", "joint.A.angle", "joint.B.angle"):
            for x, y in zip(plane[name], space[name], strict=True):
                self.assertLess(abs(x - y), tolerance, name)
        self.assertLess(max(map(abs, space["body.rod.z"])), 1e-15)

    def test_an_ideal_mechanism_moves_as_in_the_plane(self):
        facts = self.facts(slider_crank("spatial", "", "step: 10 us"), coordinates=21, velocities=18, constraints=20,
                           rank=17, redundant=3, dof=1, dof_driven=0)
        self.assertAlmostEqual(facts["start"]["slider"]["x"], 0.17, delta=1e-15)
        self.assert_same("", "accuracy: 1e-7", 1e-13)
        self.assert_same("", "integrator: bathe, step: 10 us", 1e-13)

    def test_a_mechanism_with_clearance_moves_as_in_the_plane(self):
        # Iterated to rounding: impacts make of what an iteration may leave ten times as much as this.
        self.assert_same(CLEARANCE, "integrator: {type: bathe, newton: {tolerance: 1e-14}}, step: 2 us", 2e-10)
        self.assert_same(CLEARANCE, "accuracy: 1e-10", 1e-9)

    def test_friction_with_memory_acts_as_in_the_plane(self):
        self.assert_same(LUGRE, "accuracy: 1e-10", 1e-9)
        # Fixed steps do not end at contacts: their own error is 9e-8 rad.
        self.assert_same(LUGRE, "integrator: bathe, step: 0.5 us", 1e-8)

    def test_friction_with_memory_at_both_ends_of_a_loaded_journal_costs_no_rejected_steps(self):
        for integrator in ("bathe", "generalized-alpha"):
            self.write("m.yaml", """
freeplay: 1
name: journal
space: spatial
gravity: [0, 0, -9.81]
bodies: {shaft: {mass: 2, inertia: [0.02, 0.02, 0.02], velocity: {angular: [30, 0, 0]}}}
joints:
  ring:
    type: revolute
    between: [ground, shaft]
    axis: [1, 0, 0]
    clearance:
      {bearing_radius: 10 mm, length: 40 mm, radial_clearance: 0.1 mm, initial: loaded,
       contact: {law: kelvin-voigt, K: 1e6, D: 2000},
       friction: {law: lugre, mu_s: 0.15, mu_k: 0.1, v_stribeck: 0.01, sigma0: 1e5, sigma1: 30}}
simulation: {end: 20 ms, step: 10 us, integrator: %s}
""" % integrator)
            self.freeplay("run", "m.yaml", "--out", "r", "--force")
            counts = json.loads(self.read("r", "summary.json"))["counts"]
            self.assertEqual((2000, 0), (counts["steps"], counts["rejected"]), integrator)
            self.assertLess(counts["iterations"], 10 * counts["steps"], integrator)

    def test_a_ball_that_moves_in_a_plane_feels_what_a_pin_does(self):
        for clearance in (CLEARANCE, LUGRE):
            self.assert_same(clearance, "accuracy: 1e-10", 1e-9, "spherical")


def gear_train(space, steps):
    """A wheel off its centre drives a pinion, and that a rack."""
    planar = space == "planar"
    v = lambda x, y: "[%s, %s]" % (x, y) if planar else "[%s, %s, 0]" % (x, y)
    inertia = lambda i: "%s" % i if planar else "[%s, %s, %s]" % (i, i, i)
    return """
space: %s
gravity: %s
bodies:
  wheel: {mass: 1, inertia: %s, com: %s}
  pinion: {mass: 0.3, inertia: %s, pose: {position: %s}}
  rack: {mass: 0.5, inertia: %s, pose: {position: %s}}
joints:
  A: {type: revolute, between: [ground, wheel]}
  B: {type: revolute, between: [ground/far, pinion]}
  C: {type: prismatic, between: [ground/low, rack]}
  mesh: {type: gear, of: [A, B], ratio: -3}
  teeth: {type: gear, of: [B, C], ratio: 20 mm/rad}
frames: {ground/far: %s, ground/low: %s}
initial: {joints: {A: 0.3}}
drivers: {motor: {joint: B, kind: torque, value: 0.2*sin(10*t)}}
simulation: {end: 2 s, %s, output: {interval: 10 ms}}
""" % (space, v(0, -9.81), inertia(0.02), v(0.05, 0), inertia(1e-3), v(0.2, 0), inertia(1e-3), v(0.2, -0.1),
       v(0.2, 0), v(0.2, -0.1), steps)


class TurnedWorlds(SpatialTest):
    """A body in a ball or a bearing with play moves alike when the whole world is turned."""
    JOINTS = {"spherical": "{type: spherical, between: [ground/hook, top/neck], clearance: {bearing_radius: 10 mm, "
                           "radial_clearance: 0.2 mm, contact: {law: flores, K: 1e8, restitution: 0.7}, friction: %s}}",
              "revolute": "{type: revolute, between: [ground/hook, top/neck], axis: [1, 0, 0], clearance: "
                          "{bearing_radius: 10 mm, radial_clearance: 0.2 mm, length: 30 mm, "
                          "contact: {law: flores, K: 1e8, restitution: 0.7}, friction: %s}}"}
    MODEL = """
space: spatial
gravity: %s
bodies: {top: {mass: 1, inertia: [2e-3, 2e-3, 1e-3], com: [5 mm, 0, -50 mm], frames: {neck: [0, 0, 0]}, pose: {rpy: [%s]},
               velocity: {angular: %s}}}
frames: {ground/hook: {position: [0, 0, 0], rpy: [%s]}}
joints: {J: %s}
simulation: {end: 60 ms, accuracy: 1e-9, output: {interval: 1 ms}}
"""

    def test_friction_knows_no_direction_of_its_own(self):
        roll, pitch, yaw = 0.4, -0.7, 1.9
        z = lambda a: [[math.cos(a), -math.sin(a), 0], [math.sin(a), math.cos(a), 0], [0, 0, 1]]
        y = lambda a: [[math.cos(a), 0, math.sin(a)], [0, 1, 0], [-math.sin(a), 0, math.cos(a)]]
        x = lambda a: [[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]]
        turn = lambda v: product(z(yaw), product(y(pitch), product(x(roll), v)))
        laws = ("{law: coulomb-tanh, mu: 0.2}", "{law: lugre, mu_s: 0.3, mu_k: 0.2, v_stribeck: 0.01, sigma0: 1e4, sigma1: 5}")
        for name, joint in self.JOINTS.items():
            for law in laws:
                gravity, spin = [1.0, 2.0, -9.0], [3.0, 2.0, 8.0]
                plain = self.run_model(self.MODEL % (gravity, "0, 0, 0", spin, "0, 0, 0", joint % law))
                turned = self.run_model(self.MODEL % (turn(gravity), "%r, %r, %r" % (roll, pitch, yaw), turn(spin),
                                                      "%r, %r, %r" % (roll, pitch, yaw), joint % law))
                self.assertGreater(plain["energy.dissipated"][-1], 1e-4)
                self.assertGreater(max(map(abs, plain["joint.J.ft"])), 0.1)
                for energy in ("kinetic", "dissipated"):
                    for one, other in zip(plain["energy." + energy], turned["energy." + energy], strict=True):
                        self.assertLess(abs(one - other), 1e-7, (name, law, energy))
                for one, other in zip(self.rows(plain, "top", "x", "y", "z"), self.rows(turned, "top", "x", "y", "z"), strict=True):
                    self.assertLess(math.dist(turn(one), other), 1e-7, (name, law))
                self.assertLess(max(map(abs, plain["energy.residual"])), 1e-5 * plain["energy.kinetic"][0])


class BothEnds(SpatialTest):
    JOURNAL = """
freeplay: 1
name: journal
space: spatial
gravity: [0, -9.81, 0]
bodies: {shaft: {mass: 1, inertia: [1e-3, 1e-3, 1e-3]}}
joints:
  ring:
    type: revolute
    between: [ground, shaft]
    clearance:
      bearing_radius: 10 mm
      radial_clearance: 0.1 mm
      length: 20 mm
      material: {E: 207 GPa, nu: 0.3}
      contact: {law: flores, restitution: 0.7}
simulation: {end: 30 ms, %s, output: {interval: 1 ms}}
"""

    def test_ends_that_touch_at_the_same_instant_are_both_recorded(self):
        for steps in ("accuracy: 10 nm", "step: 10 us"):
            with self.subTest(steps=steps):
                self.write("m.yaml", self.JOURNAL % steps)
                self.freeplay("run", "m.yaml", "--out", "r", "--force")
                upper, lower = [], []
                for line in self.read("r", "events.csv").splitlines()[1:]:
                    end, what = line.split(",")[2].split("_", 1)
                    (upper if end == "upper" else lower).append([line.split(",")[0], what] + line.split(",")[3:])
                self.assertGreater(len(upper), 4)
                self.assertEqual(upper, lower)


class Gears(SpatialTest):
    def test_a_train_turns_as_in_the_plane(self):
        for steps in (EXACT, "integrator: bathe, step: 1 ms"):
            plane, space = (self.run_model(gear_train(word, steps)) for word in ("planar", "spatial"))
            self.assertGreater(max(plane["joint.A.angle"]) - min(plane["joint.A.angle"]), 3.0)
            for flat, deep in (("joint.A.angle", "joint.A.angle"), ("joint.B.angle", "joint.B.angle"),
                               ("joint.C.position", "joint.C.position"), ("body.rack.x", "body.rack.x"),
                               ("joint.mesh.torque", "joint.mesh.tz"), ("joint.teeth.fx", "joint.teeth.fx")):
                for x, y in zip(plane[flat], space[deep], strict=True):
                    self.assertLess(abs(x - y), 1e-9, (steps, flat))

    def test_bevel_gears_turn_about_axes_that_cross(self):
        # (I + r^2 J) q'' = M of the driven wheel; the gear turns the other about x by r q.
        columns = self.run_model("""
space: spatial
bodies: {one: {mass: 1, inertia: [1, 1, 0.02]}, other: {mass: 1, inertia: [0.005, 1, 1]}}
joints:
  A: {type: revolute, between: [ground, one]}
  B: {type: revolute, between: [ground, other], axis: [1, 0, 0]}
  bevel: {type: gear, of: [A, B], ratio: 2}
drivers: {motor: {joint: A, kind: torque, value: 0.08}}
simulation: {end: 1 s, output: {interval: 0.1 s}, %s}
""" % EXACT)
        self.assert_column(columns, "joint.A.angle", lambda t: t * t)
        self.assert_column(columns, "body.other.wx", lambda t: 4 * t)
        self.assert_column(columns, "joint.bevel.tx", lambda t: 0.02)
        self.assert_column(columns, "joint.bevel.ty", lambda t: 0.0)


class Axes(SpatialTest):
    def test_a_pendulum_swings_about_the_axis_that_is_given(self):
        plane = self.run_model("""
gravity: [0, -9.81]
bodies: {rod: {mass: 1, inertia: 0.02, com: [0.5, 0]}}
joints: {A: {type: revolute, between: [ground, rod]}}
simulation: {end: 1 s, output: {interval: 20 ms}, %s}
""" % EXACT)
        # The same in the plane of y and z: x is the axis, the rod lies along y.
        space = self.run_model("""
space: spatial
gravity: [0, 0, -9.81]
bodies: {rod: {mass: 1, inertia: [0.02, 0.3, 0.3], com: [0, 0.5, 0]}}
joints: {A: {type: revolute, between: [ground, rod], axis: [2, 0, 0]}}
simulation: {end: 1 s, output: {interval: 20 ms}, %s}
""" % EXACT)
        for flat, deep in (("body.rod.x", "body.rod.y"), ("body.rod.y", "body.rod.z"), ("joint.A.angle", "joint.A.angle"),
                           ("joint.A.fx", "joint.A.fy"), ("joint.A.fy", "joint.A.fz")):
            for x, y in zip(plane[flat], space[deep], strict=True):
                self.assertLess(abs(x - y), 1e-9, (flat, deep))

    def test_forces_and_torques_have_three_components(self):
        columns = self.run_model("""
space: spatial
bodies: {cube: {mass: 2, inertia: [1, 1, 1]}}
forces:
  push: {type: force, at: cube, value: [2, 4*t, -6]}
  turn: {type: torque, on: cube, value: [0, 0, 3]}
simulation: {end: 1 s, output: {interval: 0.1 s}, %s}
""" % EXACT)
        self.assert_column(columns, "body.cube.x", lambda t: t * t / 2)
        self.assert_column(columns, "body.cube.y", lambda t: t ** 3 / 3)
        self.assert_column(columns, "body.cube.z", lambda t: -1.5 * t * t)
        self.assert_column(columns, "body.cube.wz", lambda t: 3 * t)
        self.assert_column(columns, "force.turn.tz", lambda t: 3.0)
        self.assert_column(columns, "force.push.power", lambda t: 2 * t + 4 * t * t * t + 18 * t)


class Page(SpatialTest):
    """The table of joints in docs/model-file.md is what the program does."""
    MORE = {"distance": ", length: 1", "bushing": ", stiffness: {x: 1}", "spring-damper": ", stiffness: 1",
            "joint-friction": ", friction: 1", "joint-stop": ", lower: -2, upper: 2, stiffness: 1",
            "screw": ", lead: 1 mm", "revolute-spherical": ", length: 1", "point-on-curve": ", curve: x",
            "point-on-curve-lift-off": ", curve: x, lift_off: {contact: {law: hertz, K: 1e8}}",
            "slot-contact": ", pin_radius: 1 cm, gap: 1 mm, bottom: 1 cm, length: 1 m, contact: {law: hertz, K: 1e8}",
            "arc-contact": ", arc: {radius: 0.2}, disc: 0.5, contact: {law: hertz, K: 1e8}",
            "curve-contact": ", first: 0.2, second: {points: [[0, 0.3], [180 deg, 0.4], [360 deg, 0.3]], ends: periodic}, contact: {law: hertz, K: 1e8}",
            "brake": ", limit: 1, stiffness: 1", "one-way-clutch": ", stiffness: 1",
            "belt": ", first_radius: 1, second_radius: 1, stiffness: 1",
            "revolute-clearance": ", clearance: {radial_clearance: 1 mm, length: 1 cm, contact: {law: hertz, K: 1e8}}",
            "point-on-line-clearance": ", clearance: {gap: 1 mm, contact: {law: hertz, K: 1e8}}",
            "prismatic-clearance": ", clearance: {gap: 1 mm, length: 20 mm, width: 1 cm, height: 1 cm, contact: {law: hertz, K: 1e8}}",
            "spherical-clearance": ", clearance: {radial_clearance: 1 mm, contact: {law: hertz, K: 1e8}}",
            "cylindrical-clearance": ", clearance: {radial_clearance: 1 mm, length: 2 cm, contact: {law: hertz, K: 1e8}}",
            "universal-clearance": ", clearance: {radial_clearance: 1 mm, length: 2 cm, contact: {law: hertz, K: 1e8}, cross: {mass: 1, inertia: [1, 1, 1]}}"}
    ROW = re.compile(r"^\| `([-a-z]+)` \| (\d|-)?(?:, (\d|-)|0 in space) \| (angle|position|none) \|", re.M)

    def test_rows_and_coordinates_are_as_said(self):
        with open(os.path.join(ROOT, "docs", "model-file.md"), encoding="utf-8") as file:
            rows = self.ROW.findall(file.read())
        listed = {entry["name"] for entry in json.loads(self.freeplay("list", "joints", "--json")[0])}
        self.assertEqual(listed, {name for name, *_ in rows})
        for name, flat, deep, coordinate in rows:
            if name in ("gear", "gear-clearance"):
                continue
            joint = "joints: {J: {type: %s, between: [ground, b]%s}}\n" % (name, self.MORE.get(name, ""))
            for space, count, body in (("planar", flat, "inertia: 1, pose: {position: [1, 0]}"),
                                       ("spatial", deep or "0", "inertia: [1, 1, 1], pose: {position: [1, 0, 0]}")):
                flat_only = joint.replace(", length: 1 cm", "").replace(", height: 1 cm", "") if space == "planar" else joint
                text = "space: %s\nbodies: {b: {mass: 1, %s}}\n%s" % (space, body, flat_only)
                if not count.isdigit():
                    self.refusal(text, id="type-space", line=4)
                    continue
                self.facts(text, constraints=int(count))
                columns = self.freeplay("list", "channels", "m.yaml")[0]
                self.assertEqual(coordinate == "angle", "joint.J.angle" in columns, name)
                self.assertEqual(coordinate == "position", "joint.J.position" in columns, name)


if __name__ == "__main__":
    unittest.main()
