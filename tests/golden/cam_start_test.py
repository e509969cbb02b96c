"""Where a cam starts whose angle the file does not give: from the place of its follower."""
import json
import math
import unittest

from program import ProgramTest

CAM = """freeplay: 1
gravity: [0, -9.81]
bodies:
  cam: {mass: 1, inertia: 1e-3}
  follower: {mass: 0.3, inertia: 1e-4, frames: {v: {angle: 90 deg}}, pose: {position: [0, %s]}}
frames: {ground/v: {angle: 90 deg}}
joints:
  O: {type: revolute, between: [ground, cam]}
  G: {type: prismatic, between: [ground/v, follower/v]}
  C: {type: point-on-curve, form: polar, between: [cam, follower], curve: "%s"%s}
drivers: {m: {joint: O, kind: velocity, value: 300 rpm}}
simulation: {end: 0.1, accuracy: 1 um}
"""
ECCENTRIC, DWELL = "40 mm + 6 mm*(1 - cos(x))", "40 mm + 6 mm*max(0, -cos(x))^3"
LIFT_OFF = ", lift_off: {contact: {law: hertz, K: 1e9}}"


class CamStart(ProgramTest):
    def start(self, place, curve, more=""):
        text = self.write("m.yaml", CAM % (place, curve, more))
        out = json.loads(self.freeplay("validate", text, "--json")[0])
        return out["start"]["cam"]["angle"], [m["message"] for m in out["messages"]]

    def test_the_lowest_and_the_highest_place_are_one_start_each(self):
        """Newton's method comes to a double root from both sides, and counts whole turns on its way."""
        for place, curve, top in (("40 mm", ECCENTRIC, math.pi / 2), ("52 mm", ECCENTRIC, -math.pi / 2), ("46 mm", DWELL, -math.pi / 2)):
            for more in ("", LIFT_OFF):
                with self.subTest((place, curve, more)):
                    angle, messages = self.start(place, curve, more)
                    self.assertEqual([], messages)
                    self.assertLess(abs(math.remainder(angle - top, 2 * math.pi)), 3e-3)

    def test_the_start_is_within_a_turn_where_the_curve_has_no_slope(self):
        """There a small way of the follower asks for any number of turns of the cam: 1e13 rad leave an angle without digits."""
        for place in ("40 mm", "40.0001 mm", "41 mm", "48 mm"):
            for more in ("", LIFT_OFF):
                with self.subTest((place, more)):
                    self.assertLess(abs(self.start(place, "40 mm + 8 mm*(1 - cos(2*x))/2", more)[0]), 2 * math.pi)

    def test_a_dwell_is_one_start(self):
        angle, messages = self.start("40 mm", DWELL)
        self.assertEqual([], messages)
        self.assertGreater(math.sin(angle), -1e-2)

    def test_flanks_on_both_sides_of_where_it_stands_are_two(self):
        _, messages = self.start("43 mm", ECCENTRIC.replace("x", "x - pi/2"))
        self.assertEqual(1, len(messages))
        self.assertIn("two positions are equally near to what the file gives: body 'cam' at", messages[0])


if __name__ == "__main__":
    unittest.main()
