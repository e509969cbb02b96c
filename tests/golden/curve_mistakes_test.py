"""Curves that are none are refused when the model is read: not closed, through their origin, with corners and jumps."""
import math
import unittest

from model_cases import ModelTest

CAM = """
bodies: {cam: {mass: 1, inertia: 0.002}, follower: {mass: 0.5 kg, inertia: 1}}
frames: {ground/up: {angle: 90 deg}, follower/up: {angle: 90 deg}}
joints:
  shaft: {type: revolute, between: [ground, cam]}
  guide: {type: prismatic, between: [ground/up, follower/up]}
  cam: {type: point-on-curve, form: polar, between: [cam, follower], curve: %s}
drivers: {motor: {joint: shaft, kind: velocity, value: 3 rad/s}}
initial: {joints: {shaft: 0}}
simulation: {end: 0.1, accuracy: 1 um}
"""
GROOVE = """
bodies: {bead: {mass: 0.3, inertia: 1e-4}}
joints:
  pin: {type: point-on-curve, between: [ground, bead], curve: %s}
simulation: {end: 0.1, accuracy: 1 um}
"""
PLACE = 77  # of the curve in the cam's line
LIFT = ", lift_off: {contact: {law: hertz, K: 1e8}}"

# Around an origin; what the message says.
ROUND = [
    ('"40 mm + 3 mm*x"', "begins 0.04 m from its origin and ends 0.0588496 m from it after one turn (x = 2 pi), 0.0188496 m apart"),
    ('"50 mm + 4 mm*sin(1.5*x) + 1 mm*x/pi"', "0.002 m apart; write it so that it comes back"),
    ("{points: [[0, 40 mm], [2, 45 mm], [6.28, 40 mm]], ends: periodic}", "is not closed"),
    ("{points: [[0, 40 mm], [120 deg, 45 mm], [360 deg, 40 mm]]}", "where it closes, at the angle 0; let its slope after one turn"),
    ('"40 mm + 2 mm*x*(2*pi - x)"', "has a corner of 34.9 deg where it closes"),
    ('"10 mm + 30 mm*cos(x)"', "crosses itself there: its distance from the origin is -"),
    ('"40 mm*abs(sin(x))"', "its distance from the origin is 0 m at x = 0 rad"),
    ('"40 mm + 5 mm*abs(cos(x))"', "has a corner of 14.3 deg at x = 1.5708 rad (90 deg)"),
    ('"if(x > 1, if(x > 4, 40 mm, 43 mm), 40 mm)"', "jumps at x = 1 rad (57.296 deg), from 0.04 m to 0.043 m"),
    ("{points: [[0, 40 mm], [2, 45 mm], [360 deg, 40 mm]], interpolation: linear, ends: periodic}", "has a corner of "),
]
# Over x.
ALONG = [
    ('"0.5*abs(x - 30 mm)"', "has a corner of 53.1 deg at x = 0.03 m"),
    ('"max(0, (x - 0.2 m)/4)"', "has a corner of 14 deg at x = 0.2 m"),
    ('"if(x > -0.7 m, 0.1*x, 0.1*x + 1 mm)"', "jumps at x = -0.7 m, from -0.069 m to -0.07 m"),
    ("{points: [[-0.1, 0], [0, 0.01], [0.1, 0]], interpolation: linear}", "points: 'interpolation: cubic'"),
]


class CurvesThatAreNone(ModelTest):
    def test_curves_around_an_origin(self):
        for curve, says in ROUND:
            for block in ("", LIFT):
                with self.subTest(curve + block):
                    found, = self.refusal(CAM % (curve + block), id="bad-curve", line=8, column=PLACE)
                    self.assertIn(says, found["message"])

    def test_curves_over_x(self):
        for curve, says in ALONG:
            for block in ("", LIFT):
                with self.subTest(curve + block):
                    found, = self.refusal(GROOVE % (curve + block), id="bad-curve", line=5)
                    self.assertIn(says, found["message"])

    def test_by_how_much_a_curve_misses_itself_is_the_difference(self):
        # Of 9 mm to the angle of a turn and a bit that closes but for it.
        for miss in (1e-3, 1e-6, 2e-8):
            found, = self.refusal(CAM % ('"40 mm + 9 mm*sin(x)^2 + %r m*x/(2*pi)"' % miss), id="bad-curve")
            self.assertIn(", %.6g m apart" % miss, found["message"])

    def test_curves_that_are_good_stay(self):
        good = ['"40 mm + 3 mm*cos(2*x)"', "40 mm", '"40 mm + 5 mm*max(0, 1 - ((x - pi)/1.5)^2)^3"', '"40 mm + 3 mm*smooth(x, 1, 2) - 3 mm*smooth(x, 4, 5)"',
                '"40 mm + 3 mm*(trapezoid(x, 0.5, 2.5, 0.7) - s_curve(x, 3.5, 5.5, 0.7))"', "{points: [[0, 40 mm], [90 deg, 45 mm], [180 deg, 40 mm]], ends: periodic}",
                '"if(x < pi, 40 mm + 3 mm*sin(x)^2, 40 mm + 2 mm*sin(x)^2)"', "{arcs: [[0, 0, 20 mm], [30 mm, 0, 8 mm]], roller: 10 mm}"]
        for curve in good:
            with self.subTest(curve):
                self.freeplay("validate", self.model(CAM % curve))
        for curve in ('"x^2/(1 m)"', '"sqrt(0.04 m^2 - x^2)"', '"0.1*x*abs(x)/(1 m)"', "{arcs: [[-0.1, 0], [0, 0, -30 mm], [0.1, 0]]}"):
            with self.subTest(curve):
                self.freeplay("validate", self.model((GROOVE % curve).replace("bead: {", "bead: {pose: {position: [0.01, 0]}, ")))

    def test_a_curve_without_a_value_says_where(self):
        found, = self.refusal(CAM % '"40 mm*sqrt(x - 1)"', line=8)
        self.assertIn("square root of a negative number", found["message"])
        self.assertTrue(math.isfinite(found["column"]))


if __name__ == "__main__":
    unittest.main()
