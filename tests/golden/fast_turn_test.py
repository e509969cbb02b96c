"""Angles are counted over whole turns however far a joint would turn in a step of the asked size."""
import json
import unittest

from model_cases import ModelTest

PAIR = """
bodies: {a: {mass: 1, inertia: 0.01}, b: {mass: 1, inertia: 0.01}}
frames: {ground/far: [0.2, 0]}
joints:
  A: {type: revolute, between: [ground, a]}
  B: {type: revolute, between: [ground/far, b]}
  G: {type: gear, of: [A, B], ratio: -2}
initial: {speeds: {A: %g rad/s}}
simulation: {end: 1 s, step: 10 ms, output: {interval: 10 ms}}
"""


class FastTurns(ModelTest):
    def steps(self):
        return json.loads(self.read("out", "summary.json"))["time"]["smallest_step"]

    def test_a_gear_keeps_its_ratio_though_its_wheels_pass_half_a_turn_in_a_step(self):
        for speed in (300, 7000):  # 3 and 70 rad a step, twice as much of the second wheel
            columns = self.run_model(PAIR % speed)
            self.assert_column(columns, "joint.A.angle", lambda t: speed * t)
            self.assert_column(columns, "joint.B.angle", lambda t: -2 * speed * t)
            self.assertLessEqual(self.steps() * 2 * speed, 2.5)

    def test_a_slower_one_has_the_steps_that_are_asked_for(self):
        columns = self.run_model(PAIR % 100)
        self.assert_column(columns, "joint.B.angle", lambda t: -200 * t)
        self.assertAlmostEqual(0.01, self.steps(), delta=1e-12)


if __name__ == "__main__":
    unittest.main()
