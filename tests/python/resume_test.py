"""Runs that go on, runs beside a run, pages and what makes them again: as the command line has them."""
import json
import os
import pathlib
import subprocess
import unittest

import freeplay
from in_folder import PROGRAM, SLIDER, InFolder, same_bits

ROD = """freeplay: 1
name: rod
gravity: [0, -9.81]
bodies: {rod: {mass: 1 kg, inertia: "1 kg*m^2 / 12", com: [0.5, 0]}}
joints: {pivot: {type: revolute, between: [ground, rod]}}
drivers: {motor: {joint: pivot, kind: torque, input: 0 N*m}}
simulation: {end: 0.2 s, step: 1 ms, output: {interval: 10 ms}}
"""

END = "12.5 ms"  # statistics begin at 12 ms


def command(*words, code=0):
    done = subprocess.run([PROGRAM, *words], capture_output=True, text=True)
    if done.returncode != code:
        raise AssertionError(f"{words}: {done.returncode} {done.stdout}{done.stderr}")
    return done


def summary_of(folder):
    summary = json.loads(pathlib.Path(folder, "summary.json").read_text())
    for name in ("performance", "provenance", "files"):
        del summary[name]
    del summary["model"]["file"]
    return summary


class Beside(InFolder):
    def same_results(self, *words, folders=("",), **options):
        command("run", SLIDER, "--end", END, "--quiet", "--out", "a", *words)
        result = freeplay.run(SLIDER, end=END, out="b", **options)
        for folder in folders:
            for name in ("results.csv", "events.csv"):
                self.assertEqual(pathlib.Path("a", folder, name).read_bytes(), pathlib.Path("b", folder, name).read_bytes())
        self.assertEqual(summary_of("a"), summary_of("b"))
        return result

    def test_verify(self):
        self.assertIn("method", self.same_results("--verify", verify=True).summary["verification"])

    def test_twin(self):
        self.assertGreater(self.same_results("--twin", twin=True, folders=("", "twin")).summary["twin"]["bodies"]["slider"]["max_position"], 0)
        in_memory = freeplay.run(SLIDER, end=END, twin=True)
        self.assertEqual(summary_of("a")["twin"], in_memory.summary["twin"])

    def test_repeat(self):
        self.assertEqual(4, self.same_results("--repeat", "4", "--seed", "7", repeat=4, seed=7).summary["repeat"]["completed"])

    def test_what_cannot_be_met_is_refused_before_anything_is_written(self):
        rod = freeplay.load(ROD)
        for options in ({"twin": True}, {"repeat": 3}, {"seed": 2}, {"checkpoint": "-1 s"}, {"checkpoint": "3 m"}):
            self.assertRaises(freeplay.UsageError, rod.run, out="x", **options)
        self.assertRaises(freeplay.UsageError, freeplay.run, SLIDER, twin=True, repeat=2, out="x")
        self.assertRaises(freeplay.UsageError, freeplay.run, SLIDER, report=True)
        self.assertRaises(TypeError, freeplay.run, SLIDER, repeat=2.5)
        for name in ("verify", "twin", "report"):
            self.assertRaisesRegex(freeplay.UsageError, "whole run", rod.simulation, **{name: True})
        self.assertFalse(os.path.exists("x"))


class Pages(InFolder):
    def test_a_run_writes_its_page_and_a_result_too(self):
        result = freeplay.run(SLIDER, end="0.5 ms", out="r", report=True)
        command("report", "r", "--out", "by-command.html", "--quiet")
        self.assertEqual(pathlib.Path("by-command.html").read_bytes(), pathlib.Path("r/report.html").read_bytes())
        self.assertEqual("again.html", str(result.report("again.html")))
        self.assertEqual(pathlib.Path("again.html").read_bytes(), pathlib.Path("r/report.html").read_bytes())

    def test_a_result_in_memory_has_one_where_it_is_told(self):
        result = freeplay.run(SLIDER, end="0.5 ms")
        self.assertRaisesRegex(freeplay.UsageError, "say where", result.report)
        self.assertIn(b"<html", result.report("page.html").read_bytes())
        pathlib.Path("mine.html").write_text("mine")
        self.assertRaises(freeplay.ResultError, result.report, "mine.html")


