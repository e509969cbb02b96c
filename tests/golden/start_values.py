"""Start values of a model, as `run` and `validate` have them."""
import csv
import io
import json

from program import ProgramTest

RUN = "simulation: {end: 1 ms, step: 1 ms}\n"

BALL = """freeplay: 1
bodies:
  ball: {mass: 1, inertia: 0.1, velocity: {linear: [0.3, -0.1]}}
joints:
  ring:
    type: revolute
    between: [ground, ball]
    clearance: {bearing_radius: 10 mm, radial_clearance: 1 mm, material: {E: 207 GPa, nu: 0.3}, contact: {law: hertz}%s}
simulation: {end: 1 ms, step: 10 us}
"""


class StartTest(ProgramTest):
    def first_row(self, text):
        out, err = self.freeplay("run", self.write("m.yaml", text), "--out", "r", "--force")
        table = list(csv.reader(io.StringIO(self.read("r", "results.csv"))))
        return {name: float(value) for name, value in zip(table[0], table[1])}, out, err

    def start(self, text, *more):
        verdict = json.loads(self.freeplay("validate", self.write("m.yaml", text), "--json", *more)[0])
        self.changes = verdict["start_changes"]
        return verdict["start"], verdict["messages"]
