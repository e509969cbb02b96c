"""Universal joints with play: a cross in two bearings, against the model written out by hand and the ideal joint."""
import csv
import json
import math
import unittest

from model_cases import EXACT, ModelTest, rk4

ARM = """
space: spatial
gravity: [0, 0, -9.81]
bodies:
  arm: {mass: 1.5, inertia: [4e-3, 5e-3, 3e-3], com: [0, 0, %s]%s}
%sjoints:
%s%ssimulation: {end: %s, output: {interval: 1 ms}, %s}
"""
CROSS = "mass: 0.2, inertia: [4e-5, 5e-5, 7e-5]"
BLOCK = "bearing_radius: 8 mm, radial_clearance: %s, axial_clearance: %s, length: 12 mm, contact: {law: hertz, K: 1e9}%s"
BLOCKED = "  U: {type: universal, between: [ground, arm]%s, clearance: {cross: {%s}, %s}}\n"
BY_HAND = ("  U1: {type: revolute, between: [ground, cross], axis: [1, 0, 0], clearance: {%s}}\n"
           "  U2: {type: revolute, between: [cross, arm], axis: [0, 1, 0], clearance: {%s}}\n")
MOVES = ", velocity: {angular: [2, 1, 0]}"
STEPS = "integrator: bathe, step: 20 us"
LENGTH = -0.15


def block(play="20 um", axial="10 um", rest=""):
    return BLOCK % (play, axial, rest)


def universal(keys=None, cross=CROSS, coordinate="", more="", moves=MOVES, end="20 ms", steps=STEPS, com=LENGTH):
    return ARM % (com, moves, "", BLOCKED % (coordinate, cross, keys or block()), more, end, steps)


def by_hand(keys=None, moves=MOVES, end="20 ms", steps=STEPS):
    keys = keys or block()
    return ARM % (LENGTH, moves, "  cross: {%s}\n" % CROSS, BY_HAND % (keys, keys), "", end, steps)

# Two shafts whose axes meet at an angle; a torque holds the second back, so that pins lie against their bearings.
BEND, TURN, END, LOAD = 0.5, 10.0, 0.1, 0.2
SHAFTS = """
space: spatial
bodies: {ground: {frames: {tilted: {rpy: [%r, 0, 0]}}}, in: {mass: 1, inertia: [1e-3, 1e-3, 1e-3]}, out: {mass: 1, inertia: [1e-3, 1e-3, 1e-3], pose: {rpy: [%r, 0, 0]}}}
joints:
  A: {type: revolute, between: [ground, in]}
  B: {type: revolute, between: [ground/tilted, out]}
  U: {type: universal, between: [in, out]%s}
drivers: {turn: {joint: A, kind: angle, value: "%r*t"}}
forces: {brake: {type: torque, on: out, value: [0, %r, %r]}}
simulation: {end: %r, output: {interval: 1 ms}, %s}
"""


def shafts(play=None, steps="integrator: bathe, step: 20 us", end=END):
    law = "contact: {law: hunt-crossley, K: 1e9, restitution: 0.1}"
    keys = "" if play is None else (", clearance: {bearing_radius: 8 mm, radial_clearance: %r, length: 12 mm, %s, "
                                    "cross: {mass: 0.02, inertia: [4e-6, 4e-6, 7e-6]}}" % (play, law))
    return SHAFTS % (BEND, BEND, keys, TURN, LOAD * math.sin(BEND), -LOAD * math.cos(BEND), end, steps)


