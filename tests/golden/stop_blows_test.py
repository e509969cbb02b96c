"""Blows of stops are judged by how deep and how fast surfaces meet."""
import unittest

from model_cases import VerdictTest


class StopBlows(VerdictTest):
    def test_blows_of_a_stop_are_judged_as_those_in_a_play(self):
        """A firing pin of 10 g meets steel at 6 m/s: 2.9e5 m/s^2, as any blow of hard bodies, and a thousandth of the speed of sound."""
        pin = ("freeplay: 1\nbodies: {pin: {mass: 10 g, inertia: 1e-6 kg*m^2}}\njoints: {g: {type: prismatic, between: [ground, pin]}}\n"
               "forces: {st: {%s}}\ninitial: {speeds: {g: 6 m/s}}\nsimulation: {end: 3 ms, accuracy: 0.1 um}\n")
        self.run_model(pin % "type: joint-stop, between: [ground, pin], lower: -20 mm, upper: 5 mm, contact: {law: hu-guo, K: %s, restitution: 0.6}" % "1.07e10")
        self.assertGreater(self.summary["forces"]["st"]["max_force"], 3e5 * 0.01)
        self.assertEqual([], self.ids(), self.trust)
        self.run_model(pin % "type: joint-stop, between: [ground, pin], lower: -20 mm, upper: 5 mm, contact: {law: hu-guo, K: %s, restitution: 0.6}" % "10")
        self.assertIn("penetration", self.ids(), self.trust)
        # Where no length is given none is named.
        self.run_model(pin % "type: force, at: pin, value: [-1e4 N, 0]")
        self.assertIn("force 'st' of 1e+04 N on 0.01 kg: check its numbers and their units", [r["message"] for r in self.trust["reasons"]])


if __name__ == "__main__":
    unittest.main()
