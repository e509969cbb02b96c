"""Laws that divide their damping by the speed of approach, where a contact begins with next to none and is pressed on."""
import json
import unittest

from program import ProgramTest

BOB = """freeplay: 1
bodies: {bob: {mass: 1, inertia: 1e-3, com: [0, -0.1]}}
joints:
  pin:
    type: revolute
    bearing: ground
    journal: bob
    clearance:
      bearing_radius: 10 mm
      radial_clearance: 0.1 mm
      contact: {law: hu-guo, restitution: 0.5, K: 1e9}
      initial: {eccentricity: [0, -0.0999999 mm], velocity: [0, -1 um/s]}
forces: {load: {type: force, at: bob, value: [0, "-1000 N*smooth(t, 5 ms, 0.1)"]}}
simulation: {end: 0.1, step: 2 us}
"""


class LawOfImpact(ProgramTest):
    def reasons(self, text, *options):
        self.freeplay("run", self.write("m.yaml", text), *options, "--out", "r", "--force")
        return [r for r in json.loads(self.read("r", "summary.json"))["trust"]["reasons"] if "presses hardest" in r["message"]]

    def test_a_contact_that_hardly_approached_is_doubted(self):
        (reason,) = self.reasons(BOB)
        self.assertEqual(("law-range", "doubtful", "joint 'pin'"), (reason["id"], reason["level"], reason["element"]))
        self.assertGreater(reason["value"], 8)

    def test_one_before_a_harder_blow_is_doubted(self):
        blow = BOB.replace('smooth(t, 5 ms, 0.1)"', 'smooth(t, 5 ms, 0.1) + 1500 N*smooth(t, 0.1, 0.1001)"').replace("end: 0.1,", "end: 0.103,")
        (reason,) = self.reasons(blow)
        self.assertGreater(reason["value"], 8)

    def test_a_blow_and_a_law_without_loss_are_not(self):
        for text in (BOB.replace("-1 um/s", "-0.1 m/s"), BOB.replace("law: hu-guo, restitution: 0.5", "law: hertz"),
                     BOB.replace("law: hu-guo, restitution: 0.5, K: 1e9", "law: kelvin-voigt, K: 1e8, D: 2e4").replace("-1 um/s", "-0.5 m/s")):
            with self.subTest(text):
                self.assertEqual([], self.reasons(text))


if __name__ == "__main__":
    unittest.main()
