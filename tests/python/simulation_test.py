"""Runs step by step: the bits of a whole run, inputs that the command line sets again, one thread at a time."""
import copy
import math
import os
import pathlib
import subprocess
import sys
import threading
import unittest

import numpy as np

import freeplay
from in_folder import InFolder, PROGRAM, ROOT, SLIDER, same_bits

ROD = """freeplay: 1
name: held-rod
gravity: [0, -9.81]
bodies: {rod: {mass: 1 kg, inertia: "1 kg*m^2 / 12", com: [0.5, 0]}}
joints: {pivot: {type: revolute, between: [ground, rod]}}
drivers: {motor: {joint: pivot, kind: torque, input: 0 N*m}}
initial: {joints: {pivot: -90 deg}}
simulation: {end: 0.2 s, step: 1 ms, output: {interval: 10 ms}}
"""


def until_in_a_step(sim):
    """Waits for another thread to be in it."""
    while True:
        try:
            sim.time
        except RuntimeError:
            return


class WithRod(InFolder):
    def setUp(self):
        super().setUp()
        pathlib.Path("rod.yaml").write_text(ROD)


class Steps(WithRod):
    def test_halts_change_no_bit(self):
        for options in ({}, {"accuracy": "1 um"}):
            model = freeplay.load(SLIDER, end="1 ms", **options)
            whole = model.run()
            for go_on in (lambda sim: sim.step(), lambda sim: sim.step(7), lambda sim: sim.advance(rows=1), lambda sim: sim.advance(rows=3), lambda sim: sim.advance()):
                with model.simulation() as sim:
                    row = sim.row
                    self.assertTrue(same_bits(whole.data[0], row))
                    while not sim.done:
                        go_on(sim)
                    self.assertTrue(same_bits(whole.data, sim.result().data))
                    self.assertEqual(whole.summary["counts"], sim.result().summary["counts"])
                    self.assertTrue(same_bits(whole.data[-1], row))
                    self.assertEqual(("completed", 1e-3, 1e-3), (sim.status, sim.time, sim.end))
                    self.assertEqual((1e-3, 1e-3), (sim.step(), sim.advance()))

    def test_a_time_is_reached_exactly_and_rows_stay_at_their_instants(self):
        for options in ({}, {"accuracy": "1 um"}):
            model = freeplay.load(SLIDER, end="1 ms", **options)
            whole = model.run()
            with model.simulation() as sim:
                self.assertEqual(whole.time[3], sim.advance(whole.time[3] * (1 + 1e-15)))
                middle = 0.3 * whole.time[5] + 0.7 * whole.time[6]
                self.assertEqual(middle, sim.advance(middle))
                self.assertEqual(6, len(sim.result().time))
                self.assertEqual("unfinished", sim.result().status)
                self.assertEqual(middle, sim.advance(middle))
                sim.advance()
                self.assertTrue(same_bits(whole.time, sim.result().time))

    def test_a_view_of_rows_stays_while_the_run_goes_on(self):
        with freeplay.load("rod.yaml").simulation() as sim:
            sim.advance(rows=2)
            early = sim.result()
            kept = early.data.copy()
            sim.advance()
            self.assertTrue(same_bits(kept, early.data))
            self.assertTrue(np.shares_memory(early.data, sim.result().data))

    def test_a_run_that_is_closed_keeps_its_rows_and_says_so(self):
        with freeplay.load("rod.yaml").simulation(out="r") as sim:
            sim.advance("50 ms")
        self.assertEqual(("stopped", True), (sim.status, sim.done))
        sim.close()
        stored = freeplay.open("r")
        self.assertEqual(("stopped", "closed at t = 0.05 s"), (stored.status, stored.reason))
        self.assertTrue(same_bits(stored.data, sim.result().data))
        self.assertIsInstance(sim["joint.pivot.angle"], float)
        for call in (sim.advance, sim.step, lambda: sim.set("motor", 1)):
            self.assertRaisesRegex(freeplay.UsageError, "the simulation is over .stopped.", call)

    def test_a_run_that_fails_raises_with_its_rows(self):
        text = ROD.replace("input: 0 N*m", 'value: "1 N*m*sqrt(1 - t/(0.1 s))"')
        with freeplay.load(text).simulation() as sim:
            error = self.assertRaises(freeplay.NumericalError, sim.advance)
        with self.assertRaises(freeplay.NumericalError) as caught:
            freeplay.load(text).simulation().advance()
        self.assertEqual("failed", caught.exception.result.status)
        self.assertTrue(len(caught.exception.result.time) > 5)

    def test_files_stay_where_they_were_begun(self):
        pathlib.Path("other").mkdir()
        with freeplay.load("rod.yaml").simulation(out="r") as sim:
            sim.step()
            os.chdir("other")
            sim.advance()
        os.chdir("..")
        self.assertEqual("completed", freeplay.open("r").status)

    def test_what_cannot_be_meant_is_refused(self):
        sim = freeplay.load("rod.yaml").simulation()
        sim.advance("20 ms")
        for call in (lambda: sim.advance("10 ms"), lambda: sim.advance("3 kg"), lambda: sim.advance(math.nan), lambda: sim.advance(math.inf), lambda: sim.advance("1 s", rows=1),
                     lambda: sim.advance(rows=0), lambda: sim.step(-1), lambda: sim.set("motor", "3 kg"), lambda: sim.set("motor", math.nan)):
            self.assertRaises(freeplay.UsageError, call)
        for call in (lambda: sim.advance(True), lambda: sim.advance([1]), lambda: sim.advance(rows=1.5), lambda: sim.step("1"), lambda: sim.step(True), lambda: sim.set("motor", None),
                     lambda: copy.copy(sim)):
            self.assertRaises(TypeError, call)
        for call in (lambda: sim["joint.pivot.angel"], lambda: sim.set("moter", 1)):
            self.assertRaisesRegex(freeplay.UnknownName, "did you mean", call)
        self.assertEqual(0.02, sim.time)


