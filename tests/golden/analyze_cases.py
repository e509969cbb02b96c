"""What tests of `freeplay analyze` share."""
import csv
import io

from program import ProgramTest, mechanism

FOUR_BAR = """freeplay: 1
bodies:
  ground: {frames: {A: [0, 0], D: [0.4, 0]}}
  crank: {mass: 0.3, inertia: 1e-3, com: [0.05, 0], frames: {tip: [0.1, 0]}}
  coupler: {mass: 0.9, inertia: 6.75e-3, com: [0.15, 0], frames: {tip: [0.3, 0], P: [0.15, 0.08]}, pose: {angle: 30 deg}}
  rocker: {mass: 0.8, inertia: 4.5e-3, com: [0.125, 0], frames: {tip: [0.25, 0]}, pose: {angle: 80 deg}}
joints:
  A: {type: revolute, between: [ground/A, crank]}
  B: {type: revolute, between: [crank/tip, coupler]}
  C: {type: revolute, between: [coupler/tip, rocker/tip]}
  D: {type: revolute, between: [ground/D, rocker]}
drivers: {motor: {joint: A, kind: velocity, value: 60 rpm}}
initial: {joints: {A: 60 deg}}
simulation: {end: 1 s, step: 1 ms}
"""
KINDS = ("ik", "workspace", "singularity", "error", "inverse-dynamics")


class AnalyzeTest(ProgramTest):
    def rows(self, *words, **options):
        out, _ = self.freeplay("analyze", *words, **options)
        return list(csv.DictReader(io.StringIO(out)))

    @staticmethod
    def text(name):
        with open(mechanism(name), encoding="utf-8") as file:
            return file.read()

    def message(self, *words, code):
        out, err = self.freeplay("analyze", *words, code=code)
        self.assertEqual("", out)
        return err
