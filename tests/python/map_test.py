"""Many runs: the same table whatever the workers, points that fail, functions of parameters."""
import math
import os
import pathlib
import subprocess
import sys
import unittest
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np

import freeplay
from in_folder import InFolder, PROGRAM, SLIDER, same_bits

POINTS = {"c": [0.1e-3, 0.2e-3, 0.3e-3, 0.4e-3, 0.5e-3]}
REDUCE = {"peak": ("joint.wrist.fn", "max"), "last": ("body.slider.x", "final", 0.1e-3)}
STUDY = """freeplay: 1
study:
  models: [slider-crank.yaml]
  set: {simulation.end: 0.4 ms}
  axes: {c: [0.1 mm, 0.2 mm], joints.wrist.clearance.contact.restitution: [0.5, 0.9]}
  reducers: {peak: {channel: joint.wrist.fn, reduce: max}}
"""


class Map(InFolder):
    def test_workers_and_executors_give_one_table(self):
        options = {"end": "0.4 ms", "reduce": REDUCE}
        one = freeplay.map(SLIDER, POINTS, workers=1, **options)
        self.assertEqual(("index", "c", "peak", "last", "exit_code", "error"), one.columns)
        self.assertEqual(("m", "N", "m"), tuple(one.units[name] for name in ("c", "peak", "last")))
        tables = [freeplay.map(SLIDER, POINTS, workers=3, **options)]
        for kind in (ThreadPoolExecutor, ProcessPoolExecutor):
            with kind(2) as pool:
                tables.append(freeplay.map(freeplay.load(SLIDER), POINTS, executor=pool, **options))
        one.save("one.csv")
        for table in tables:
            table.save("other.csv")
            self.assertEqual(pathlib.Path("one.csv").read_bytes(), pathlib.Path("other.csv").read_bytes())
        run = freeplay.run(SLIDER, end="0.4 ms", set={"c": POINTS["c"][1]})
        self.assertEqual(run["body.slider.x"][-1], one["last"][1])
        self.assertGreaterEqual(one["peak"][1], run["joint.wrist.fn"].max())

    def test_a_section_of_a_file_gives_the_bytes_of_the_command_line(self):
        os.symlink(SLIDER, "slider-crank.yaml")
        pathlib.Path("study.yaml").write_text(STUDY)
        subprocess.run([PROGRAM, "study", "run", "study.yaml", "--quiet", "--out", "s"], check=True)
        freeplay.map("study.yaml", workers=2).save("mine.csv")
        self.assertEqual(pathlib.Path("s/study.csv").read_bytes(), pathlib.Path("mine.csv").read_bytes())

    def test_a_function_takes_the_numbers_of_each_result_in_order(self):
        seen = []
        table = freeplay.map(SLIDER, POINTS, end="0.2 ms", workers=3, reduce=lambda result: {"rows": len(result.time), "at": seen.append(result.model.parameters["c"]) or len(seen)})
        self.assertEqual([11.0] * 5, table["rows"].tolist())
        self.assertEqual([1.0, 2.0, 3.0, 4.0, 5.0], table["at"].tolist())
        self.assertTrue(np.allclose(POINTS["c"], seen))

    def test_a_point_that_fails_is_a_row_or_raises(self):
        points = [{"c": "0.1 mm"}, {"c": "-1 mm"}, {}]
        for reduce in (REDUCE, lambda result: {"last": result["body.slider.x"][-1]}):
            mixed = freeplay.map(SLIDER, points, end="0.2 ms", reduce=reduce)
            self.assertEqual(([0, 3, 0], ["", "out-of-range", ""]), (mixed["exit_code"].tolist(), mixed["error"].tolist()))
            self.assertTrue(math.isnan(mixed["last"][1]) and not math.isnan(mixed["last"][2]))
            with self.assertRaises(freeplay.ModelError) as caught:
                freeplay.map(SLIDER, points, end="0.2 ms", reduce=reduce, errors="raise")
            self.assertIn("out-of-range", [message.id for message in caught.exception.messages])

    def test_what_cannot_be_meant_is_refused(self):
        def mapped(points=POINTS, reduce=REDUCE, **options):
            return lambda: freeplay.map(SLIDER, points, reduce=reduce, end="0.1 ms", **options)
        for call in (mapped({"c": [1e-4], "speed": [1.0, 2.0]}), mapped({"nope": [1.0]}), mapped(reduce=None), mapped(reduce={}), mapped(workers=0),
                     mapped(errors="ignore"), mapped(reduce={"c": ("body.slider.x", "max")}), lambda: freeplay.map("freeplay: 1\n")):
            self.assertRaises(freeplay.UsageError, call)
        for call in (lambda: freeplay.Function(SLIDER, [], REDUCE), mapped({"c": [1e-4]}, reduce=lambda result: {"c": 1.0}), mapped({"c": [1e-4]}, reduce=lambda result: {"index": 1.0})):
            self.assertRaises(freeplay.UsageError, call)
        for executor in (3, ThreadPoolExecutor):
            self.assertRaisesRegex(TypeError, "executor: an Executor", mapped(executor=executor))
        for numbers in ({"a": "x"}, {"a": [1.0, 2.0]}, {"a,b": 1.0}, {"a\n": 1.0}, {3: 1.0}):
            self.assertRaisesRegex(TypeError, "reduce: ", mapped({"c": [1e-4]}, reduce=lambda result: numbers))
        for call in (mapped({"c": 1e-4}), mapped({"c": [None]}), mapped([1, 2]), mapped(reduce={"a": "max"}), mapped(workers="2"), mapped(progress=1), mapped(endd=1)):
            self.assertRaises(TypeError, call)
        for reduce in ({"a": ("joint.wrist.fm", "max")}, {"a": ("joint.wrist.fn", "maximum")}):
            self.assertRaisesRegex(freeplay.ModelError, "<reduce>", mapped(reduce=reduce))
        self.assertEqual(0, len(mapped({"c": []})()))

    def test_ctrl_c_ends_all_and_leaves_what_was_done(self):
        code = f"""
import freeplay, sys
try:
    freeplay.map({SLIDER!r}, [{{"simulation.end": "0.1 ms"}}] + 3 * [{{"simulation.end": "1000 s"}}], reduce={{"a": ("joint.wrist.fn", "max")}}, workers=2,
                 progress=lambda done, points: print(done, points, flush=True))
except freeplay.Interrupted as error:
    sys.exit(42 if error.table["index"].tolist() == [0.0] else 1)
"""
        child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
        while child.stdout.readline() != "1 4\n":
            pass
        child.send_signal(2)
        child.communicate()
        self.assertEqual(42, child.returncode)

    def test_a_function_of_parameters(self):
        table = freeplay.map(SLIDER, POINTS, end="0.2 ms", reduce=REDUCE)
        two = freeplay.Function(SLIDER, ["c"], REDUCE, end="0.2 ms")
        self.assertTrue(same_bits([table["peak"][1], table["last"][1]], two([0.2e-3])))
        self.assertTrue(same_bits(np.transpose([table["peak"], table["last"]]), two.sample(np.transpose([POINTS["c"]]))))
        one = freeplay.Function(SLIDER, ["c"], REDUCE["peak"], end="0.2 ms", errors="nan")
        self.assertIsInstance(one([0.2e-3]), float)
        self.assertTrue(math.isnan(one([-1.0])))
        self.assertEqual((3, 1), one.sample([[0.1e-3], [-1.0], [0.2e-3]]).shape)
        self.assertRaises(freeplay.ModelError, two, [-1.0])
        for x in ([1e-4, 1e-4], 1e-4, [[1e-4]]):
            self.assertRaises(freeplay.UsageError, two, x)
        self.assertRaises(freeplay.UsageError, freeplay.Function, SLIDER, ["c", "c"], REDUCE["peak"])  # the first number would count for nothing


if __name__ == "__main__":
    unittest.main()
