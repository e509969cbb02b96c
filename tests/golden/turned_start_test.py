"""A guide turns a body whose pose gives no angle: its frames are then elsewhere than they may have been meant, and the start says so."""
import json
import unittest

from program import ProgramTest

BOX = """freeplay: 1
gravity: [0, -9.81]
bodies:
  box: {mass: 2, inertia: 0.1, frames: {hook: [0.2, 0]%s}%s}
frames: {ground/v: {angle: 90 deg}}
joints: {G: {type: prismatic, between: [ground/v, %s]}}
forces: {f: {type: force, at: %s, value: [0, 30]}}
simulation: {end: 1, accuracy: 1 um}
"""
SPATIAL = """freeplay: 1
space: spatial
bodies:
  box: {mass: 2, inertia: [0.1, 0.1, 0.1], frames: {hook: [0.2, 0, 0]}, pose: {position: [0, 0, 0.1]}}
frames: {ground/v: {rpy: [0, 0, %s]}}
joints: {G: {type: %s, between: [ground/v, box]}}
forces: {f: {type: force, at: box/hook, value: [0, 30, 0]}}
simulation: {end: 1, accuracy: 1 um}
"""
PLACE = ", pose: {position: [0, 0.1]}"
SENTENCE = "body 'box' starts turned by 90 deg with all its frames, as joint 'G' holds it: its `pose` gives a position alone"


class TurnedStart(ProgramTest):
    def moved(self, text):
        out, _ = self.freeplay("validate", self.write("m.yaml", text), "--json")
        return [one for one in json.loads(out)["start_changes"]["moved"] if one["quantity"] == "turn"]

    def test_a_turn_that_the_pose_does_not_give_is_listed(self):
        one, = self.moved(BOX % ("", PLACE, "box", "box/hook"))
        self.assertEqual(("box", "rad", False), (one["body"], one["unit"], one["far"]))
        self.assertAlmostEqual(1.5707963267948966, one["by"], places=9)
        for command in (("validate",), ("run", "--out", "r", "--force")):
            self.assertIn(SENTENCE, self.freeplay(command[0], "m.yaml", *command[1:])[0])
        self.assertEqual(1, len(self.moved(SPATIAL % ("90 deg", "prismatic"))))
        self.assertEqual(1, len(self.moved(SPATIAL % ("90 deg", "fixed"))))

    def test_what_is_given_or_cannot_be_seen_is_not(self):
        for text in (BOX % ("", ", pose: {position: [0, 0.1], angle: 90 deg}", "box", "box/hook"),
                     BOX % ("", "", "box", "box/hook"),  # without a pose nothing says where it was meant to be
                     BOX % (", v: {angle: 90 deg}", PLACE, "box/v", "box/hook"),
                     (BOX % ("", PLACE, "box", "box")).replace("hook: [0.2, 0]", ""),
                     BOX.replace("90 deg", "30 deg") % ("", PLACE, "box", "box/hook"),
                     SPATIAL % ("20 deg", "prismatic"),
                     SPATIAL % ("90 deg", "cylindrical")):
            with self.subTest(text):
                self.assertEqual([], self.moved(text))


if __name__ == "__main__":
    unittest.main()
