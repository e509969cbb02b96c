"""Springs whose force goes through given points."""
import json
import math
import unittest

from model_cases import EXACT, ModelTest

POINTS = [(-0.02, -900.0), (-0.005, -60.0), (0.0, 0.0), (0.01, 200.0), (0.03, 1500.0)]


def natural_spline(points):
    """Second derivatives at the points, by elimination."""
    n = len(points)
    rows = [[0.0] * (n + 1) for _ in range(n)]
    rows[0][0] = rows[-1][n - 1] = 1.0
    for i in range(1, n - 1):
        (a, fa), (b, fb), (c, fc) = points[i - 1:i + 2]
        rows[i][i - 1:i + 2] = [(b - a) / 6, (c - a) / 3, (c - b) / 6]
        rows[i][n] = (fc - fb) / (c - b) - (fb - fa) / (b - a)
    for i in range(n):
        pivot = rows[i][i]
        rows[i] = [x / pivot for x in rows[i]]
        for k in range(n):
            if k != i:
                rows[k] = [x - rows[k][i] * y for x, y in zip(rows[k], rows[i])]
    return [row[n] for row in rows]


def through_points(x, cubic, points=POINTS):
    """The force at x; beyond the ends straight on."""
    bends = natural_spline(points) if cubic else [0.0] * len(points)
    i = max(0, min(len(points) - 2, sum(x >= p for p, _ in points) - 1))
    (a, fa), (b, fb) = points[i:i + 2]
    inside, h = max(a, min(b, x)), b - a
    u, v = (b - inside) / h, (inside - a) / h
    value = u * fa + v * fb + ((u ** 3 - u) * bends[i] + (v ** 3 - v) * bends[i + 1]) * h * h / 6
    slope = (fb - fa) / h + ((3 * v * v - 1) * bends[i + 1] - (3 * u * u - 1) * bends[i]) * h / 6
    return value + slope * (x - inside)


