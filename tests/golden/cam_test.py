"""Points on curves: cams lift and press as the closed form of their polynomial says."""
import json
import math
import unittest

from model_cases import EXACT, ModelTest


class Cams(ModelTest):
    R, H, W = 0.04, 0.012, 30.0
    TEXT = """
gravity: [0, -9.81]
bodies: {cam: {mass: 1, inertia: 0.002}, follower: {mass: 0.5 kg, inertia: 1}}
frames: {ground/up: {angle: 90 deg}, follower/up: {angle: 90 deg}}
joints:
  shaft: {type: revolute, between: [ground, cam]}
  guide: {type: prismatic, between: [ground/up, follower/up]}
  cam: {type: point-on-curve, form: polar, between: [cam, follower], curve: %s}
drivers: {motor: {joint: shaft, kind: velocity, value: 30 rad/s}}
initial: {joints: {shaft: 0}}
simulation: {end: 0.25, output: {interval: 1 ms, channels: ["*", "body.*.ay"]}, %s}
"""

    def lift(self, angle):
        """Rise and fall by the polynomial of degrees 3, 4 and 5 over half a turn each; its two derivatives by the angle."""
        angle %= 2 * math.pi
        sign = 1 if angle < math.pi else -1
        u = 1 - abs(angle - math.pi) / math.pi
        k = sign / math.pi
        return (self.R + self.H * (10 * u ** 3 - 15 * u ** 4 + 6 * u ** 5), self.H * (30 * u ** 2 - 60 * u ** 3 + 30 * u ** 4) * k,
                self.H * (60 * u - 180 * u ** 2 + 120 * u ** 3) * k * k)

    def test_lift_speed_acceleration_and_force_of_a_polynomial_cam(self):
        u = "(1 - abs(x - pi)/pi)"
        curve = '"40 mm + 12 mm*(10*%s^3 - 15*%s^4 + 6*%s^5)"' % (u, u, u)
        columns = self.run_model(self.TEXT % (curve, EXACT))
        seen = 0
        for row, t in enumerate(columns["time"]):
            angle = math.pi / 2 - self.W * t
            if abs(math.sin(angle)) < 4e-3:  # the third derivative jumps at both dwells
                continue
            seen += 1
            f, slope, bend = self.lift(angle)
            self.assertAlmostEqual(f, columns["body.follower.y"][row], delta=1e-9 * self.R)
            self.assertAlmostEqual(-slope * self.W, columns["body.follower.vy"][row], delta=1e-9)
            acceleration = bend * self.W ** 2
            self.assertAlmostEqual(acceleration, columns["body.follower.ay"][row], delta=1e-9 * 10)
            force = 0.5 * (acceleration + 9.81) * math.hypot(1, slope / f)
            self.assertAlmostEqual(force, columns["joint.cam.normal_force"][row], delta=1e-8)
            self.assertAlmostEqual(0.5 * (acceleration + 9.81) * -slope, columns["driver.motor.torque"][row], delta=1e-8)
        self.assertGreater(seen, 240)

    def test_a_fine_ripple_of_a_cam_presses_by_its_curvature(self):
        for waves, height in ((200, 50e-6), (2000, 0.5e-6), (10000, 0.02e-6)):
            columns = self.run_model(self.TEXT.replace("30 rad/s", "1 rad/s").replace("end: 0.25", "end: 0.1")
                                     .replace("mass: 0.5 kg", "pose: {position: [0, 40 mm]}, mass: 0.5 kg")
                                     .replace("gravity: [0, -9.81]", "gravity: [0, 0]").replace("interval: 1 ms", "interval: 0.4 ms")
                                     % ('"40 mm + %r m*sin(%d*x)"' % (height, waves), "accuracy: 1 nm"))
            for row, t in enumerate(columns["time"]):
                wave = -height * waves ** 2 * math.sin(waves * (math.pi / 2 - t))
                self.assertAlmostEqual(wave, columns["body.follower.ay"][row], delta=1e-6 * height * waves ** 2)

    def test_periodic_points_make_a_closed_curve_through_them(self):
        angles = [i * 45 for i in range(9)]
        heights = [40, 41, 45, 50, 52, 50, 46, 42, 40]
        points = ", ".join("[%d deg, %d mm]" % pair for pair in zip(angles, heights))
        columns = self.run_model((self.TEXT % ("{points: [%s], ends: periodic}" % points, EXACT))
                                 .replace("interval: 1 ms", "interval: %r" % (math.pi / 4 / self.W)))
        for row, t in enumerate(columns["time"][:-1]):
            place = (2 - row) % 8
            self.assertAlmostEqual(heights[place] / 1000, columns["body.follower.y"][row], delta=1e-9)
        self.assertLess(max(map(abs, columns["energy.residual"])), 1e-5)

    def test_points_between_which_the_curve_dips_in_a_dwell_are_doubted(self):
        for step, said in ((60, True), (20, False)):
            points = ["[%d deg, %r mm]" % (x, 40 + (0.0 if abs(x - 180) > 60 else 5 * (1 + math.cos(math.radians(x - 180) * 3))))
                      for x in range(0, 361, step)]
            text = self.TEXT % ("{points: [%s], ends: periodic}" % ", ".join(points), "accuracy: 1 um")
            found = json.loads(self.freeplay("validate", self.model(text), "--json")[0])["messages"]
            found = [m for m in found if "cubic" in m["message"]]
            self.assertEqual(said, bool(found), found)
            if said:
                self.assertEqual(("doubtful-value", 9), (found[0]["id"], found[0]["line"]))
                self.assertIn("the two points beside it are 0.04 and 0.04: give more points", found[0]["message"])

    def test_a_bead_on_a_wave_keeps_its_energy(self):
        columns = self.run_model("""
gravity: [0, -9.81]
bodies: {frame: {mass: 1, inertia: 0.05}, bead: {mass: 0.3, inertia: 1e-4}}
joints:
  pin: {type: revolute, between: [ground, frame]}
  groove: {type: point-on-curve, between: [frame, bead], curve: "20 mm*sin(2*pi*x/(0.2 m))"}
initial: {speeds: {pin: 3 rad/s}}
simulation: {end: 1, output: {interval: 10 ms}, %s}
""" % EXACT)
        self.assertLess(max(map(abs, columns["energy.residual"])), 1e-8)
        for row in range(len(columns["time"])):
            angle, x, y = (columns[name][row] for name in ("body.frame.angle", "body.bead.x", "body.bead.y"))
            c, s = math.cos(angle), math.sin(angle)
            self.assertAlmostEqual(0.02 * math.sin(2 * math.pi * (c * x + s * y) / 0.2), c * y - s * x, delta=1e-9)


if __name__ == "__main__":
    unittest.main()
