"""Cams and grooves of arcs and their common tangents: lift, speed and acceleration by closed forms; curves that are none."""
import math
import unittest

from model_cases import ModelTest

EXACT = "accuracy: 1 um"  # the motion is known

BODIES = """
bodies: {cam: {mass: 1, inertia: 0.002}, follower: {mass: 0.5 kg, inertia: 1, pose: {position: [0, 0.04], angle: 0}}}
frames: {ground/up: {angle: 90 deg}, follower/up: {angle: 90 deg}}
"""
TURNING = BODIES + """
joints:
  shaft: {type: revolute, between: [ground, cam]}
  guide: {type: prismatic, between: [ground/up, follower/up]}
  cam: {type: point-on-curve, form: polar, between: [cam, follower], curve: %s}
drivers: {motor: {joint: shaft, kind: angle, value: 30*t}}
simulation: {end: 0.25, output: {interval: 1 ms, channels: ["*", "body.*.ay"]}, %s}
"""
SLIDING = BODIES + """
joints:
  rail: {type: prismatic, between: [ground, cam]}
  guide: {type: prismatic, between: [ground/up, follower/up]}
  cam: {type: point-on-curve, between: [cam, follower], curve: %s}
drivers: {motor: {joint: rail, kind: position, value: 0.09*cos(8*t)}}
simulation: {end: 0.4, output: {interval: 1 ms, channels: ["*", "body.*.ay"]}, %s}
"""
W = 30.0


def circle(e, r, angle):
    """Distance of a circle of the radius r about (e, 0), and its two derivatives."""
    c, s = math.cos(angle), math.sin(angle)
    q = math.sqrt(r * r - e * e * s * s)
    dq = -e * e * s * c / q
    return e * c + q, -e * s + dq, -e * c - (e * e * (c * c - s * s) + dq * dq) / q


def line(h, middle, angle):
    """Of a line whose nearest point is at the distance h in the direction `middle`."""
    c, tan = math.cos(angle - middle), math.tan(angle - middle)
    return h / c, h / c * tan, h / c * (1 + 2 * tan * tan)


