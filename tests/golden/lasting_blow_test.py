"""A blow after which a journal stays in its bearing counts as an impact where steps of one size do not resolve it."""
import json
import unittest

from program import ProgramTest

# A weight that falls by a fifth of the play and then swings about its rest, by less than that in which its load presses.
MODEL = """freeplay: 1
bodies: {weight: {mass: 1, inertia: 1e-3}}
forces: {load: {type: force, at: weight, value: [0, -400 N]}}
joints:
  j: {type: revolute, between: [ground, weight], clearance: {bearing_radius: 20 mm, radial_clearance: 0.1 mm,
      initial: {eccentricity: [0, -80 um]}, contact: {law: expression, force: "1e7 N/m*delta + 1e3 N*s/m*rate"}}}
simulation: {end: 0.02, step: 1e-5}
"""


class LastingBlow(ProgramTest):
    def reasons(self, *more):
        self.freeplay("run", self.write("m.yaml", MODEL), "--out", "r", "--force", *more)
        return [(r["id"], r["element"]) for r in json.loads(self.read("r", "summary.json"))["trust"]["reasons"]]

    def test_a_blow_of_few_steps_is_doubted(self):
        self.assertIn(("impact-steps", "joint 'j'"), self.reasons("--step", "0.3 ms", "--interval", "0.3 ms"))

    def test_a_blow_of_many_steps_is_not(self):
        self.assertEqual([], self.reasons())
        self.assertEqual([], self.reasons("--accuracy", "10 nm"))

    # Where it begins, an impact counts of which the program prints no number of steps.
    def test_the_contact_has_no_end(self):
        self.assertNotIn("steps per impact", self.freeplay("run", self.write("m.yaml", MODEL), "--out", "r", "--force")[0])



if __name__ == "__main__":
    unittest.main()