class Resumed(InFolder):
    def cut(self, folder, after=0.0, **options):
        def stop(time, end, steps):
            if time > after:
                raise KeyboardInterrupt
        with self.assertRaises(freeplay.Interrupted) as raised:
            freeplay.run(SLIDER, out=folder, end="0.3 s", progress=stop, **options)
        return raised.exception.result

    def same_whole(self, folder, **options):
        """The result that went on is that of a run that was not interrupted."""
        whole = freeplay.run(SLIDER, out="c", end="0.3 s", force=True, **options)
        for name in ("results.csv", "events.csv"):
            self.assertEqual(pathlib.Path("c", name).read_bytes(), pathlib.Path(folder, name).read_bytes())
        self.assertEqual(summary_of("c"), summary_of(folder))
        self.assertTrue(same_bits(whole.data, freeplay.open(folder).data))

    def test_a_run_that_was_interrupted_goes_on_to_the_same_bytes(self):
        self.assertLess(self.cut("a").time[-1], 0.3)
        self.cut("b")
        ends = []
        result = freeplay.resume("a", progress=lambda time, end, steps: ends.append(end))
        command("run", "--resume", "b", "--quiet")
        self.assertEqual(1, result.summary["performance"]["resumed"])
        self.assertEqual({0.3}, set(ends))
        self.same_whole("a"), self.same_whole("b")
        self.assertEqual("completed", freeplay.resume("a").status)  # nothing to do

    def test_options_and_what_was_counted_before_stay(self):
        options = {"set": {"c": "0.1 mm"}, "channels": "joint.*"}
        self.cut("a", after=0.07, **options)  # behind the contact of fewest steps
        freeplay.resume("a")
        self.same_whole("a", **options)

    def test_a_run_with_inputs_goes_on_with_them(self):
        pathlib.Path("rod.yaml").write_text(ROD.replace("end: 0.2 s, step: 1 ms", "end: 20 s, step: 0.1 ms"))
        pathlib.Path("course.csv").write_text("time,motor\n0,1\n0.0137,2\n1.5,-1\n9,0.5\n90,0\n")

        def stop(time, end, steps):
            raise KeyboardInterrupt
        self.assertRaises(freeplay.Interrupted, freeplay.run, "rod.yaml", inputs="course.csv", out="a", progress=stop)
        command("run", "rod.yaml", "--inputs", "course.csv", "--quiet", "--out", "b")
        os.remove("course.csv")
        freeplay.resume("a")
        for name in ("results.csv", "inputs.csv", "inputs/course.csv"):
            self.assertEqual(pathlib.Path("a", name).read_bytes(), pathlib.Path("b", name).read_bytes(), name)
        self.assertEqual(summary_of("b"), summary_of("a"))

    def test_a_later_end(self):
        freeplay.run(SLIDER, out="a", end="1 ms", interval="20 us")
        result = freeplay.resume("a", end="1.5 ms")
        self.assertTrue(same_bits(freeplay.run(SLIDER, end="1.5 ms", interval="20 us").data, result.data))
        with self.assertRaises(freeplay.UsageError) as raised:
            freeplay.resume("a", end="1 ms")
        self.assertEqual("bad-value", raised.exception.messages[0].id)

    def test_what_is_another_is_refused(self):
        self.cut("a")
        with open("a/model.yaml", "a") as file:
            file.write("# changed\n")
        with self.assertRaises(freeplay.ModelError) as raised:
            freeplay.resume("a")
        self.assertEqual("resume-mismatch", raised.exception.messages[0].id)
        os.mkdir("empty")
        self.assertRaises(freeplay.ResultError, freeplay.resume, "empty")

    def test_what_a_script_set_is_made_again_and_not_resumed(self):
        with freeplay.load(ROD).simulation(out="a") as sim:
            for effort in (1.0, -2.0, 0.5):
                sim.set("motor", effort)
                sim.advance(sim.time + 0.0137)
            sim.advance()
        self.assertIn("same bytes", command("reproduce", "a").stdout)
        sim.result().save("saved")
        self.assertIn("same bytes", command("reproduce", "saved").stdout)
        freeplay.run(ROD, inputs="a/inputs.csv", out="b")
        self.assertIn("same bytes", command("reproduce", "b").stdout)
        with self.assertRaises(freeplay.ResultError) as raised:
            freeplay.resume("a")
        self.assertEqual("no-checkpoint", raised.exception.messages[0].id)


class Forked(InFolder):
    def test_a_child_goes_on_without_the_files_of_its_parent(self):
        filed = freeplay.load(ROD).simulation(out="r")
        filed.advance("50 ms")
        pid = os.fork()
        if pid == 0:
            good = filed.advance() == 0.2 and len(filed.result().time) == 21
            filed.result().save("by-child", format="both")
            os._exit(0 if good else 1)
        self.assertEqual(0, os.waitpid(pid, 0)[1])
        self.assertEqual(0.2, filed.advance())
        self.assertTrue(same_bits(freeplay.open("r").data, freeplay.open("by-child").data))
        self.assertEqual("completed", freeplay.open("r").status)


if __name__ == "__main__":
    unittest.main()
