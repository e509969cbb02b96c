"""Curves that touch, against formulas, against discs and arcs, and against a program of another method."""
import csv
import json
import math
import os
import unittest

import curve_reference as reference
from model_cases import EXACT, ModelTest

# Two free bodies that meet, the curves as circles about their middles or beside them.
PAIR = """
bodies:
  a: {mass: 2, inertia: 3e-3, velocity: {angular: 20}, frames: {hub: [%s, 0]}}
  b: {mass: 1, inertia: 1e-3, pose: {position: [0.2, %s]}, velocity: {linear: [-2, 0.3], angular: -5}, frames: {hub: [0, %s]}}
forces:
  c: {type: %s, contact: {law: kelvin-voigt, K: 1e5, D: 20}, friction: {law: threlfall, mu: 0.3, v_r: 10 mm/s}}
simulation: {end: 0.2 s, output: {interval: 1 ms}, accuracy: 1e-11}
"""
# Of the radius $r about a point at `off` along x, or y, of the frame.
ALONG_X = "%s*cos(x) + sqrt((%s)^2 - (%s*sin(x))^2)"
ALONG_Y = "%s*sin(x) + sqrt((%s)^2 - (%s*cos(x))^2)"
# A body of 2 kg on a curve of the ground.
RIDER = """
gravity: [0, -9.81]
bodies:
  rider: {mass: 2, inertia: 1e-3, pose: {position: [%r, %r], angle: %r}, velocity: {linear: [%r, %r], angular: %r}}
forces:
  c: {type: curve-contact, between: [%s], first: "%s", second: "%s", contact: {law: kelvin-voigt, K: 1e5, D: 0}%s}
simulation: {end: %s, output: {interval: %s}, %s}
"""
FRICTION = ", friction: {law: coulomb-tanh, mu: 0.3, vs: 50 mm/s}"
ELLIPSE = "1/sqrt((cos(x)/%s)^2 + (sin(x)/%s)^2)"
LOBES = "0.08 m + 0.01 m*cos(3*x)"
STATE = ("x", "y", "angle", "vx", "vy", "omega")


