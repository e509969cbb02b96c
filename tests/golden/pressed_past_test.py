"""A loose mechanism that its driver turns past a dead point ends there, though the gap closes again before it is widest."""
import re
import unittest

from program import ProgramTest

# The rocker's axis is y in place of x: the crank can turn from -20 to 26 degrees.
ROCKER = """freeplay: 1
space: spatial
bodies:
  ground: {frames: {rock: [66 mm, 165 mm, 0]}}
  crank: {mass: 0.1, inertia: [2e-5, 4e-5, 5e-5], com: [22 mm, 0, 0], frames: {tip: [44 mm, 0, 0]}}
  rod: {mass: 0.1, inertia: [3e-6, 2e-4, 2e-4], com: [100 mm, 0, 0], frames: {end: [199.518 mm, 0, 0]}, pose: {position: [44 mm, 0, 0], rpy: [0, -33.45 deg, 82.4 deg]}}
  rocker: {mass: 0.2, inertia: [1.1e-4, 1.1e-4, 1e-5], com: [0, 0, 55 mm], frames: {tip: [0, 0, 110 mm]}, pose: {position: [66 mm, 165 mm, 0], rpy: [0, 0, 0]}}
joints:
  main: {type: revolute, between: [ground, crank]}
  b1: {type: spherical, between: [crank/tip, rod]}
  b2: {type: spherical, between: [rod/end, rocker/tip]}
  fulcrum: {type: revolute, bearing: ground/rock, journal: rocker, axis: [0, 1, 0],
    clearance: {bearing_radius: 6 mm, radial_clearance: 0.05 mm, length: 24 mm, axial_clearance: 0.1 mm, material: {E: 207 GPa, nu: 0.3}, contact: {law: flores, restitution: 0.7}}}
drivers: {motor: {joint: main, kind: velocity, value: 120 rpm}}
initial: {joints: {main: 0 deg}}
simulation: {end: 0.5 s, accuracy: 10 um, output: {interval: 1 ms}}
"""


class PressedPast(ProgramTest):
    def test_a_run_ends_where_the_gap_is_first_wider_than_the_play(self):
        self.write("m.yaml", ROCKER)
        _, err = self.freeplay("run", "m.yaml", "--out", "r", "--force", "--quiet", code=4)
        time, limit = re.search(r"t = (\S+) s: driver 'motor' .* joint 'main' comes to a dead point at (\S+) deg", err).groups()
        # 26.41 degrees are passed after 0.0367 s.
        self.assertAlmostEqual(26.41, float(limit), delta=0.01)
        self.assertTrue(0.0367 < float(time) < 0.06, err)


if __name__ == "__main__":
    unittest.main()
