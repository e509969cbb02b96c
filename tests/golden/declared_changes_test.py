"""What a joint of a plugin declares of its changes in time is held against steps of one size."""
import json
import os
import unittest

from program import BUILD, ProgramTest

LIBRARY = os.path.join(BUILD, "plugins", "tests", "ripple_push.so")
# At rest at the end, where forces of plugins are looked at: nothing of the ripple is seen there.
SLIDE = """freeplay: 1
bodies: {m: {mass: 1, inertia: 1}}
joints: {slide: {type: prismatic, between: [ground, m]}}
forces: {push: {type: ripple-push, between: [ground, m], drag: 1e3, period: PERIOD}}
simulation: {end: 1, SPAN}
"""


class DeclaredChanges(ProgramTest):
    def reasons(self, period, span):
        self.write("m.yaml", SLIDE.replace("PERIOD", period).replace("SPAN", span))
        _, err = self.freeplay("run", "m.yaml", "--out", "r", "--force", "--plugin", LIBRARY)
        found = json.loads(self.read("r", "summary.json"))["trust"]["reasons"]
        return [reason for reason in found if reason["id"] == "unresolved-input"], err

    def test_steps_longer_than_the_changes_that_a_joint_declares_are_doubted(self):
        found, err = self.reasons("0.4 ms", "step: 1 ms")
        self.assertEqual(["force 'push'"], [reason["element"] for reason in found])
        self.assertAlmostEqual(1e-4, found[0]["value"], delta=1e-12)
        self.assertEqual(1e-3, found[0]["limit"])
        self.assertIn("it declares that it changes within 0.0001 s, which the step of 0.001 s goes over", err)
        self.assertIn("for steps of 2.5e-05 s", err)

    def test_rows_end_steps(self):
        self.assertEqual([], self.reasons("8 ms", "step: 10 ms, output: {interval: 1 ms}")[0])

    def test_shorter_steps_and_an_accuracy_are_not_doubted(self):
        self.assertEqual([], self.reasons("8 ms", "step: 1 ms")[0])
        self.assertEqual([], self.reasons("0.4 ms", "accuracy: 1 um")[0])


if __name__ == "__main__":
    unittest.main()
