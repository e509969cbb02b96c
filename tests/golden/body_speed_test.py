"""Bodies faster than machines are make a verdict doubtful, and the motor behind it is named."""
import json
import unittest

from program import ProgramTest

ARM = """freeplay: 1
bodies: {arm: {mass: 1, inertia: 0.01, com: [%s, 0]}}
joints: {axle: {type: revolute, between: [ground, arm]}}
drivers: {motor: {joint: axle, kind: torque, value: 2000}}
simulation: {end: 0.2, accuracy: 1 um}
"""

HOIST = """freeplay: 1
gravity: [0, -9.81]
bodies: {drum: {mass: 120, inertia: 5.4}, cage: {mass: 800, inertia: 100}}
frames: {ground/shaft: {position: [0.3, 0], angle: 90 deg}}
joints:
  axle: {type: revolute, between: [ground, drum]}
  rails: {type: prismatic, between: [ground/shaft, cage]}
  rope: {type: gear, of: [axle, rails], ratio: 0.3 m}
drivers: {motor: {joint: axle, kind: torque, value: %s}}
simulation: {end: 2, accuracy: 1 um}
"""


class BodySpeed(ProgramTest):
    def reasons(self, text):
        self.write("m.yaml", text)
        self.freeplay("run", "m.yaml", "--out", "r", "--force", "--quiet")
        return json.loads(self.read("r", "summary.json"))["trust"]["reasons"]

    def test_what_moves_slides_or_turns_faster_than_in_machines_is_doubted(self):
        for text, element, limit in ((ARM % "0.1", "body 'arm'", 200), (ARM % "0", None, 400), (HOIST % "24 kN*m", "body 'cage'", 100)):
            with self.subTest(element):
                reason = next(r for r in self.reasons(text) if r["id"] == "body-speed")
                self.assertEqual(("doubtful", element, limit), (reason["level"], reason["element"], reason["limit"]))
                self.assertIn("driver 'motor' has put", reason["message"])

    def test_a_hoist_whose_motor_fits_is_not(self):
        self.assertEqual([], self.reasons(HOIST % "2.5 kN*m"))


if __name__ == "__main__":
    unittest.main()
