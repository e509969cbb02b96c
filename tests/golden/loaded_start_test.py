"""Journals that start under their load, of which the file gives no place."""
import unittest

from program import ProgramTest

DOOR = """freeplay: 1
space: spatial
gravity: [0, 0, -9.81]
bodies: {door: {mass: 25 kg, inertia: [8, 10, 2], com: [0.4, 0, 1], frames: {lo: [0, 0, 0.2], hi: [0, 0, 1.8]}}}
frames: {ground/lo: [0, 0, 0.2], ground/hi: [0, 0, 1.8]}
presets: {h: {bearing_radius: 6 mm, radial_clearance: 0.1 mm, length: 40 mm, initial: loaded, contact: {law: hu-guo, K: 1e9, restitution: 0.4}}}
joints:
  lo: {type: revolute, between: [ground/lo, door/lo], clearance: {use: h, axial_clearance: 0.1 mm}}
  hi: {type: revolute, between: [ground/hi, door/hi], clearance: {use: h, axial_clearance: 3 mm}}
simulation: {end: 0.6 s, accuracy: 2 um}
"""


class LoadedStart(ProgramTest):
    def test_a_journal_under_its_load_misses_no_place_that_the_file_gives(self):
        """Two hinges of a door, of which the lower bears its weight alone: the upper one has more play along its axis."""
        out, _ = self.freeplay("run", self.write("m.yaml", DOOR), "--force", "--out", "r", "--end", "1 ms")
        self.assertIn("the journal of joint 'hi' starts 0.003 m from where its load alone would press it: other joints hold it\n", out)
        self.assertNotIn("`clearance.initial` gives", out)


if __name__ == "__main__":
    unittest.main()
