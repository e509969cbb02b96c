"""Drivers, tables, forces, starts and stops do what their numbers say."""
import math
import unittest

from model_cases import EXACT, ModelTest

SLIDE = """
bodies: {b: {mass: 2, inertia: 1}}
joints: {s: {type: prismatic, between: [ground, b]}}
"""
TURN = """
bodies: {b: {mass: 2, inertia: 0.5}}
joints: {s: {type: revolute, between: [ground, b]}}
"""


def spline(times, values, ends):
    """Cubic spline through the points: its value as a function of time. Moments by Gauss elimination, no library."""
    n = len(times)
    h = [b - a for a, b in zip(times, times[1:])]
    d = [(b - a) / w for a, b, w in zip(values, values[1:], h)]
    rows = [[0.0] * n + [0.0] for _ in range(n)]
    for i in range(1, n - 1):
        rows[i][i - 1:i + 2] = [h[i - 1], 2 * (h[i - 1] + h[i]), h[i]]
        rows[i][n] = 6 * (d[i] - d[i - 1])
    if ends == "natural":
        rows[0][0] = rows[-1][n - 1] = 1.0
    elif ends == "clamped":
        rows[0][0:2], rows[0][n] = [2 * h[0], h[0]], 6 * d[0]
        rows[-1][n - 2:n], rows[-1][n] = [h[-1], 2 * h[-1]], -6 * d[-1]
    else:
        rows[0][0], rows[0][n - 1] = 1.0, -1.0
        rows[-1][0], rows[-1][1] = 2 * h[0], h[0]
        rows[-1][n - 2] += h[-1]
        rows[-1][n - 1] += 2 * h[-1]
        rows[-1][n] = 6 * (d[0] - d[-1])
    for k in range(n):
        pivot = max(range(k, n), key=lambda r: abs(rows[r][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for r in range(n):
            if r != k:
                f = rows[r][k] / rows[k][k]
                rows[r] = [x - f * y for x, y in zip(rows[r], rows[k])]
    m = [rows[i][n] / rows[i][i] for i in range(n)]

    def value(t):
        i = min(max(0, next((k for k in range(n - 1) if t <= times[k + 1]), n - 2)), n - 2)
        a, b, w = times[i + 1] - t, t - times[i], h[i]
        return (m[i] * a ** 3 + m[i + 1] * b ** 3) / (6 * w) + (values[i] / w - m[i] * w / 6) * a + (
            values[i + 1] / w - m[i + 1] * w / 6) * b

    return value


class Values(ModelTest):
    def driven(self, base, value, kind, end="1", step="10 ms"):
        return self.run_model(base + "drivers: {d: {joint: s, kind: %s, value: \"%s\"}}\nsimulation: {end: %s, step: %s}\n"
                              % (kind, value, end, step))

    def test_expressions_of_time_and_their_derivatives(self):
        for value, formula in {
                "0.1*sin(2*t) + 20 mm*cos(3*t)": lambda t: 0.1 * math.sin(2 * t) + 0.02 * math.cos(3 * t),
                "smooth(t, 0.2, 0.7)": lambda t: (lambda s: 6 * s ** 5 - 15 * s ** 4 + 10 * s ** 3)(
                    min(1, max(0, (t - 0.2) / 0.5))),
                "exp(-t)*log(1+t) - sqrt(1+t^2)": lambda t: math.exp(-t) * math.log(1 + t) - math.sqrt(1 + t * t),
                "-2^2*t + 2^3^2*t/1000": lambda t: -4 * t + 0.512 * t,
                "t/(1 m)*1 m^2/2/3": lambda t: t / 6,
                "(1+t)^1.5 - tan(t/2)": lambda t: (1 + t) ** 1.5 - math.tan(t / 2),
                "atan2(t, 1) + asin(t/2) - acos(t/3)": lambda t: math.atan2(t, 1) + math.asin(t / 2) - math.acos(t / 3),
                "min(1, 2, 1+t) * max(t, 0.2547) + abs(t-2)": lambda t: max(t, 0.2547) + 2 - t,
        }.items():
            with self.subTest(value):
                columns = self.driven(SLIDE, value, "position")
                self.assert_column(columns, "joint.s.position", formula)
                h = 1e-5
                inside = {name: values[1:-1] for name, values in columns.items()}
                self.assert_column(inside, "joint.s.speed", lambda t: (formula(t + h) - formula(t - h)) / (2 * h), 1e-4)

    def test_efforts_are_applied_and_speeds_integrated(self):
        columns = self.driven(TURN, "3 N*m * cos(4*t)", "torque", step="0.1 ms")
        self.assert_column(columns, "joint.s.angle", lambda t: 6 / 16 * (1 - math.cos(4 * t)), 1e-7)
        columns = self.driven(SLIDE, "5 N", "force", step="1 ms")
        self.assert_column(columns, "joint.s.position", lambda t: 1.25 * t * t)
        self.assert_column(columns, "driver.d.power", lambda t: 5 * 2.5 * t)
        columns = self.driven(SLIDE, "0.3 m/s * exp(-2*t)", "velocity")
        self.assert_column(columns, "joint.s.position", lambda t: 0.15 * (1 - math.exp(-2 * t)))
        columns = self.driven(TURN, "30 rpm", "velocity")
        self.assert_column(columns, "body.b.angle", lambda t: math.pi * t)

    def test_the_effort_of_a_driver_is_that_of_newton(self):
        columns = self.driven(TURN, "0.2*t^3", "angle")
        self.assert_column(columns, "driver.d.torque", lambda t: 0.5 * 1.2 * t, 1e-8)
        self.assert_column(columns, "driver.d.power", lambda t: 0.6 * t * 0.6 * t * t, 1e-8)


class Tables(ModelTest):
    TIMES, ANGLES = [0.0, 0.2, 0.5, 0.9, 1.0], [10.0, 40.0, -20.0, 5.0, 10.0]

    def table(self, keys, kind="angle"):
        return TURN + "drivers: {d: {joint: s, kind: %s, table: {%s}}}\n" % (kind, keys) + \
            "simulation: {end: 1, step: 10 ms}\n"

    def test_splines_with_every_end(self):
        points = ", ".join("[%r s, %r deg]" % p for p in zip(self.TIMES, self.ANGLES))
        for ends in ("natural", "clamped", "periodic"):
            with self.subTest(ends):
                value = spline(self.TIMES, [math.radians(a) for a in self.ANGLES], ends)
                columns = self.run_model(self.table("points: [%s], ends: %s" % (points, ends)))
                self.assert_column(columns, "joint.s.angle", value)

    def test_columns_units_lines_and_what_is_outside(self):
        self.write("motor.csv", "# from the bench\nn,angle , ms\n# note\n0,0,100\n1, 90,300\n2,45 ,500\n")
        keys = "file: motor.csv, time: ms, value: angle, time_unit: ms, unit: deg, interpolation: linear"
        line = lambda t: 450 * (t - 0.1) if t < 0.3 else 90 - 225 * (t - 0.3)
        columns = self.run_model(self.table(keys))
        self.assert_column(columns, "joint.s.angle", lambda t: math.radians(line(min(0.5, max(0.1, t)))))
        self.freeplay("run", self.model(self.table(keys + ", outside: error")), code=3)
        text = self.table(keys + ", outside: error") + "initial: {}\n"
        text = text.replace("{end: 1,", "{start: 0.2, end: 1,")
        _, err = self.freeplay("run", self.model(text), "--out", "late", code=4)
        self.assertIn("0.5", err)

    def test_a_period_repeats(self):
        points = "[0, 0], [0.1, 0.2], [0.25, 0]"
        columns = self.run_model(self.table("points: [%s], ends: periodic, outside: repeat" % points))
        value = spline([0, 0.1, 0.25], [0, 0.2, 0], "periodic")
        self.assert_column(columns, "joint.s.angle", lambda t: value(math.fmod(t + 1e-12, 0.25) - 1e-12), 1e-8)

    def test_a_table_of_torques_and_the_short_form(self):
        self.write("torque.csv", "t,M\n0,1\n1,1\n2,1\n")
        text = TURN + "drivers: {d: {joint: s, kind: torque, table: torque.csv}}\nsimulation: {end: 1, step: 1 ms}\n"
        columns = self.run_model(text)
        self.assert_column(columns, "joint.s.angle", lambda t: t * t)
        text = text.replace("torque,", "velocity,")
        self.assert_column(self.run_model(text), "joint.s.angle", lambda t: t)


    def test_an_effort_needs_no_derivative(self):
        # At t = 0 the rate of each is infinite or not a number; TURN has an inertia of 1 kg m^2 or the like: M = t^1.5.
        for value in ("t^1.5", "sqrt(t)*t", "sqrt(t^3)"):
            with self.subTest(value):
                text = TURN + "drivers: {d: {joint: s, kind: torque, value: %s}}\nsimulation: {end: 1, step: 1 ms}\n" % value
                columns = self.run_model(text)
                self.assert_column(columns, "driver.d.torque", lambda t: t ** 1.5, 1e-12)
        text = TURN + "drivers: {d: {joint: s, kind: velocity, value: t^1.5}}\nsimulation: {end: 1, step: 1 ms}\n"
        self.assert_column(self.run_model(text), "joint.s.angle", lambda t: t ** 2.5 / 2.5, 1e-9)
        text = text.replace("velocity", "angle")
        self.freeplay("validate", self.model(text), code=3)


class Forces(ModelTest):
    def test_a_force_in_the_axes_of_its_body(self):
        text = """
bodies: {b: {mass: 2, inertia: 0.5, com: [0.1, 0], frames: {jet: {position: [0.1, 0], angle: 90 deg}}, velocity: {angular: 3}}}
forces: {jet: {type: force, at: b/jet, value: [4 N, 0], axes: frame}}
simulation: {end: 1, output: {interval: 50 ms}, %s}
""" % EXACT
        self.facts(text, bodies=1, joints=0, constraints=0, dof=3)
        columns = self.run_model(text)
        # The guess is of the body frame's origin; the centre of mass moves with 0.3 m/s along y.
        self.assert_column(columns, "body.b.x", lambda t: 0.1 + -2 * (t / 3 - math.sin(3 * t) / 9))
        self.assert_column(columns, "body.b.y", lambda t: 0.3 * t + 2 * (1 - math.cos(3 * t)) / 9)
        self.assert_column(columns, "body.b.angle", lambda t: 3 * t)

    def test_an_eccentric_force_and_a_torque_turn(self):
        text = """
bodies: {b: {mass: 2, inertia: 0.5, frames: {e: [0, 0.25]}}}
forces:
  f: {type: force, at: b/e, value: [0, 0]}
  m: {type: torque, on: b, value: "2 N*m * smooth(t, 0, 1)"}
simulation: {end: 1, output: {interval: 50 ms}, %s}
""" % EXACT
        columns = self.run_model(text)
        twice = lambda t: 6 * t ** 7 / 42 - 15 * t ** 6 / 30 + 10 * t ** 5 / 20
        self.assert_column(columns, "body.b.angle", lambda t: 4 * twice(t))

    def test_bodies_may_have_a_gravity_of_their_own(self):
        text = """
gravity: [0, -10]
bodies: {a1: {mass: 1, inertia: 1}, a2: {mass: 1, inertia: 1}, b: {mass: 1, inertia: 1}}
forces: {moon: {type: gravity, on: [a*], value: [1.6 m/s^2, 0]}}
simulation: {end: 1, step: 1 ms}
"""
        columns = self.run_model(text)
        for body, x, y in (("a1", 0.8, 0), ("a2", 0.8, 0), ("b", 0, -5)):
            self.assert_column(columns, "body.%s.x" % body, lambda t: x * t * t)
            self.assert_column(columns, "body.%s.y" % body, lambda t: y * t * t)

    def test_a_spring_between_joined_bodies(self):
        text = """
bodies:
  a: {mass: 1, inertia: 0.2, frames: {k: [0.3, 0]}}
joints: {A: {type: revolute, between: [ground, a]}}
frames: {ground/k: [0, 0.4]}
forces: {k: {type: spring-damper, between: [ground/k, a/k], stiffness: 10 N/m, damping: 1, free_length: 0.1, preload: 2}}
initial: {joints: {A: 0}, speeds: {A: 2}}
simulation: {end: 1 ms, step: 1 ms}
"""
        # At the start L = 0.5, and the end moves up with 0.6 m/s: dL/dt = -0.6 * 0.8.
        pull = 10 * 0.4 + 2 + 1 * -0.48
        columns = self.run_model(text)
        self.assertAlmostEqual(0.5, columns["force.k.length"][0], places=12)
        self.assertAlmostEqual(-pull * 0.6, columns["force.k.fx"][0], places=9)
        self.assertAlmostEqual(pull * 0.8, columns["force.k.fy"][0], places=9)
        self.assertAlmostEqual(-0.48 * pull * -1, -columns["force.k.power"][0] * -1, places=9)


class Starts(ModelTest):
    def test_a_pose_and_a_velocity_are_of_the_body_frame(self):
        text = """
bodies:
  b: {mass: 1, inertia: 1, com: [0.2, 0.1], pose: {position: [1, 2], angle: 90 deg}, velocity: {linear: [1, 0], angular: 2}}
simulation: {end: 1, step: 10 ms}
"""
        columns = self.run_model(text)
        self.assert_column(columns, "body.b.x", lambda t: 0.9 + (1 - 2 * 0.2) * t)
        self.assert_column(columns, "body.b.y", lambda t: 2.2 - 0.2 * t)

    def test_a_run_ends_at_its_condition(self):
        text = """
gravity: [0, -9.81]
bodies: {b: {mass: 1, inertia: 1, velocity: {linear: [0, 3]}}}
simulation: {end: 5, step: 1 ms, stop: [{channel: body.b.y, below: -10 mm, after: 0.1 s}, {channel: body.b.vy, above: 4}]}
"""
        columns = self.run_model(text)
        hit = (3 + math.sqrt(9 + 2 * 9.81 * 0.01)) / 9.81
        self.assertAlmostEqual(hit, columns["time"][-1], delta=1.001e-3)
        self.assertGreater(columns["time"][-1], hit)

    def test_a_later_start_and_rows_of_an_interval(self):
        columns = self.run_model(SLIDE + """
drivers: {d: {joint: s, kind: position, value: t^2}}
simulation: {start: 0.5, end: 1.05, step: 3 ms, output: {interval: 0.1 s, channels: [joint.s.*]}}
""")
        self.assertEqual({"time", "joint.s.position", "joint.s.speed", "joint.s.fx", "joint.s.fy", "joint.s.torque"},
                         set(columns))
        self.assertEqual([0.5 + k * 0.1 for k in range(6)] + [1.05], columns["time"])
        self.assert_column(columns, "joint.s.position", lambda t: t * t)


class Kinematics(ModelTest):
    FIVE_BAR = """
presets: {rod: {mass: 1, inertia: 0.01, frames: {tip: [0.3, 0]}}}
bodies:
  a: {mass: 1, inertia: 0.01, frames: {tip: [0.2, 0]}}
  b: {mass: 1, inertia: 0.01, frames: {tip: [0.2, 0]}}
  c: {use: rod}
  tip: {mass: 0.1, inertia: 0.001, pose: {position: [0.1, 0.3]}}
  d: {use: rod}
joints:
  A: {type: revolute, between: [ground, a]}
  B: {type: revolute, between: [ground/B, b]}
  C: {type: revolute, between: [a/tip, c]}
  D: {type: revolute, between: [b/tip, d]}
  T: {type: revolute, between: [c/tip, tip]}
  U: {type: revolute, between: [d/tip, tip]}
frames: {ground/B: [0.2, 0]}
drivers:
  hand:
    inverse_kinematics:
      frame: tip
      path: {x: 0.1 + 0.05*cos(3*t), y: 0.35 + 0.05*sin(3*t), angle: 0}
      joints: [A, B]
      elbow: [1, -1]
simulation: {end: 2, step: 10 ms}
"""

    def test_the_legs_of_a_five_bar_bend_to_the_given_side(self):
        self.facts(self.FIVE_BAR, bodies=5, joints=6, drivers=2, constraints=12, dof=3, dof_driven=1)
        columns = self.run_model(self.FIVE_BAR)

        def crank(x0, elbow):
            def angle(t):
                x, y = 0.1 + 0.05 * math.cos(3 * t) - x0, 0.35 + 0.05 * math.sin(3 * t)
                gap = math.hypot(x, y)
                return math.atan2(y, x) + elbow * math.acos((0.04 + gap * gap - 0.09) / (0.4 * gap))
            return angle

        self.assert_column(columns, "joint.A.angle", crank(0, 1))
        self.assert_column(columns, "joint.B.angle", crank(0.2, -1))
        self.assert_column(columns, "driver.hand.ex", lambda t: 0)

    def test_one_component_is_enough_for_one_freedom(self):
        text = """
bodies:
  crank: {mass: 1, inertia: 0.01, frames: {tip: [0.1, 0]}}
  rod: {mass: 1, inertia: 0.01, frames: {tip: [0.3, 0]}}
  slider: {mass: 1, inertia: 0.01, pose: {position: [0.35, 0]}}
joints:
  A: {type: revolute, between: [ground, crank]}
  B: {type: revolute, between: [crank/tip, rod]}
  C: {type: revolute, between: [rod/tip, slider]}
  G: {type: prismatic, between: [ground, slider]}
drivers: {x: {inverse_kinematics: {frame: slider, path: {x: 0.3 + 0.02*sin(5*t)}, joints: A, elbow: -1}}}
simulation: {end: 1, step: 5 ms}
"""
        self.facts(text, constraints=8, dof=1, dof_driven=0)
        columns = self.run_model(text)
        x = lambda t: 0.3 + 0.02 * math.sin(5 * t)
        self.assert_column(columns, "joint.A.angle",
                           lambda t: -math.acos((0.01 + x(t) ** 2 - 0.09) / (0.2 * x(t))))

    def test_racks_and_pinions_follow_a_path(self):
        text = """
parameters: {r: 20 mm}
bodies: {x: {mass: 1, inertia: 1}, y: {mass: 1, inertia: 1}, a: {mass: 1, inertia: 0.01}, b: {mass: 1, inertia: 0.01}}
joints:
  X: {type: prismatic, between: [ground, x]}
  Y: {type: prismatic, between: [x/up, y/up]}
  A: {type: revolute, between: [ground, a]}
  B: {type: revolute, between: [x, b]}
  a: {type: gear, of: [A, X], ratio: $r, offset: 0}
  b: {type: gear, of: [B, Y], ratio: -$r, offset: 0 mm}
frames: {x/up: {angle: 90 deg}, y/up: {angle: 90 deg}}
drivers: {plot: {inverse_kinematics: {frame: y, path: {x: 0.2 + 0.1*cos(t), y: 0.1*sin(2*t)}, joints: [A, B]}}}
simulation: {end: 3, step: 10 ms}
"""
        self.facts(text, drivers=2, constraints=10, dof=2, dof_driven=0)
        columns = self.run_model(text)
        self.assert_column(columns, "joint.A.angle", lambda t: 10 + 5 * math.cos(t))
        self.assert_column(columns, "joint.B.angle", lambda t: -5 * math.sin(2 * t))

    def test_slides_by_inverse_kinematics(self):
        text = """
bodies: {x: {mass: 1, inertia: 1}, y: {mass: 1, inertia: 1, frames: {pen: [0.1, 0]}}}
joints:
  X: {type: prismatic, between: [ground, x]}
  Y: {type: prismatic, between: [x/up, y/up]}
frames: {x/up: {angle: 90 deg}, y/up: {angle: 90 deg}}
drivers: {plot: {inverse_kinematics: {frame: y/pen, path: {x: 0.2*cos(t), y: 0.1*sin(2*t)}, joints: [X, Y]}}}
simulation: {end: 3, step: 10 ms}
"""
        self.facts(text, drivers=2, dof=2, dof_driven=0)
        columns = self.run_model(text)
        self.assert_column(columns, "joint.X.position", lambda t: 0.2 * math.cos(t) - 0.1)
        self.assert_column(columns, "joint.Y.position", lambda t: 0.1 * math.sin(2 * t))


if __name__ == "__main__":
    unittest.main()
