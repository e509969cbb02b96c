"""Joints written from the headers alone move as independent formulas say."""
import csv
import json
import math
import os
import unittest

from program import BUILD, ProgramTest

LIBRARY = os.path.join(BUILD, "plugins", "tests", "honest_joints.so")

WHEEL = """freeplay: 1
bodies: {wheel: {mass: 2 kg, inertia: 0.3 kg*m^2, pose: {position: [0, 0.5]}}}
joints: {rolls: {type: rolling-wheel, between: [ground, wheel], radius: 0.5 m}}
forces: {pull: {type: force, at: wheel, value: [3, 0]}}
simulation: {end: 3 s, step: 1 ms, output: {interval: 0.1 s}}
"""
STOP = """freeplay: 1
gravity: [9.81, 0]
bodies: {block: {mass: 1 kg, inertia: 0.01}}
joints: {stop: {type: hard-stop, between: [ground, block], gap: 0.1 m, stiffness: 1e4}}
simulation: {end: 1 s, output: {interval: 0.01 s}}
"""
PIN = """freeplay: 1
gravity: [0, -9.81]
bodies: {rod: {mass: 1 kg, inertia: 0.02, com: [0, -0.25]}}
joints: {pin: {type: moved-pin, between: [ground, rod], way: 0.1 m * sin(8*t)}}
simulation: {end: 1 s, step: 0.5 ms, output: {interval: 0.01 s}}
"""


class HonestJoints(ProgramTest):
    def run_model(self, text, *options):
        self.write("m.yaml", text)
        self.freeplay("run", "m.yaml", "--plugin", LIBRARY, "--out", "r", "--force", *options)
        return list(csv.DictReader(self.read("r", "results.csv").splitlines()))

    def test_a_row_may_read_the_coordinate_of_its_joint(self):
        for row in self.run_model(WHEEL):
            t = float(row["time"])
            # (m + J/r^2) a = F: constant acceleration, which the method integrates exactly.
            way = 0.5 * 3.0 / (2.0 + 0.3 / 0.25) * t * t
            self.assertAlmostEqual(way, float(row["body.wheel.x"]), delta=1e-9)
            self.assertAlmostEqual(-way / 0.5, float(row["joint.rolls.angle"]), delta=1e-9)

    def test_events_happen_at_crossings_and_only_there(self):
        fall, stiffness, gap = 9.81, 1e4, 0.1
        # Free fall onto a spring, then the same backwards: period of the whole cycle.
        approach, omega = math.sqrt(2 * fall * gap), math.sqrt(stiffness)
        contact = 2 / omega * (math.pi / 2 + math.atan(fall / (omega * approach)))
        cycle = 2 * approach / fall + contact
        first = approach / fall
        begins = [first + k * cycle for k in range(10) if first + k * cycle <= 1.0]
        ends = [begin + contact for begin in begins if begin + contact <= 1.0]
        expected = sorted([(t, "stop_begin") for t in begins] + [(t, "stop_end") for t in ends])
        # Second order in the step over a few impacts; to the accuracy where the events are located.
        for options, error in ((("--step", "20us"), 2e-5), (("--accuracy", "1e-8"), 1e-6)):
            rows = self.run_model(STOP, *options)
            events = list(csv.DictReader(self.read("r", "events.csv").splitlines()))
            self.assertEqual([kind for _, kind in expected], [event["kind"] for event in events])
            for (t, _), event in zip(expected, events):
                self.assertAlmostEqual(t, float(event["time"]), delta=error)
            self.assertEqual(len(begins), float(rows[-1]["joint.stop.impacts"]))

    def test_the_work_of_rows_that_move_by_themselves_is_booked(self):
        residual = {}
        for step in ("0.5 ms", "0.25 ms"):
            rows = self.run_model(PIN, "--step", step)
            residual[step] = max(abs(float(row["energy.residual"])) for row in rows)
            self.assertGreater(max(float(row["energy.work"]) for row in rows), 0.1)
        self.assertLess(residual["0.5 ms"], 1e-4)
        self.assertAlmostEqual(4.0, residual["0.5 ms"] / residual["0.25 ms"], delta=0.5)

    def test_the_joints_keep_their_contract(self):
        report = json.loads(self.freeplay("check-plugin", LIBRARY, "--json")[0])
        self.assertTrue(report["ok"])

    def test_an_expression_that_a_joint_evaluates_fails_at_its_own_place(self):
        self.write("m.yaml", PIN.replace("0.1 m * sin(8*t)", "0.1 m * log(0.25 - t)"))
        _, err = self.freeplay("run", "m.yaml", "--plugin", LIBRARY, "--out", "r", code=4)
        self.assertRegex(err, r"joint 'pin': m\.yaml:4:70: logarithm of a number that is not positive \[bad-expression\]")
        self.assertNotIn("plugin", err)
        rows = self.read("r", "results.csv").splitlines()
        self.assertAlmostEqual(0.25, float(rows[-1].split(",")[0]), delta=0.0101)


if __name__ == "__main__":
    unittest.main()
