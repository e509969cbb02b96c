"""A follower that may leave its cam: flight, impact and contact against formulas."""
import csv
import math
import unittest

from model_cases import EXACT, ModelTest

# A block of 2 kg that falls along y onto a curve of the ground.
FALL = """
gravity: [0, -9.81]
bodies:
  ground: {frames: {rail: {position: [0.3 m, 0], angle: 90 deg}, curve: {position: [0.1 m, 0.2 m], angle: %s}}}
  block: {mass: 2, inertia: 1, frames: {rail: {angle: 90 deg}}, pose: {position: [0.3 m, %s]}}
joints:
  guide: {type: prismatic, between: [ground/rail, block/rail]}
  c: {type: point-on-curve, between: [ground/curve, block], curve: %s,
      lift_off: {contact: {law: kelvin-voigt, K: 2e5, D: 0}}}
%s
simulation: {end: %s, output: {interval: 1 ms}, %s}
"""
CAM = """
gravity: [0, -9.81]
bodies:
  ground: {frames: {rail: {angle: 90 deg}}}
  cam: {mass: 1, inertia: 0.01}
  ram: {mass: 0.5, inertia: 0.001, frames: {rail: {angle: 90 deg}}, pose: {position: [0, 40 mm]}}
joints:
  shaft: {type: revolute, between: [ground, cam]}
  guide: {type: prismatic, between: [ground/rail, ram/rail]}
  c: {type: point-on-curve, form: polar, between: [cam, ram], curve: %s, lift_off: {%scontact: {law: kelvin-voigt, K: 1e8, D: 500}}}
drivers: {motor: {joint: shaft, kind: angle, value: %s}}
simulation: {end: %s, output: {interval: 1 ms}, %s}
"""


class LiftOff(ModelTest):
    def events(self):
        with open(self.path("out", "events.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_a_block_bounces_on_a_slanting_curve_as_a_spring_across_it_lets_it(self):
        # On a slope of 30 deg, however it is written, the spring across it pushes along the guide with K cos^2(30 deg).
        slope = math.radians(30)
        omega = math.sqrt(2e5 * math.cos(slope) ** 2 / 2)
        for angle, curve in (("30 deg", "0*x"), ("0", '"x*tan(30 deg)"'), ("10 deg", '"x*tan(20 deg)"')):
            text = FALL % (angle, "0.2 m", curve, "initial: {speeds: {guide: 1}}", "0.25 s", EXACT)
            columns = self.run_model(text)
            # Thrown up at 1 m/s from the curve; back after 2/g; the touch is half a swing about the place of rest.
            ground = columns["body.block.y"][0]
            back, sag = 2 / 9.81, 9.81 / omega ** 2
            self.assertAlmostEqual(0.2 + 0.2 * math.tan(slope), ground, delta=1e-9)
            phase = math.atan2(1 / omega, sag)
            size = math.hypot(sag, 1 / omega)

            def place(t):
                if t <= back:
                    return ground + t - 9.81 * t * t / 2
                return ground - sag + size * math.cos(omega * (t - back) + phase)
            touch = 2 * (math.pi - phase) / omega
            for t, y in zip(columns["time"], columns["body.block.y"]):
                if t < back + touch:
                    self.assertAlmostEqual(place(t), y, delta=1e-8)
            self.assertLess(max(map(abs, columns["energy.residual"])), 1e-8)
            times = [float(event["time"]) for event in self.events()]
            self.assertAlmostEqual(back, times[0], delta=1e-9)
            self.assertAlmostEqual(back + touch, times[1], delta=1e-8)

    def test_a_follower_leaves_a_fast_cam_where_its_acceleration_is_that_of_the_fall(self):
        # y = 40 mm + 5 mm cos(3 psi) at psi = 90 deg - angle: y'' = -9.81 ends the touch.
        w, rise = 25.0, 5e-3
        columns = self.run_model(CAM % ('"40 mm + 5 mm*cos(3*x)"', "", "25 rad/s*t", "70 ms", "accuracy: 1 nm"))
        y = lambda t: 0.04 + rise * math.cos(3 * (math.pi / 2 - w * t))
        v = lambda t: 3 * w * rise * math.sin(3 * (math.pi / 2 - w * t))
        first = next(float(event["time"]) for event in self.events() if event["kind"] == "contact_end"
                     and float(event["time"]) > 0.01)
        # cos(3 psi) = g/(9 w^2 rise), on the way up
        steep = math.acos(9.81 / (9 * w * w * rise))
        away = min(t for k in range(9) for side in (steep, -steep)
                   for t in [(math.pi / 2 - (side - 2 * math.pi * k) / 3) / w] if v(t) > 0 and t > 0.01)
        self.assertAlmostEqual(away, first, delta=2e-5)
        fall = lambda t: y(away) + v(away) * (t - away) - 9.81 * (t - away) ** 2 / 2
        flown = 0
        for k, t in enumerate(columns["time"]):
            if t < away - 1e-3:
                self.assertAlmostEqual(y(t), columns["body.ram.y"][k], delta=2e-6)
            elif away < t and fall(t) > y(t) + 1e-5:
                self.assertAlmostEqual(fall(t), columns["body.ram.y"][k], delta=2e-6)
                flown += 1
            elif away + 5e-3 < t:
                break
        self.assertGreater(flown, 5)

    def test_a_slow_follower_rests_on_its_cam_as_the_ideal_one_does(self):
        text = CAM % ('"40 mm + 2 mm*cos(x)"', "", "5 rad/s*t + 0.3 rad", "0.4 s", "accuracy: 1 nm")
        columns = self.run_model(text)
        ideal = self.run_model(text, "--ideal", "c")
        for k, t in enumerate(columns["time"]):
            self.assertAlmostEqual(ideal["body.ram.y"][k], columns["body.ram.y"][k], delta=1e-6)
            if t > 0.05:
                self.assertAlmostEqual(ideal["joint.c.normal_force"][k], columns["joint.c.fn"][k], delta=0.05)

    def test_a_ring_holds_a_point_inside(self):
        # The ring turns; the ram hangs under gravity on the inner side of its lower part.
        text = CAM % ('"40 mm + 2 mm*cos(2*x)"', "side: inside, ", "3 rad/s*t", "0.3 s", "accuracy: 1 nm")
        text = text.replace("[0, 40 mm]", "[0, -38 mm]")
        columns = self.run_model(text)
        for t, y in zip(columns["time"], columns["body.ram.y"]):
            self.assertAlmostEqual(-0.04 - 0.002 * math.cos(2 * (-math.pi / 2 - 3 * t)), y, delta=1e-6)

    def test_what_no_lift_off_can_be_is_refused_where_it_stands(self):
        text = CAM % ('"40 mm"', "%s", "t", "0.1 s", "accuracy: 1 nm")
        self.refusal(text % "side: outsde, ", id="wrong-type", line=11)
        self.refusal(text % "reach: 0, ", id="out-of-range", line=11)
        self.refusal(text.replace("contact:", "contct:") % "", line=11)


if __name__ == "__main__":
    unittest.main()
