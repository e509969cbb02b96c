"""Linkages of bars, of rods without mass and of point masses move as formulas of their own say."""
import math
import unittest

from model_cases import EXACT, ModelTest, rk4

G = 9.81


class Rods(ModelTest):
    def test_a_rod_without_mass_couples_two_cranks(self):
        text = """
bodies:
  a: {mass: 1, inertia: 0.1, frames: {tip: [0.1, 0]}}
  b: {mass: 1, inertia: 0.1, frames: {tip: [0.25, 0]}, pose: {angle: 80 deg}}
joints:
  A: {type: revolute, between: [ground, a]}
  D: {type: revolute, between: [ground/D, b]}
  rod: {type: distance, between: [a/tip, b/tip], length: 300 mm}
frames: {ground/D: [0.4, 0]}
drivers: {m: {joint: A, kind: angle, value: 60 deg + 2*pi*t}}
simulation: {end: 1, step: 5 ms}
"""
        self.facts(text, constraints=5, dof=1, dof_driven=0)

        def rocker(t):
            a = math.radians(60) + 2 * math.pi * t
            x, y = 0.1 * math.cos(a) - 0.4, 0.1 * math.sin(a)
            gap = math.hypot(x, y)
            return math.atan2(y, x) - math.acos((0.25 ** 2 + gap ** 2 - 0.3 ** 2) / (2 * 0.25 * gap)) + (
                2 * math.pi if y < 0 else 0)

        columns = self.run_model(text)
        self.assert_column(columns, "joint.D.angle", rocker)

    def test_point_masses_on_rods_draw_the_line_of_peaucellier(self):
        text = """
parameters: {L: 0.5, s: 0.2, r: 0.18}
bodies:
  P: {mass: 1, inertia: 1e-3, com: [0, 0], pose: {position: [0.33, 0.1]}}
  crank: {mass: 1, inertia: 1e-3, frames: {P: [$r, 0]}}
  A: {mass: 1, inertia: 1e-3, pose: {position: [0.4, 0.28]}}
  B: {mass: 1, inertia: 1e-3, pose: {position: [0.45, -0.1]}}
  S: {mass: 1, inertia: 1e-3, pose: {position: [0.6, 0.15]}}
joints:
  Q: {type: revolute, between: [ground/Q, crank]}
  on: {type: fixed, between: [crank/P, P]}
  OA: {type: distance, between: [ground, A], length: $L}
  OB: {type: distance, between: [ground, B], length: $L}
  AP: {type: distance, between: [A, P], length: $s}
  BP: {type: distance, between: [B, P], length: $s}
  AS: {type: distance, between: [A, S], length: $s}
  BS: {type: distance, between: [B, S], length: $s}
frames: {ground/Q: [$r, 0]}
drivers: {m: {joint: Q, kind: angle, value: 30 deg * cos(2*t)}}
simulation: {end: 3, step: 10 ms}
"""
        # The points A, B, S also turn about themselves.
        self.facts(text, bodies=5, constraints=11, rank=11, dof=4, dof_driven=3)
        straight = (0.5 ** 2 - 0.2 ** 2) / (2 * 0.18)
        columns = self.run_model(text)
        self.assert_column(columns, "body.S.x", lambda t: straight)
        self.assert_column(columns, "body.S.y", lambda t: straight * math.tan(math.radians(30) * math.cos(2 * t) / 2))

    def test_a_parallelogram_with_one_crank_too_many_moves(self):
        text = """
gravity: [0, -9.81]
presets: {crank: {mass: 1, inertia: 0, com: [0.1, 0], frames: {tip: [0.2, 0]}}}
bodies:
  bar: {mass: 3 kg, inertia: 0.4, com: [0.3, 0], frames: {b: [0.25, 0], c: [0.6, 0]}}
  a: {use: crank}
  b: {use: crank}
  c: {use: crank}
joints:
  A: {type: revolute, between: [ground, a]}
  B: {type: revolute, between: [ground/b, b]}
  C: {type: revolute, between: [ground/c, c]}
  a: {type: revolute, between: [a/tip, bar]}
  b: {type: revolute, between: [b/tip, bar/b]}
  c: {type: revolute, between: [c/tip, bar/c]}
frames: {ground/b: [0.25, 0], ground/c: [0.6, 0]}
initial: {joints: {A: -30 deg}}
simulation: {end: 0.5, output: {interval: 50 ms}, %s}
""" % EXACT.replace("1e-11", "1e-10")
        self.facts(text, constraints=12, rank=11, redundant=1, dof=1)
        moment, pull = 3 * 0.1 ** 2 + 3 * 0.2 ** 2, (3 * 0.1 + 3 * 0.2) * G
        rates = lambda t, y: [y[1], -pull * math.cos(y[0]) / moment]
        columns = self.run_model(text)
        self.assert_column(columns, "joint.A.angle",
                           lambda t: rk4(rates, [-math.pi / 6, 0.0], t, 2000)[0], 1e-8)

    def test_two_welded_bodies_swing_as_one(self):
        text = """
gravity: [0, -9.81]
bodies:
  rod: {mass: 1, inertia: 1/12, com: [0.5, 0], frames: {end: {position: [1, 0], angle: 90 deg}}}
  bob: {mass: 2, inertia: 0.03, com: [0, -0.1]}
joints:
  pivot: {type: revolute, between: [ground, rod]}
  weld: {type: fixed, between: [rod/end, bob]}
initial: {joints: {pivot: -20 deg}}
simulation: {end: 1, output: {interval: 100 ms}, %s}
""" % EXACT
        self.facts(text, constraints=5, dof=1)
        bob = (1.1, 0.0)  # the bob's axes are turned by 90 degrees: its -y is the rod's +x
        moment = 1 / 12 + 0.25 + 0.03 + 2 * bob[0] ** 2
        rates = lambda t, y: [y[1], -(0.5 + 2 * bob[0]) * G * math.cos(y[0]) / moment]
        columns = self.run_model(text)
        self.assert_column(columns, "joint.pivot.angle",
                           lambda t: rk4(rates, [math.radians(-20), 0.0], t, 2000)[0], 1e-8)
        self.assert_column(columns, "body.bob.angle", lambda t: rk4(
            rates, [math.radians(-20), 0.0], t, 2000)[0] + math.pi / 2, 1e-8)

    def test_a_double_pendulum_of_point_masses(self):
        text = """
gravity: [0, -9.81]
bodies:
  one: {mass: 2, inertia: 0, com: [0.4, 0], frames: {tip: [0.4, 0]}}
  two: {mass: 1, inertia: 0, com: [0.3, 0]}
joints:
  A: {type: revolute, between: [ground, one]}
  B: {type: revolute, between: [one/tip, two]}
initial: {joints: {A: -30 deg, B: 50 deg}, speeds: {B: 1}}
simulation: {end: 0.6, output: {interval: 100 ms}, %s}
""" % EXACT
        self.facts(text, constraints=4, dof=2, coordinates=6)

        def rates(t, y):
            a, b, u, w = y  # absolute angles from +x and their speeds
            m1, m2, l1, l2, c, s = 2, 1, 0.4, 0.3, math.cos(b - a), math.sin(b - a)
            m11, m12, m22 = (m1 + m2) * l1 * l1, m2 * l1 * l2 * c, m2 * l2 * l2
            f1 = m2 * l1 * l2 * s * w * w - (m1 + m2) * G * l1 * math.cos(a)
            f2 = -m2 * l1 * l2 * s * u * u - m2 * G * l2 * math.cos(b)
            det = m11 * m22 - m12 * m12
            return [u, w, (m22 * f1 - m12 * f2) / det, (m11 * f2 - m12 * f1) / det]

        # The velocity that least energy leaves to the joint A: its momentum is zero there.
        c = math.cos(math.radians(50))
        u = -(0.3 * 0.3 + 0.4 * 0.3 * c) / (3 * 0.16 + 0.09 + 2 * 0.12 * c)
        first = [math.radians(-30), math.radians(20), u, u + 1]
        columns = self.run_model(text)
        self.assert_column(columns, "body.one.angle", lambda t: rk4(rates, first, t, 3000)[0], 1e-8)
        self.assert_column(columns, "body.two.angle", lambda t: rk4(rates, first, t, 3000)[1], 1e-8)

    def test_point_masses_on_slides_joined_by_a_rod(self):
        text = """
gravity: [0, -9.81]
bodies: {h: {mass: 2, inertia: 0}, v: {mass: 3, inertia: 0}}
joints:
  x: {type: prismatic, between: [ground, h]}
  y: {type: prismatic, between: [ground/up, v/up]}
  rod: {type: distance, between: [h, v], length: 1}
frames: {ground/up: {angle: 90 deg}, v/up: {angle: 90 deg}}
initial: {joints: {x: 0.6, y: 0.8}}
simulation: {end: 0.3, output: {interval: 50 ms}, %s}
""" % EXACT
        self.facts(text, constraints=5, dof=1)

        def rates(t, y):
            c, s = math.cos(y[0]), math.sin(y[0])
            return [y[1], (-3 * G * c + s * c * y[1] ** 2) / (2 * s * s + 3 * c * c)]

        columns = self.run_model(text)
        self.assert_column(columns, "joint.x.position", lambda t: math.cos(rk4(
            rates, [math.atan2(0.8, 0.6), 0.0], t, 3000)[0]), 1e-8)

    def test_a_bead_leaves_along_a_turning_rod(self):
        text = """
bodies: {rod: {mass: 1, inertia: 1}, bead: {mass: 1, inertia: 0.1}}
joints: {A: {type: revolute, between: [ground, rod]}, P: {type: point-on-line, between: [rod, bead]}}
drivers: {d: {joint: A, kind: velocity, value: 2}}
initial: {joints: {P: 0.5, A: 0}, speeds: {P: 0}}
simulation: {end: 1, output: {interval: 100 ms}, %s}
""" % EXACT
        self.facts(text, constraints=3, dof=3, dof_driven=2)
        self.assert_column(self.run_model(text), "joint.P.position", lambda t: 0.5 * math.cosh(2 * t), 1e-8)

    def test_a_point_mass_that_may_spin_is_refused(self):
        text = """
bodies: {p: {mass: 1, inertia: 0, pose: {position: [1, 0]}}}
joints: {rod: {type: distance, between: [ground, p], length: 1}}
"""
        self.refusal(text, id="singular-mass")


if __name__ == "__main__":
    unittest.main()