class UniversalWithPlay(ModelTest):
    def rows(self, text, *options):
        """Lines of results.csv but the names of columns."""
        self.freeplay("run", self.model(text), "--out", "out", "--quiet", *options)
        return self.read("out", "results.csv").splitlines()[1:]

    def test_facts_with_and_without_play(self):
        self.facts(universal(), bodies=2, clearance_joints=2, constraints=0, dof=12)
        for closed in ("U", "all", "U.*"):
            self.facts(universal(), "--ideal", closed, clearance_joints=0, constraints=10, dof=2)
        self.facts(universal(), "--ideal", "U.first", clearance_joints=1, constraints=5, dof=7)

    def test_it_has_the_bytes_of_the_model_written_out_by_hand(self):
        friction = block(rest=", friction: {law: coulomb-tanh, mu: 0.1, vs: 1 mm/s}")
        for steps in (STEPS, "integrator: dopri5, accuracy: 1 nm"):
            loose = self.rows(universal(friction, steps=steps))
            self.assertEqual(self.rows(by_hand(friction, steps=steps)), loose)
        self.assertEqual(self.rows(by_hand(), "--ideal", "all"), self.rows(universal(), "--ideal", "U"))

    def test_closed_it_is_the_ideal_joint_with_the_inertia_of_its_cross(self):
        """Lagrange's equations in the angles p of the cross about x and q of the arm about its y."""
        mass, i_x, i_y, i_z, cross, g = 1.5, 4e-3, 5e-3, 3e-3, 4e-5, 9.81
        i_x, i_y, load = i_x + mass * LENGTH ** 2, i_y + mass * LENGTH ** 2, mass * g * -LENGTH

        def rates(_, state):
            p, q, dp, dq = state
            inertia = cross + i_x * math.cos(q) ** 2 + i_z * math.sin(q) ** 2
            slope = 2 * math.cos(q) * math.sin(q) * (i_z - i_x)
            return [dp, dq, (-slope * dq * dp - load * math.sin(p) * math.cos(q)) / inertia,
                    (0.5 * slope * dp * dp - load * math.cos(p) * math.sin(q)) / i_y]
        columns = self.run_model(universal(end="0.3 s", steps=EXACT), "--ideal", "U")
        angles = rk4(rates, [0.0, 0.0, 2.0, 1.0], 0.3, 3000)
        for name, value in zip(("U.first.angle", "U.second.angle", "U.first.speed", "U.second.speed"), angles):
            self.assertAlmostEqual(value, columns["joint." + name][-1], delta=1e-8, msg=name)

    def test_closed_it_turns_the_second_shaft_as_hookes_joint_does(self):
        """tan(out) = cos(bend) tan(in); the ratio of speeds is cos(bend)/(1 - sin(bend)^2 sin(in)^2)."""
        columns = self.run_model(shafts(20e-6, EXACT, 0.14), "--ideal", "U")
        self.assert_column(columns, "joint.A.angle", lambda t: TURN * t, 1e-12)
        self.assert_column(columns, "joint.B.angle", lambda t: math.atan(math.cos(BEND) * math.tan(TURN * t)), 1e-9)
        self.assert_column(columns, "joint.B.speed",
                           lambda t: TURN * math.cos(BEND) / (1 - (math.sin(BEND) * math.sin(TURN * t)) ** 2), 1e-9)

    def test_as_its_play_goes_to_zero_the_second_shaft_tends_to_hookes_angle(self):
        """First order in the play c: M acts on the cross across both pins, each tilts by 2 (c + d)/L until half of the
        law's force at either end, F(d)/2 = M/L, carries it, and the second shaft lags by both tilts."""
        sine, bent, length = math.sin(BEND), math.cos(BEND), 12e-3
        turned = TURN * END
        hooke = math.atan(bent * math.tan(turned))
        first = (math.cos(turned), math.sin(turned), 0.0)
        second = (-math.sin(hooke), bent * math.cos(hooke), sine * math.cos(hooke))
        across = (first[1] * second[2] - first[2] * second[1], first[2] * second[0] - first[0] * second[2],
                  first[0] * second[1] - first[1] * second[0])
        part = across[2] * bent - across[1] * sine  # of M about the second shaft
        gains = TURN ** 2 * bent * sine ** 2 * math.sin(2 * turned) / (1 - (sine * math.sin(turned)) ** 2) ** 2
        depth = (2 * (LOAD + 1e-3 * gains) / part / length / 1e9) ** (2 / 3)
        for play in (40e-6, 20e-6, 10e-6):
            columns = self.run_model(shafts(play))
            self.assertAlmostEqual(TURN * END, columns["joint.A.angle"][-1], delta=1e-9)
            lag = hooke - columns["joint.B.angle"][-1]
            self.assertAlmostEqual(1.0, (lag * part * length / 4 - depth) / play, delta=0.04)
            if play < 15e-6:
                ratio = bent / (1 - (sine * math.sin(turned)) ** 2)
                self.assertAlmostEqual(1.0, columns["joint.B.speed"][-1] / TURN / ratio, delta=5e-3)

    def test_each_pin_has_columns_events_and_statistics_of_its_own(self):
        columns = self.run_model(shafts(20e-6, end=0.02))
        summary = json.loads(self.read("out", "summary.json"))["joints"]
        with open(self.path("out", "events.csv"), encoding="utf-8") as file:
            events = list(csv.DictReader(file))
        for pin in ("U.first", "U.second"):
            self.assertAlmostEqual(max(columns["joint.%s.delta" % pin]), summary[pin]["max_delta"], delta=2e-6)
            begins = [event for event in events if event["joint"] == pin and event["kind"].endswith("contact_begin")]
            self.assertEqual(len(begins), summary[pin]["contacts"])
            self.assertGreater(len(begins), 1)
            self.assertAlmostEqual(1.0, sum(summary[pin]["play"][part] for part in ("flight", "impact", "lasting")), delta=1e-9)

    def test_a_driver_turns_the_pin_that_its_coordinate_means(self):
        text = universal(coordinate=", coordinate: second", moves="", more="%s", end="10 ms")
        by_whole = text % "drivers: {turn: {joint: U, kind: angle, value: \"5*t\"}}\n"
        columns = self.run_model(by_whole)
        self.assert_column(columns, "joint.U.second.angle", lambda t: 5 * t, 1e-9)
        self.assertEqual(columns, self.run_model(by_whole.replace("joint: U,", "joint: U.second,")))

    def test_mistakes_have_place_and_remedy(self):
        cases = ((dict(keys=block("9 mm")), "out-of-range", "bearing_radius"),
                 (dict(keys=block().replace("12 mm", "0 mm")), "out-of-range", "length"),
                 (dict(keys=block().replace(", length: 12 mm", "")), "missing-key", "length"),
                 (dict(cross="mass: 0.2"), "missing-key", "inertia"), (dict(cross="mass: 0, inertia: [1, 1, 1]"), "out-of-range", "mass"),
                 (dict(cross="mass: 1, inertia: [1, 0, 1]"), "out-of-range", "> 0"),
                 (dict(cross="mass: 1, inertia: [1, 1, 3]"), "out-of-range", "largest"),
                 (dict(keys=block(rest=", gap: 1 mm")), "unknown-key", "gap"))
        for changes, known, word in cases:
            with self.subTest(word):
                errors = self.refusal(universal(**changes), id=known, line=8)
                self.assertIn(word, errors[0]["message"])
        driven = universal(more="drivers: {turn: {joint: U, kind: angle, value: \"5*t\"}}\n", moves="")
        for text in (driven, driven.replace("drivers", "initial").replace("{turn: {joint: U, kind: angle, value: \"5*t\"}}", "{joints: {U: 1}}")):
            errors = self.refusal(text, id="unknown-name", line=9)
            self.assertIn("name 'U.first' or 'U.second', or write 'coordinate: first'", errors[0]["suggestion"])
        ideal = ARM % (LENGTH, "", "", "  U: {type: universal, between: [ground, arm]}\n", "drivers: {turn: {joint: U, kind: angle, value: 1}}\n", "1 s", "step: 1 ms")
        self.assertIn("'coordinate: first' or 'coordinate: second'", self.refusal(ideal, id="wrong-type", line=9)[0]["suggestion"])
        deep = self.facts(universal(block(rest=", initial: {eccentricity: [0, 0, 1 mm]}")))["messages"]
        self.assertEqual([("doubtful-clearance", 8)] * 2, [(message["id"], message["line"]) for message in deep])
        shown = self.freeplay("validate", "m.yaml")[1].splitlines()
        self.assertEqual(["      |   ^"] * 2, [line for line in shown if "^" in line], "of the name in the file")


if __name__ == "__main__":
    unittest.main()