class SpringsThroughPoints(ModelTest):
    TEXT = """
bodies: {sled: {mass: 2 kg, inertia: 1}}
joints: {rail: {type: prismatic, between: [ground, sled]}}
forces:
  tie:
    type: spring-damper
    between: [ground, sled]
    free_length: 1 m
    spring: {points: [[-20 mm, -900 N], [-5 mm, -60 N], [0, 0], [10 mm, 200 N], [30 mm, 1.5 kN]], interpolation: %s}
initial: {joints: {rail: 1.035 m}, speeds: {rail: 0.5 m/s}}
simulation: {end: 0.5, %s, output: {interval: 2 ms}}
"""

    def test_pull_as_their_lines_or_their_spline_and_keep_the_energy(self):
        for word in ("linear", "cubic"):
            columns = self.run_model(self.TEXT % (word, "accuracy: 1e-9"))
            for row, x in enumerate(columns["joint.rail.position"]):
                wanted = -through_points(x - 1, word == "cubic")
                self.assertAlmostEqual(wanted, columns["force.tie.fx"][row], delta=1e-8 * max(1, abs(wanted)))
            self.assertLess(min(columns["joint.rail.position"]), 0.978)
            self.assertGreater(max(columns["joint.rail.position"]), 1.031)
            self.assertLess(max(map(abs, columns["energy.residual"])), 1e-8 * max(columns["energy.potential"]))

    def test_of_a_straight_line_are_the_linear_spring(self):
        text = self.TEXT % ("cubic", EXACT)
        head, _, tail = text.partition("    spring:")
        tail = tail[tail.index("\n"):]
        line = self.run_model(head + "    spring: {points: [[-1 mm, -3 N], [0, 0 N], [5 mm, 15 N]]}" + tail)
        number = self.run_model(head + "    stiffness: 3000 N/m" + tail)
        for name in ("joint.rail.position", "energy.potential"):
            for x, y in zip(number[name], line[name], strict=True):
                self.assertAlmostEqual(x, y, delta=1e-9)

    def test_that_store_less_than_nothing_where_they_start_swing_as_they_should(self):
        """k u^2/2 + P u is negative between -2 P/k and 0; the same force by stiffness, formula and points."""
        mass, k, preload, start = 2.0, 1000.0, 50.0, 0.97
        middle, rate = 1.0 - preload / k, math.sqrt(k / mass)
        laws = ("stiffness: 1000 N/m\n    preload: 50 N", 'spring: "1000 N/m*x + 50 N"',
                "spring: {points: [[-100 mm, -50 N], [0, 50 N]]}")
        for law in laws:
            for settings in ("accuracy: 1e-9", "step: 20 us"):
                head, _, tail = (self.TEXT % ("linear", settings)).partition("    spring:")
                tail = tail[tail.index("\n"):].replace("rail: 1.035 m", "rail: 0.97 m").replace("rail: 0.5 m/s", "rail: 0")
                columns = self.run_model(head + "    " + law + tail)
                for t, x in zip(columns["time"], columns["joint.rail.position"], strict=True):
                    self.assertAlmostEqual(middle + (start - middle) * math.cos(rate * t), x, delta=1e-7)

    def test_say_what_is_wrong_with_the_points(self):
        for points, error in (
                ("[[0, 0], [0, 1 N]]", "bad-table"), ("[[0, 0]]", "bad-table"), ("[[0, 0], [1 N, 1 N]]", "dimension-mismatch"),
                ("[[0, 0], [1 mm, 1 mm]]", "dimension-mismatch"), ("[[0, 0], [1 mm]]", "wrong-length"), ("3", "wrong-type")):
            text = (self.TEXT % ("linear", "step: 1 ms"))
            start = text.index("points: ") + len("points: ")
            text = text[:start] + points + text[text.index(", interpolation"):]
            self.refusal(text, id=error, line=10)
        self.refusal(self.TEXT % ("quadratic", "step: 1 ms"), line=10)
        self.refusal((self.TEXT % ("linear", "step: 1 ms")).replace("interpolation: linear", "intrepolation: linear"),
                     id="unknown-key", line=10)
        self.refusal((self.TEXT % ("linear", "step: 1 ms")).replace("interpolation: linear", "ends: periodic"),
                     id="bad-table", line=10)

    # Three of them a bump stop, a damper whose force bends at a speed and a rubber stop to both sides, with the piece that
    # swings out; then such as springs have.
    SWING = (([(-10, 0), (0, 0), (5, 0), (8, 0), (10, 3000)], 2), ([(-10, -1000), (-1, -800), (0, 0), (1, 800), (10, 1000)], 0),
             ([(-10, -900), (-5, 0), (5, 0), (10, 900)], 1))
    SMOOTH = ([(x, 3 * x ** 3) for x in range(-6, 7, 2)], [(x, 500 * math.tanh(x / 4)) for x in range(-12, 13, 4)],
              [(x, x * x) for x in range(-6, 7, 2)], [(x, 300 * math.sin(x)) for x in range(-9, 10)], [(-10, -900), (0, 0), (10, 600)],
              [(x, 7) for x in (0, 1.7, 2.9, 5.3)], [(0, 0), (10, 3)])

    def test_are_doubted_where_their_cubic_turns_back_between_points_that_go_on(self):
        for points, piece in self.SWING:
            for keys, said in ((", interpolation: linear", False), ("", True)):
                with self.subTest(points=points, keys=keys):
                    found = self.doubts(points, keys)
                    self.assertEqual(said, bool(found), found)
            message = found[0]
            (a, fa), (b, fb) = points[piece:piece + 2]
            outside = lambda v: max(v - max(fa, fb), min(fa, fb) - v)
            place = max((a + (b - a) * k / 8 for k in range(1, 8)), key=lambda x: outside(through_points(x, True, points)))
            self.assertEqual(9, message["line"])
            self.assertIn("'forces.tie.spring.points' comes to %.4g N at x = %.4g m, but the two points beside it are %.4g and %.4g: write "
                          "'interpolation: linear', or give more points" % (through_points(place, True, points), place / 1e3, min(fa, fb),
                                                                           max(fa, fb)), message["message"])
        for points in self.SMOOTH:
            with self.subTest(points=points):
                self.assertEqual([], self.doubts(points, ""))

    def doubts(self, points, keys):
        text = "[%s]" % ", ".join("[%r mm, %r N]" % point for point in points)
        self.write("m.yaml", "freeplay: 1\n" + (self.TEXT % ("linear", "step: 1 ms")).lstrip("\n").replace(
            "[[-20 mm, -900 N], [-5 mm, -60 N], [0, 0], [10 mm, 200 N], [30 mm, 1.5 kN]], interpolation: linear", text + keys))
        found = json.loads(self.freeplay("validate", "m.yaml", "--json")[0])["messages"]
        return [message for message in found if message["id"] == "doubtful-value" and "cubic" in message["message"]]


if __name__ == "__main__":
    unittest.main()
