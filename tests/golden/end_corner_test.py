"""A corner of an input at the very end of a run is not passed: nothing follows it."""
import csv
import json
import unittest

from model_cases import ModelTest

MODEL = """freeplay: 1
bodies: {sled: {mass: 2, inertia: 1}}
joints: {rail: {type: prismatic, between: [ground, sled]}}
drivers: {push: {joint: rail, %s}}
simulation: {end: 0.1 s, output: {interval: 10 ms}}
"""
# Up to 0.1 s the sled goes evenly with 3 m/s; then it stands, at once.
TABLE = "kind: position, table: {file: way.csv, interpolation: linear}"
CUBIC = "kind: position, table: way.csv"
FORMULA = "kind: position, value: 'min(3*t, 0.3)'"
# And a force of 4 N, which ends there: of 0.2 m/s and 10 mm.
LOADS = ("kind: force, value: 'if(t < 0.1 s, 4 N, 0)'", "kind: force, table: {points: [[0, 4], [0.05, 4], [0.1, 4], [0.1001, 0]], interpolation: linear}")
STEPS = (["--step", "1e-3"], ["--accuracy", "1e-6"])


class EndCorner(ModelTest):
    def setUp(self):
        super().setUp()
        self.write("way.csv", "time,x\n" + "".join("%.17g,%.17g\n" % (0.01 * i, 0.03 * i) for i in range(11)))

    def columns(self, text, *options):
        self.freeplay("run", self.write("m.yaml", text), "--out", "out", "--quiet", "--force", *options)
        rows = list(csv.reader(self.read("out", "results.csv").splitlines()))
        return {name: [float(x) for x in values] for name, *values in zip(*rows)}

    def summary(self):
        return json.loads(self.read("out", "summary.json"))

    def test_a_run_that_ends_at_a_jump_of_speed_sees_none(self):
        for driver in (TABLE, CUBIC, FORMULA):
            for steps in STEPS:
                with self.subTest(driver=driver, steps=steps):
                    columns = self.columns(MODEL % driver, *steps)
                    self.assert_column(columns, "body.sled.x", lambda t: 3 * t, 1e-11)
                    self.assert_column(columns, "body.sled.vx", lambda t: 3.0, 1e-9)
                    self.assert_column(columns, "driver.push.force", lambda t: 0.0, 1e-6)
                    self.assertEqual("good", self.summary()["trust"]["verdict"], self.summary()["trust"])

    def test_a_run_that_ends_where_a_load_ends_has_it_to_its_end(self):
        for driver in LOADS:
            for steps in STEPS:
                with self.subTest(driver=driver, steps=steps):
                    columns = self.columns(MODEL % driver, *steps)
                    self.assert_column(columns, "body.sled.x", lambda t: t * t, 1e-9)
                    self.assert_column(columns, "driver.push.force", lambda t: 4.0, 1e-9)

    def test_a_run_that_goes_on_from_there_is_the_uninterrupted_one(self):
        for driver in (TABLE, FORMULA, LOADS[0]):
            for steps in STEPS:
                with self.subTest(driver=driver, steps=steps):
                    self.write("m.yaml", MODEL % driver)
                    for out, end in (("whole", "0.2 s"), ("part", "0.1 s")):
                        self.freeplay("run", "m.yaml", "--out", out, "--quiet", "--force", "--end", end, "--interval", "10 ms", *steps)
                    self.freeplay("run", "--resume", "part", "--end", "0.2 s", "--quiet")
                    for name in ("results.csv", "events.csv"):
                        self.assertEqual(self.read("whole", name), self.read("part", name))


if __name__ == "__main__":
    unittest.main()
