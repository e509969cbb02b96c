"""Efforts that are inputs: `run --inputs` sets what a table says, and mistakes in it have places."""
import json
import unittest

from program import ProgramTest

ROD = """freeplay: 1
name: held-rod
gravity: [0, -9.81]
bodies: {rod: {mass: 1 kg, inertia: "1 kg*m^2 / 12", com: [0.5, 0]}}
joints: {pivot: {type: revolute, between: [ground, rod]}}
drivers: {motor: {joint: pivot, kind: torque, input: 2 N*m}}
simulation: {end: 40 ms, step: 1 ms, output: {interval: 10 ms}}
"""


class Inputs(ProgramTest):
    def rows(self, *words, model="rod.yaml"):
        self.freeplay("run", model, "--quiet", "--force", "--out", "r", *words)
        return self.read("r", "results.csv")

    def setUp(self):
        super().setUp()
        self.write("rod.yaml", ROD)
        self.write("fixed.yaml", ROD.replace("input: 2 N*m", "value: 2 N*m"))

    def test_without_a_table_an_input_is_what_the_file_says(self):
        for steps in ((), ("--accuracy", "1um")):
            self.assertEqual(self.rows(*steps, model="fixed.yaml"), self.rows(*steps))

    def test_means_go_on_from_the_new_effort(self):
        """100 N from 0.5 s to 0.6 s of 2 s: the root of 100^2*0.1/2."""
        self.write("cart.yaml", "freeplay: 1\nbodies: {m: {mass: 1, inertia: 1}}\njoints: {g: {type: prismatic, between: [ground, m]}}\n"
                   "drivers: {u: {joint: g, kind: force, input: 0 N}}\nsimulation: {end: 2 s, step: 1 ms, output: {interval: 0.1}}\n")
        self.write("in.csv", "time,u\n0.5,100\n0.6,0\n")
        for steps in ((), ("--accuracy", "1um"), ("--accuracy", "1um", "--integrator", "verner7")):
            self.rows("--inputs", "in.csv", *steps, model="cart.yaml")
            self.assertAlmostEqual(22.3607, json.loads(self.read("r", "summary.json"))["drivers"]["u"]["rms"], delta=0.03)

    def test_a_table_that_changes_nothing_leaves_the_rows_as_they_are(self):
        plain = self.rows()
        self.write("in.csv", "time,motor\n0.004,2\n0.01,2\n")
        self.assertEqual(plain, self.rows("--inputs", "in.csv"))
        self.assertEqual("time,motor\n0.004,2\n0.01,2\n", self.read("r", "inputs.csv"))

    def test_an_effort_acts_from_its_instant_on(self):
        self.write("in.csv", "time,motor\n0.015,0\n")
        names, *rows = (line.split(",") for line in self.rows("--inputs", "in.csv").splitlines())
        torque = names.index("driver.motor.torque")
        self.assertEqual(["2", "2", "0", "0", "0"], [row[torque] for row in rows])
        self.write("both.yaml", ROD.replace("input: 2 N*m", "table: {points: [[0, 2], [15 ms, 2], [15.000001 ms, 0], [1, 0]], interpolation: linear}"))
        _, *others = (line.split(",") for line in self.rows("--accuracy", "1um", model="both.yaml").splitlines())
        speed = names.index("body.rod.omega")
        self.assertAlmostEqual(float(others[-1][speed]), float(rows[-1][speed]), delta=1e-5)

    def test_the_account_of_energy_holds_over_jumps(self):
        self.write("in.csv", "time,motor\n" + "".join(f"{0.0013 * i!r},{(-1) ** i * 20}\n" for i in range(1, 30)))
        for steps in ((), ("--accuracy", "1um")):
            names, *rows = (line.split(",") for line in self.rows("--inputs", "in.csv", *steps).splitlines())
            residual = names.index("energy.residual")
            self.assertLess(max(abs(float(row[residual])) for row in rows), 1e-4)

    def test_a_result_is_made_again_from_its_record(self):
        self.write("in.csv", "time,motor\n0.015,0\n")
        self.rows("--inputs", "in.csv")
        out, _ = self.freeplay("reproduce", "r")
        self.assertIn("same", out)

    def test_mistakes_in_a_table_have_places(self):
        for text, line, column, message_id in (
                ("time,moter\n0,1\n", 1, 6, "unknown-name"), ("t,motor\n0,1\n", 1, 1, "bad-table"), ("time,motor\n0.1,1\n0.1,2\n", 3, 1, "bad-table"),
                ("time,motor\n-1,1\n", 2, 1, "bad-table"), ("time,motor\n0,one\n", 2, 3, "bad-table"), ("time,motor\n0,\n", 2, 3, "bad-table"),
                ("time,motor\n0,1,2\n", 2, 5, "bad-table"), ("time,motor,motor\n0,1,2\n", 1, 12, "bad-table"), ("time,motor\n0,1e999\n", 2, 3, "bad-table"),
                ("time,motor\n0,\xff\n", 2, 3, "bad-table"), ("", 1, 1, "bad-table")):
            with self.subTest(text=text):
                with open(self.path("in.csv"), "wb") as file:
                    file.write(text.encode("latin-1"))
                _, err = self.freeplay("run", "rod.yaml", "--inputs", "in.csv", "--out", "x", code=3)
                self.assertIn(f"in.csv:{line}:{column}: ", err)
                self.assertIn(message_id, err)
        _, err = self.freeplay("run", "rod.yaml", "--inputs", "nowhere.csv", code=3)
        self.assertIn("file-not-found", err)

    def test_options_that_have_no_inputs_are_refused(self):
        self.write("in.csv", "time,motor\n0,1\n")
        for words, part in ((("fixed.yaml", "--inputs", "in.csv"), "the model has no inputs"), (("rod.yaml", "--inputs", "in.csv", "--verify"), "--inputs and --verify"),
                            (("rod.yaml", "--inputs", "in.csv", "--repeat", "2"), "--inputs and --repeat")):
            _, err = self.freeplay("run", *words, code=2)
            self.assertIn(part, err)

    def test_only_a_torque_or_a_force_is_an_input(self):
        for kind, unit in (("velocity", ""), ("angle", "")):
            self.write("bad.yaml", ROD.replace("kind: torque, input: 2 N*m", f"kind: {kind}, input: 2{unit}"))
            _, err = self.freeplay("validate", "bad.yaml", code=3)
            self.assertIn("[wrong-type]", err)
            self.assertIn("not in this release", err)
        self.write("bad.yaml", ROD.replace("input: 2 N*m", "input: 2 N*m, value: 1"))
        self.assertIn("[conflicting-keys]", self.freeplay("validate", "bad.yaml", code=3)[1])
        self.write("bad.yaml", ROD.replace("input: 2 N*m", "input: 2*t"))
        self.assertIn("[time-not-allowed]", self.freeplay("validate", "bad.yaml", code=3)[1])


if __name__ == "__main__":
    unittest.main()
