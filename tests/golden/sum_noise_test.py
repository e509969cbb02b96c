"""Ways of sliding of loose joints have the digits that another accuracy leaves."""
import re
import unittest

from program import ProgramTest

# A crank-rocker whose rocker pulls a tray on rails; its pin and that of the tray have play and hardly ever leave their bearings.
TRAY = """freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {D: [0.4, 0], rail: [0, 0.2]}}
  crank: {mass: 0.3, inertia: 4e-4, com: [0.05, 0], frames: {tip: [0.1, 0]}}
  coupler: {mass: 0.8, inertia: 6.5e-3, com: [0.15, 0], frames: {tip: [0.3, 0]}, pose: {position: [0.05, 0.087], angle: 29 deg}}
  rocker: {mass: 0.9, inertia: 8e-3, com: [0.15, 0], frames: {pin: [0.25, 0], ear: [0.32, 0]}, pose: {position: [0.4, 0], angle: 111 deg}}
  link: {mass: 0.6, inertia: 6.2e-3, com: [0.175, 0], frames: {far: [0.35, 0]}, pose: {position: [0.286, 0.299], angle: -16 deg}}
  tray: {mass: 3.0, inertia: 1.5e-2, pose: {position: [0.62, 0.2]}}
presets: {loose: {bearing_radius: 0.01, radial_clearance: 0.2 mm, material: {E: 207 GPa, nu: 0.3}, contact: {law: hu-guo, restitution: 0.8}}}
joints:
  A: {type: revolute, between: [ground, crank]}
  B: {type: revolute, between: [crank/tip, coupler]}
  C: {type: revolute, bearing: rocker/pin, journal: coupler/tip, clearance: {use: loose}}
  D: {type: revolute, between: [ground/D, rocker]}
  E: {type: revolute, between: [rocker/ear, link]}
  W: {type: revolute, bearing: link/far, journal: tray, clearance: {use: loose}}
  rail: {type: prismatic, between: [ground/rail, tray]}
drivers: {motor: {joint: A, kind: velocity, value: 30}}
initial: {joints: {A: 60 deg}}
simulation: {end: 0.5, accuracy: 1 um, output: {interval: 0.5 ms}}
"""


class SumNoise(ProgramTest):
    def test_ways_of_other_accuracies_lie_within_their_noise(self):
        self.write("m.yaml", TRAY)
        ways = {"C": [], "W": []}
        for accuracy in ("2 um", "1.5 um", "1 um", "0.7 um", "0.5 um"):
            out, _ = self.freeplay("run", "m.yaml", "--accuracy", accuracy, "--out", "r", "--force")
            for joint, seen in ways.items():
                way, noise = re.search(r"^  %s( +\S+ \+- \S+ %%){3} +\S+ \+- \S+ +(\S+) \+- (\S+) mm" % joint, out, re.M).groups()[1:]
                seen.append((float(way), float(noise)))
        for joint, seen in ways.items():
            for i, (way, noise) in enumerate(seen):
                for other, of_other in seen[:i]:
                    self.assertLessEqual(abs(way - other), 1.5 * (noise + of_other), (joint, seen))
                self.assertLess(noise, 0.5 * way, (joint, seen))


if __name__ == "__main__":
    unittest.main()
