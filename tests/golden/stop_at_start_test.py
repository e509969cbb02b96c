"""Stop conditions that hold before a run begins are doubted."""
import unittest

from model_cases import VerdictTest


class StopAtStart(VerdictTest):
    SWINGS = """freeplay: 1
gravity: [0, -9.81]
bodies: {rod: {mass: 1 kg, inertia: 0.02, com: [0.3, 0]}}
joints: {p: {type: revolute, between: [ground, rod]}}
initial: {joints: {p: -60 deg}}
simulation: {end: 1 s, %s, stop: [{channel: joint.p.angle, %s}]}
"""

    def test_a_condition_that_holds_at_the_start_is_doubtful(self):
        for steps in ("accuracy: 1 um", "step: 1 ms"):
            for condition, meant in (("below: 100 deg", "above"), ("above: -100 deg", "below")):
                with self.subTest(steps=steps, condition=condition):
                    self.run_model(self.SWINGS % (steps, condition))
                    self.assertIn(", as it was at the start", self.summary["stop_reason"])
                    reason, = self.trust["reasons"]
                    self.assertEqual(["statistics-window", "joint.p.angle"], [reason["id"], reason["element"]])
                    self.assertIn("at the start already: is '%s' meant?" % meant, reason["message"])
            for condition in ("below: -100 deg", "below: 100 deg, after: 0.5 s"):
                self.run_model(self.SWINGS % (steps, condition))
                self.assertEqual(["stopped", []], [self.summary["status"], self.ids()], condition)
            # In the first of ten steps, but not at the start.
            self.run_model(self.SWINGS % (steps, "below: -60.0001 deg"))
            self.assertNotIn("at the start", self.summary["stop_reason"])


if __name__ == "__main__":
    unittest.main()