class Inputs(WithRod):
    def controlled(self, go_on, out, **options):
        with freeplay.load("rod.yaml", **options).simulation(out=out, force=True) as sim:
            while not sim.done:
                angle, speed = sim["joint.pivot.angle"], sim["joint.pivot.speed"]
                sim.set("motor", 4.905 * math.cos(angle) - 40 * angle - 8 * speed)
                go_on(sim)
        return sim

    def test_the_command_line_sets_again_what_was_set(self):
        cases = (("rows", lambda sim: sim.advance(rows=1), {}), ("steps", lambda sim: sim.step(3), {}), ("times", lambda sim: sim.advance(sim.time + 0.0137), {}),
                 ("accuracy", lambda sim: sim.advance(sim.time + 0.0137), {"accuracy": "1 um"}))
        for name, go_on, options in cases:
            with self.subTest(name):
                sim = self.controlled(go_on, name, **options)
                words = [word for key, text in options.items() for word in ("--" + key, text)]
                subprocess.run([PROGRAM, "run", "rod.yaml", "--quiet", "--force", "--inputs", f"{name}/inputs.csv", "--out", "again", *words], check=True)
                self.assertEqual(pathlib.Path(name, "results.csv").read_bytes(), pathlib.Path("again/results.csv").read_bytes())
                self.assertEqual(pathlib.Path(name, "inputs.csv").read_bytes(), pathlib.Path("again/inputs.csv").read_bytes())
                self.assertLess(abs(sim.result()["energy.residual"]).max(), 1e-3)
                self.assertEqual(sim.inputs["motor"], sim["driver.motor.torque"])

    def test_a_result_that_is_saved_later_has_the_inputs(self):
        sim = self.controlled(lambda sim: sim.advance(rows=1), "r")
        sim.result().save("s")
        for name in ("results.csv", "inputs.csv"):
            self.assertEqual(pathlib.Path("r", name).read_bytes(), pathlib.Path("s", name).read_bytes())

    def test_an_effort_acts_at_once_on_what_is_read(self):
        model = freeplay.load("rod.yaml")
        self.assertEqual(("motor",), model.inputs)
        sim = model.simulation()
        row = sim.row
        sim.advance("30 ms")
        angle = sim["joint.pivot.angle"]
        sim.set("motor", "2 N*m")
        self.assertEqual((2.0, 2.0, angle), (sim.inputs["motor"], sim["driver.motor.torque"], sim["joint.pivot.angle"]))
        self.assertEqual(2.0, row[sim.names.index("driver.motor.torque")])

    def test_what_holds_already_changes_nothing(self):
        sim = self.controlled(lambda sim: sim.advance(rows=1), "a")
        with freeplay.load("rod.yaml").simulation(out="b") as again:
            while not again.done:
                again.set("motor", again.inputs["motor"])
                again.step()
        self.assertEqual("time,motor\n", pathlib.Path("b/inputs.csv").read_text())
        self.assertTrue(same_bits(freeplay.run("rod.yaml").data, again.result().data))
        self.assertFalse(same_bits(sim.result().data, again.result().data))


class Threads(WithRod):
    def test_another_thread_may_interrupt_and_do_nothing_else(self):
        sim = freeplay.load("rod.yaml", end="100000 s").simulation(out="r")
        raised = []

        def go():
            try:
                sim.advance()
            except freeplay.Interrupted as error:
                raised.append(error)
        thread = threading.Thread(target=go)
        thread.start()
        until_in_a_step(sim)
        for call in (sim.step, sim.advance, sim.close, sim.result, lambda: sim.time, lambda: sim.row, lambda: sim["time"], lambda: sim.set("motor", 1)):
            self.assertRaisesRegex(RuntimeError, "another thread", call)
        sim.interrupt()
        thread.join()
        self.assertEqual("interrupted", raised[0].result.status)
        self.assertEqual(("interrupted", True), (sim.status, sim.done))
        self.assertEqual("interrupted", freeplay.open("r").status)

    def test_a_function_that_is_called_during_a_run_cannot_use_it(self):
        sim = freeplay.load("rod.yaml", end="100000 s").simulation(progress=lambda *_: sim.step())
        self.assertRaisesRegex(RuntimeError, "a function called during a step", sim.advance)

    def test_other_threads_go_on_during_a_step(self):
        sim = freeplay.load("rod.yaml", end="100000 s").simulation()
        thread = threading.Thread(target=lambda: self.assertRaises(freeplay.Interrupted, sim.advance))
        thread.start()
        until_in_a_step(sim)
        for _ in range(10000):  # each of them finds the step in hand, so none has waited for its end
            self.assertRaises(RuntimeError, lambda: sim.time)
        sim.interrupt()
        thread.join()

    def test_a_halt_is_one_call_of_the_core_and_leaves_nothing(self):
        sim = freeplay.load(str(ROOT / "mechanisms/pendulum.yaml"), end="200 s").simulation()
        calls = []
        sys.setprofile(lambda frame, event, what: calls.append((event, what)))
        try:
            sim.step()
        finally:
            sys.setprofile(None)
        self.assertEqual(["advance", "setprofile"], [what.__name__ for event, what in calls if event == "c_call"])
        self.assertEqual(1, sum(event == "call" for event, _ in calls))
        sim.step(10)
        before = sys.getallocatedblocks()
        for _ in range(2000):
            sim.step()
        self.assertLess(sys.getallocatedblocks() - before, 20)


if __name__ == "__main__":
    unittest.main()