class CamsOfArcs(ModelTest):
    def assert_cam(self, curve, lift, corners=()):
        """lift(angle) in [-pi, pi], with derivatives; at corners the curvature jumps."""
        columns = self.run_model(TURNING % (curve, EXACT))
        seen = 0
        for row, t in enumerate(columns["time"]):
            angle = math.remainder(math.pi / 2 - W * t, 2 * math.pi)
            if any(abs(abs(angle) - corner) < 1e-9 for corner in corners):
                continue
            seen += 1
            f, slope, bend = lift(angle)
            self.assertAlmostEqual(f, columns["body.follower.y"][row], delta=1e-9 * 0.04)
            self.assertAlmostEqual(-slope * W, columns["body.follower.vy"][row], delta=1e-9)
            self.assertAlmostEqual(bend * W * W, columns["body.follower.ay"][row], delta=1e-9 * 30)
        self.assertGreater(seen, 230)

    def test_an_eccentric_circle_with_a_roller(self):
        e, turned = math.hypot(0.008, 0.003), math.atan2(0.003, 0.008)
        self.assert_cam("{arcs: [[8 mm, 3 mm, 30 mm]], roller: 10 mm}", lambda a: circle(e, 0.04, a - turned))

    def test_a_tangent_cam_with_a_roller(self):
        middle = math.acos((20 - 8) / 30)  # of the flank
        nose = math.atan2(18 * math.sin(middle), 30 + 18 * math.cos(middle))

        def lift(angle):
            a = abs(angle)
            f, slope, bend = circle(0.03, 0.018, a) if a < nose else line(0.03, middle, a) if a < middle else (0.03, 0, 0)
            return f, math.copysign(1, angle) * slope, bend
        self.assert_cam("{arcs: [[0, 0, 20 mm], [30 mm, 0, 8 mm]], roller: 10 mm}", lift, (nose, middle))

    def test_a_stadium(self):
        corner = math.atan2(15, 20)

        def lift(angle):
            a = abs(angle)
            if a < corner:
                f, slope, bend = circle(0.02, 0.015, a)
            elif a < math.pi - corner:
                f, slope, bend = line(0.015, math.pi / 2, a)
            else:
                f, slope, bend = circle(-0.02, 0.015, a)
            return f, math.copysign(1, angle) * slope, bend
        self.assert_cam("{arcs: [[-20 mm, 0, 15 mm], [20 mm, 0, 15 mm]]}", lift, (corner, math.pi - corner))

    def test_circles_that_touch_from_inside_need_no_line_between(self):
        # Flanks of 60 mm radius, which touch the base circle of 20 mm and the nose of 8 mm at (30 mm, 0).
        x = (40 ** 2 + 30 ** 2 - 52 ** 2) / 60.0
        y = math.sqrt(40 ** 2 - x * x)
        arcs = "[[0, 0, 20 mm], [%.17g mm, %.17g mm, 60 mm], [30 mm, 0, 8 mm], [%.17g mm, %.17g mm, 60 mm]]" % (x, y, x, -y)
        e, turned = 0.04, math.atan2(-y, x)  # the centre of the upper flank is below
        base, nose = math.atan2(y, -x), math.atan2(8 * y / 52, 30 + 8 * (30 - x) / 52)

        def lift(angle):
            a = abs(angle)
            f, slope, bend = (circle(0.03, 0.008, a) if a < nose else
                              circle(e, 0.06, a - turned) if a < base else (0.02, 0, 0))
            return f, math.copysign(1, angle) * slope, bend
        self.assert_cam("{arcs: %s}" % arcs, lift, (nose, base))

    def test_a_groove_over_a_bump(self):
        columns = self.run_model(SLIDING % ("{arcs: [[-0.1, 0], [0, 0, -30 mm], [0.1, 0]]}", EXACT))
        sine = 0.3
        tan, corner = sine / math.sqrt(1 - sine * sine), 0.03 * sine
        seen = 0
        for row, t in enumerate(columns["time"]):
            x, v, a = -0.09 * math.cos(8 * t), 0.72 * math.sin(8 * t), 5.76 * math.cos(8 * t)
            if abs(abs(x) - corner) < 1e-9:
                continue
            seen += 1
            side = math.copysign(1, x)
            y, slope, bend = 0.1 * tan - abs(x) * tan, -side * tan, 0.0
            if abs(x) < corner:
                y = math.sqrt(0.03 ** 2 - x * x)
                slope, bend = -x / y, -0.03 ** 2 / y ** 3
            self.assertAlmostEqual(y, columns["body.follower.y"][row], delta=1e-10)
            self.assertAlmostEqual(slope * v, columns["body.follower.vy"][row], delta=1e-9)
            self.assertAlmostEqual(slope * a + bend * v * v, columns["body.follower.ay"][row], delta=1e-8)
        self.assertGreater(seen, 350)

    def test_a_curve_that_is_none_is_refused_at_its_arc(self):
        for arcs, item, says in (
                ("[[30 mm, 0, 20 mm]]", "[30 mm", "does not go round it once: it turns back at (0.01 m,"),
                ("[[0, 0, -20 mm]]", "[0, 0", "crosses itself"),
                ("[[0, 0, 20 mm], [0, 30 mm, 8 mm], [30 mm, 0, 8 mm]]", "[0, 0, 20", "crosses itself"),
                ("[[0, 0, 20 mm], [3 mm, 0, 8 mm]]", "[3 mm", "no common tangent"),
                ("[[0, 0, 20 mm], [30 mm, 0]]", "[30 mm", "a corner has no normal")):
            text = TURNING % ("{arcs: %s}" % arcs, EXACT)
            errors = self.refusal(text, id="bad-curve")
            self.assertIn(says, errors[0]["message"])
            line_text = ("freeplay: 1\n" + text).splitlines()[errors[0]["line"] - 1]
            self.assertTrue(line_text[errors[0]["column"] - 1:].startswith(item), errors[0])
        for arcs, says in (("[[-0.1, 0, 1 mm], [0, 0, -30 mm], [0.1, 0]]", "begins and ends at a point"),
                           ("[[-0.1, 0], [0, 0.2, 30 mm], [-0.05, 0]]", "turns back at")):
            self.assertIn(says, self.refusal(SLIDING % ("{arcs: %s}" % arcs, EXACT), id="bad-curve")[0]["message"])
        fits = "{arcs: [[-60 mm, 0, 10 mm], [60 mm, 0, 10 mm], [0, 60 mm, -50 mm]], roller: 51 mm}"
        self.assertIn("does not fit", self.refusal(TURNING % (fits, EXACT), id="bad-curve")[0]["message"])
        self.refusal(TURNING % ("{arcs: []}", EXACT), id="wrong-length")
        self.refusal(TURNING % ("{arcs: [[0, 0, 0.02]], rollers: 1 mm}", EXACT), id="unknown-key", suggestion="roller")


if __name__ == "__main__":
    unittest.main()