class CurveContacts(ModelTest):
    def events(self):
        with open(self.path("out", "events.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_circles_as_curves_move_as_discs_do(self):
        for offset in ("30 mm", "-45 mm"):
            # The middles of both circles are the same: a hub beside the middle has a curve that is not even.
            discs = self.run_model(PAIR % ("0", offset, "0", "arc-contact, between: [a, b], arc: {radius: 60 mm}, disc: 40 mm"))
            self.assertGreater(max(discs["force.c.fn"]), 10)
            even = "curve-contact, between: [a, b], first: 60 mm, second: 40 mm"
            beside = 'curve-contact, between: [a/hub, b/hub], first: "%s", second: "%s"' % (
                ALONG_X % ("-25 mm", "60 mm", "25 mm"), ALONG_Y % ("15 mm", "40 mm", "15 mm"))
            curves = self.run_model(PAIR % ("0", offset, "0", even))
            moved = self.run_model(PAIR % ("25 mm", offset, "-15 mm", beside))
            for columns in (curves, moved):
                self.assertEqual(len(discs["time"]), len(columns["time"]))
                for name, values in discs.items():
                    if not name.startswith("body.") and name not in ("force.c.fn", "force.c.delta", "energy.kinetic"):
                        continue
                    scale = max(1.0, *map(abs, values))
                    for x, y in zip(values, columns[name]):
                        self.assertAlmostEqual(x, y, delta=1e-9 * scale, msg=name)

    def test_ellipses_that_turn_about_their_foci_roll_on_each_other(self):
        # The classic pair of rollers that are not round: with the shafts 2 a apart both stay in touch and do not slip.
        p, k = 0.03, 0.5
        apart, ratio = 2 * p / (1 - k * k), (1 + k) / (1 - k)
        text = """
bodies:
  one: {mass: 1, inertia: 1e-3}
  two: {mass: 1, inertia: 1e-3, pose: {position: [%r, 0]}}
frames: {ground/shaft: [%r, 0]}
joints:
  one: {type: revolute, between: [ground, one]}
  two: {type: revolute, between: [ground/shaft, two]}
forces:
  c: {type: curve-contact, between: [one, two], first: "%s", second: "%s", contact: {law: kelvin-voigt, K: 1e5, D: 0}}
drivers:
  one: {joint: one, kind: angle, value: 3 rad/s*t}
  two: {joint: two, kind: angle, value: "-2*atan2(%r*sin(1.5 rad/s*t), cos(1.5 rad/s*t))"}
simulation: {end: 1.04 s, step: 1 ms, output: {interval: 10 ms}}
"""
        curve = "%r m/(1 + %r*cos(x))"
        # The far ends of both touch where the first has turned by half, the near ones at the start: the second points away.
        columns = self.run_model(text % (apart, apart, curve % (p, k), curve % (p, k), 1 / ratio))
        for row, t in enumerate(columns["time"]):
            self.assertAlmostEqual(0, columns["force.c.delta"][row], delta=1e-14)
            self.assertAlmostEqual(0, columns["force.c.vt"][row], delta=1e-12)
            angle = columns["force.c.first_angle"][row]
            self.assertAlmostEqual(1, math.cos(angle + 3 * t), delta=1e-12)

    def start_on(self, first, second, angle, depth, turn, speed):
        """State of a rider that touches the first curve about that angle, `depth` deep, and slides along."""
        low, high = 0.0, 0.5
        for _ in range(60):
            middle = 0.5 * (low + high)
            d = (middle * math.cos(angle), middle * math.sin(angle))
            if reference.touch(first, second, d, turn)[0] < -depth:
                low = middle
            else:
                high = middle
        normal = reference.touch(first, second, d, turn)[1]
        return [*d, turn, speed * normal[1], -speed * normal[0], 0.0]

    def test_a_body_slides_and_rolls_on_a_curve_as_in_a_program_of_another_method(self):
        cases = (("ellipse on ellipse", reference.ellipse(0.09, 0.06), ELLIPSE % ("0.09 m", "0.06 m"), 1.45),
                 ("ellipse on hollow lobes", reference.lobes(0.08, 0.01, 3), LOBES, 1.7))
        rider = reference.ellipse(0.03, 0.02)
        for name, first, formula, angle in cases:
            with self.subTest(name):
                start = self.start_on(first, rider, angle, 2 * 9.81 / 1e5, 0.3, 0.2)
                ended = reference.slide_on_ground(first, rider, 2, 1e-3, 1e5, 0.3, 0.05, list(start), 0.1, 4000)
                columns = self.run_model(RIDER % (*start, "ground, rider", formula, ELLIPSE % ("0.03 m", "0.02 m"), FRICTION,
                                                  "0.1 s", "1 ms", EXACT))
                for i, column in enumerate(STATE):
                    self.assertAlmostEqual(ended[i], columns["body.rider." + column][-1], delta=2e-8, msg=column)
                self.assertGreater(min(columns["force.c.fn"]), 1)
                self.assertLess(max(map(abs, columns["energy.residual"])), 1e-8)

    def test_a_pair_moves_alike_whichever_curve_is_named_first(self):
        rider = reference.ellipse(0.03, 0.02)
        start = self.start_on(reference.lobes(0.08, 0.01, 3), rider, 1.7, 1e-4, 0.3, 0.2)
        text = [RIDER % (*start, *between, FRICTION, "0.2 s", "1 ms", EXACT)
                for between in (("ground, rider", LOBES, ELLIPSE % ("0.03 m", "0.02 m")),
                                ("rider, ground", ELLIPSE % ("0.03 m", "0.02 m"), LOBES))]
        one, other = map(self.run_model, text)
        for column in STATE:
            for x, y in zip(one["body.rider." + column], other["body.rider." + column], strict=True):
                self.assertAlmostEqual(x, y, delta=1e-9)

    def test_energy_closes_over_bounces_from_a_hollow_curve(self):
        for friction in ("", FRICTION):
            columns = self.run_model(RIDER % (0.005, 0.12, 0.1, 0, 0, 0, "ground, rider", "0.08 m + 0.01 m*sin(3*x)",
                                              ELLIPSE % ("0.03 m", "0.02 m"), friction, "0.5 s", "1 ms", EXACT))
            self.assertGreater(len([e for e in self.events() if e["kind"] == "contact_begin"]), 2)
            self.assertLess(max(map(abs, columns["energy.residual"])), 1e-8)
            if not friction:
                total = [x + y for x, y in zip(columns["energy.kinetic"], columns["energy.potential"])]
                self.assertLess(max(total) - min(total), 1e-8)

    def test_steps_of_one_size_keep_their_order_on_a_curve(self):
        rider = reference.ellipse(0.03, 0.02)
        start = self.start_on(reference.lobes(0.08, 0.01, 3), rider, 1.7, 2 * 9.81 / 1e5, 0.3, 0.2)
        text = RIDER % (*start, "ground, rider", LOBES, ELLIPSE % ("0.03 m", "0.02 m"), FRICTION, "60 ms", "60 ms", "%s")
        exact = self.run_model(text % EXACT)
        for method, order in (("bathe", 2), ("dopri5", 5)):
            errors = []
            for size in (100e-6, 50e-6):
                columns = self.run_model(text % ("integrator: %s, step: %r s" % (method, size)))
                errors.append(max(abs(columns["body.rider." + c][-1] - exact["body.rider." + c][-1]) for c in STATE))
            self.assertAlmostEqual(order, math.log2(errors[0] / errors[1]), delta=0.2, msg="%s %r" % (method, errors))

    def test_curves_of_points_and_arcs_are_those_of_their_formulas(self):
        points = ", ".join("[%r rad, %r m]" % (x, 0.05 + 0.004 * math.cos(2 * x))
                           for x in (2 * math.pi * i / 200 for i in range(201)))
        pairs = (("{points: [%s], ends: periodic}" % points, '"0.05 m + 0.004 m*cos(2*x)"', 3e-7),
                 ("{arcs: [[10 mm, 0, 40 mm]]}", '"%s"' % (ALONG_X % ("10 mm", "40 mm", "10 mm")), 1e-9))
        for one, other, tolerance in pairs:
            motions = []
            for curve in (one, other):
                text = RIDER % (0.0, 0.1, 0.4, 0.1, 0, 1, "ground, rider", "%s", ELLIPSE % ("0.03 m", "0.02 m"), FRICTION,
                                "0.1 s", "1 ms", EXACT)
                motions.append(self.run_model(text.replace('"%s"' % "%s", curve)))
            self.assertGreater(max(motions[0]["force.c.fn"]), 10)
            for x, y in zip(motions[0]["body.rider.y"], motions[1]["body.rider.y"], strict=True):
                self.assertAlmostEqual(x, y, delta=tolerance)

    def test_a_body_on_a_stadium_passes_from_arc_to_line_without_a_jump(self):
        text = RIDER % (-0.02, 0.05 - 2 * 9.81 / 1e5, 0.0, 0.5, 0, 0, "ground, rider", "%s", "30 mm", "", "0.12 s", "0.5 ms", EXACT)
        columns = self.run_model(text.replace('"%s"' % "%s", "{arcs: [[-30 mm, 0, 20 mm], [30 mm, 0, 20 mm]]}"))
        for t, x, force in zip(columns["time"], columns["body.rider.x"], columns["force.c.fn"]):
            if x < 0.03:  # straight: a load that rests
                self.assertAlmostEqual(2 * 9.81, force, delta=1e-6)
                self.assertAlmostEqual(-0.02 + 0.5 * t, x, delta=1e-9)
        self.assertGreater(columns["body.rider.x"][-1], 0.035)
        self.assertLess(max(map(abs, columns["energy.residual"])), 1e-9)

    def test_depth_stays_above_zero_and_without_a_jump_where_one_passes_through_the_other(self):
        # The distance of the second origin from the curve on which it goes where both touch: nothing flips inside.
        text = """
bodies:
  slider: {mass: 1, inertia: 1e-3, frames: {hub: [0, 10 mm]}}
joints: {rail: {type: prismatic, between: [ground, slider]}}
forces: {c: {type: curve-contact, between: [ground, slider/hub], first: "%s", second: "%s", contact: {law: kelvin-voigt, K: 1, D: 0}}}
drivers: {push: {joint: rail, kind: position, value: "0.2 m - 0.4 m/s*t"}}
simulation: {end: 1 s, step: 0.5 ms, output: {interval: 0.5 ms}}
"""
        discs = self.run_model(text % (ALONG_X % ("10 mm", "60 mm", "10 mm"), ALONG_Y % ("-5 mm", "30 mm", "5 mm")))
        for x, delta in zip(discs["body.slider.x"], discs["force.c.delta"]):
            self.assertAlmostEqual(0.09 - math.hypot(x - 0.01, 0.005), delta, delta=1e-13)
        for curves in ((LOBES, ELLIPSE % ("0.03 m", "0.02 m")), (ELLIPSE % ("0.03 m", "0.02 m"), LOBES)):
            columns = self.run_model(text % curves)
            places, depths = columns["body.slider.x"], columns["force.c.delta"]
            for k in range(1, len(depths)):
                self.assertLess(abs(depths[k] - depths[k - 1]), 1.001 * abs(places[k] - places[k - 1]))
            inside = [delta > 0 for x, delta in zip(places, depths) if abs(x) < 0.07]
            self.assertTrue(inside and all(inside))
            self.assertGreater(max(depths), 0.07)

    def test_curves_that_cannot_be_are_refused_where_they_stand(self):
        body = RIDER % (0.0, 0.2, 0.0, 0, 0, 0, "ground, rider", "%s", "%s", "", "0.1 s", "1 ms", "step: 1 ms")
        body = body.replace('"%s"', "%s")
        ball = "10 mm"
        cases = ((('"0.05 m + 1 mm/(1 rad)*x"', ball), "is not closed"),
                 (('"0.02 m + 0.03 m*cos(x)"', ball), "crosses itself nowhere"),
                 ((ball, '"max(10 mm, 12 mm*cos(x))"'), "corner"),
                 (("{points: [[0 deg, 10 mm], [120 deg, 12 mm], [240 deg, 11 mm], [360 deg, 10 mm]]}", ball), "ends: periodic"),
                 (('"if(x > 1 rad, if(x > 2 rad, 12 mm, 10 mm), 12 mm)"', ball), "gap at 57 deg"),
                 (("{arcs: [[-30 mm, 0, 20 mm], [30 mm, 0, 20 mm]]}", "{arcs: [[-30 mm, 0, 20 mm], [30 mm, 0, 20 mm]]}"),
                  "both curves have straight or hollow parts"),
                 (('"80 mm + 20 mm*cos(3*x)"', "60 mm"), "has a hollow at"))
        for (first, second), told in cases:
            with self.subTest(told):
                errors = self.refusal(body % (first, second), line=7, id="bad-curve")
                self.assertIn(told, str(errors))

    def test_curves_that_start_inside_each_other_are_refused_where_they_stand(self):
        for y, refused in ((0.06, True), (0.0, True), (0.0899, False), (0.085, False)):
            text = RIDER % (0.0, y, 0.0, 0, 0, 0, "ground, rider", "60 mm", "30 mm", "", "1 ms", "1 ms", "step: 1 ms")
            if refused:
                errors = self.refusal(text, line=7, id="starts-inside")
                self.assertIn("'c'", errors[0]["message"])
                continue
            self.run_model(text)
            found = json.loads(self.freeplay("validate", self.write("m.yaml", "freeplay: 1\n" + text), "--json")[0])["messages"]
            doubts = [m["message"] for m in found if m["id"] == "starts-inside"]
            self.assertEqual(1 if y == 0.085 else 0, len(doubts))
            if doubts: self.assertIn("0.005 m deep in each other, 0.17 times the smaller radius", doubts[0])


if __name__ == "__main__":
    unittest.main()
