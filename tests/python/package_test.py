"""The package `freeplay` against the command line: the same bits, files, messages, tables."""
import json
import os
import pathlib
import pickle
import re
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings

import numpy as np

import freeplay
from in_folder import InFolder, PROGRAM, ROOT, SLIDER, same_bits

FAILS = """freeplay: 1
name: fails
gravity: [0, -9.81]
bodies: {rod: {mass: 1 kg, inertia: "1 kg*m^2 / 12", com: [0.5, 0]}}
joints: {pivot: {type: revolute, between: [ground, rod]}}
drivers: {m: {joint: pivot, kind: torque, value: "1 N*m*sqrt(1 - t/(0.1 s))"}}
simulation: {end: 2 s, step: 1 ms}
"""


def command(*words, code=0):
    done = subprocess.run([PROGRAM, *words], capture_output=True, text=True)
    assert done.returncode == code, (words, done.returncode, done.stderr)
    return done


def without_command(picture):
    """The record of a picture quotes the command line as it was typed."""
    return re.sub(r'"command": *"(?:[^"\\]|\\.)*"', "", picture)


class Runs(InFolder):
    def test_files_of_a_run_have_the_bytes_of_the_command_line(self):
        command("run", SLIDER, "--end", "0.5 ms", "--quiet", "--out", "c")
        result = freeplay.run(SLIDER, end="0.5 ms", out="p")
        result.save("s")
        for folder in ("p", "s"):
            for name in ("results.csv", "events.csv", "model.yaml"):
                self.assertEqual(pathlib.Path("c", name).read_bytes(), pathlib.Path(folder, name).read_bytes(), (folder, name))
            ours, theirs = (json.loads(pathlib.Path(f, "summary.json").read_text()) for f in (folder, "c"))
            for name in ("performance", "provenance", "files"):
                ours.pop(name), theirs.pop(name)
            self.assertEqual(theirs, ours)
            self.assertTrue(same_bits(freeplay.open(f"{folder}/results.h5").data, freeplay.open("c/results.csv").data))

    def test_a_contact_that_is_on_at_the_end_is_an_event_in_memory_too(self):
        result = freeplay.run(SLIDER, end="2 ms", out="written")
        kinds = [line.split(",")[2] for line in pathlib.Path("written/events.csv").read_text().splitlines()[1:]]
        self.assertEqual("contact_open", kinds[-1])
        self.assertEqual(kinds, result.events["kind"].tolist())
        result.save("saved")
        self.assertEqual(pathlib.Path("written/events.csv").read_bytes(), pathlib.Path("saved/events.csv").read_bytes())
        self.assertEqual(result.summary["hashes"], freeplay.run(SLIDER, end="2 ms").summary["hashes"])

    def test_numbers_in_memory_are_those_that_the_file_reads_back_to(self):
        command("run", SLIDER, "--end", "0.5 ms", "--quiet", "--out", "c")
        result, stored = freeplay.run(SLIDER, end=0.5e-3), freeplay.open("c")
        self.assertEqual(stored.names, result.names)
        self.assertTrue(same_bits(stored.data, result.data))
        self.assertEqual(str(stored.events.tolist()), str(result.events.tolist()))  # NaN is NaN
        self.assertEqual(dict(stored.units), dict(result.units))
        self.assertIs(freeplay.compare(result, "c").summary["agree"], True)
        table = freeplay.compare(result, freeplay.run(SLIDER, end=0.5e-3, set={"c": "0.2 mm"}))
        self.assertIs(table.summary["agree"], False)
        table.save("compared.csv")
        rows = [line.split(",") for line in pathlib.Path("compared.csv").read_text().splitlines()]
        self.assertEqual([list(table.columns), table["channel"].tolist(), table["max_abs"].tolist()], [rows[0], [row[0] for row in rows[1:]], [float(row[1]) for row in rows[1:]]])

    def test_arrays_are_read_only_views_that_keep_their_memory(self):
        result = freeplay.run(SLIDER, end="0.5 ms")
        column = result["body.slider.x"]
        self.assertTrue(np.shares_memory(column, result.data) and column.flags.c_contiguous)
        for array in (column, result.data, result.time, result.events):
            self.assertFalse(array.flags.writeable)
        self.assertRaises(ValueError, column.setflags, write=True)
        kept = column.copy()
        del result
        for _ in range(5):
            freeplay.run(SLIDER, end="0.1 ms")
        self.assertTrue(same_bits(column, kept))

    def test_runs_side_by_side_have_the_numbers_of_one(self):
        model = freeplay.load(SLIDER, end="0.5 ms")
        results = [model.run()]
        workers = [threading.Thread(target=lambda: results.append(model.run())) for _ in range(3)]
        [worker.start() for worker in workers], [worker.join() for worker in workers]
        self.assertEqual(4, len(results))
        for result in results:
            self.assertTrue(same_bits(result.data, results[0].data))
        self.assertTrue(same_bits(pickle.loads(pickle.dumps(model)).run().data, results[0].data))

    def test_a_rounding_mode_of_the_caller_changes_nothing_and_stays(self):
        import ctypes

        libm, upward = ctypes.CDLL("libm.so.6"), 0x800
        expected = freeplay.run(SLIDER, end="0.5 ms").data
        libm.fesetround(upward)
        try:
            found, kept = freeplay.run(SLIDER, end="0.5 ms").data, libm.fegetround()
        finally:
            libm.fesetround(0)
        self.assertTrue(same_bits(found, expected))
        self.assertEqual(upward, kept)

    def test_a_run_that_fails_has_its_rows(self):
        with self.assertRaises(freeplay.NumericalError) as caught:
            freeplay.run(FAILS, out="f")
        self.assertIn("square root", str(caught.exception))
        self.assertEqual("failed", caught.exception.result.status)
        self.assertGreater(len(caught.exception.result.time), 0)
        self.assertEqual(4, json.loads(pathlib.Path("f/summary.json").read_text())["exit_code"])

    def test_what_progress_raises_ends_the_run(self):
        class Mine(Exception):
            pass

        def complain(time, end, steps):
            self.assertEqual(10000.0, end)
            raise Mine
        self.assertRaises(Mine, freeplay.run, str(ROOT / "mechanisms/four-bar.yaml"), end="10000 s", progress=complain)

    def test_an_interrupt_ends_a_run_and_seals_its_files(self):
        code = (f"import freeplay\ntry: freeplay.run({str(ROOT / 'mechanisms/four-bar.yaml')!r}, end='10000 s', out='cut', progress=lambda *_: print('now', flush=True))\n"
                "except freeplay.Interrupted as error: print(error.result.status)")
        child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
        self.assertEqual("now\n", child.stdout.readline())
        child.send_signal(2)
        self.assertEqual("interrupted", child.communicate()[0].split()[-1])
        self.assertEqual(130, json.loads(pathlib.Path("cut/summary.json").read_text())["exit_code"])


class Models(InFolder):
    def test_text_tree_and_file_are_the_same_model(self):
        text = pathlib.Path(SLIDER).read_text()
        expected = freeplay.run(SLIDER, end="0.5 ms").data
        self.assertTrue(same_bits(freeplay.run(text, end="0.5 ms").data, expected))
        tree = {"freeplay": 1, "name": "rod", "gravity": np.array([0, -9.81]), "bodies": {"rod": {"mass": np.float64(1), "inertia": 0.1, "com": (0.5, 0)}},
                "joints": {"pivot": {"type": "revolute", "between": ["ground", "rod"]}}, "simulation": {"end": "10 ms", "step": 1e-3}}
        model = freeplay.load(tree)
        self.assertEqual(list(tree), list(json.loads(model.text)))
        model.save("rod.yaml")
        self.assertTrue(same_bits(freeplay.run("rod.yaml").data, model.run().data))
        tree["bodies"]["rod"]["mass"] = object()
        self.assertRaisesRegex(TypeError, "bodies.rod.mass", freeplay.load, tree)

    def test_a_model_stays_what_it_is_in_another_folder(self):
        pathlib.Path("here").mkdir()
        pathlib.Path("here/t.csv").write_text("t,v\n0,0\n1,1\n")
        text = FAILS.replace('value: "1 N*m*sqrt(1 - t/(0.1 s))"', "table: t.csv").replace("end: 2 s", "end: 20 ms")
        pathlib.Path("here/rod.yaml").write_text(text)
        os.chdir("here")
        models = [freeplay.load("rod.yaml"), freeplay.load(text), freeplay.load(text, folder=".")]
        expected = models[0].run().data
        os.chdir("..")
        pathlib.Path("t.csv").write_text("t,v\n0,9\n1,9\n")  # another table of the same name
        for model, name in zip(models, ("rod.yaml", "<model>", "<model>")):
            for other in (model, model.replace(strict=False), pickle.loads(pickle.dumps(model)), pickle.loads(pickle.dumps(model.replace(end="20 ms")))):
                self.assertTrue(same_bits(expected, other.run().data))
                self.assertEqual(name, other.file)
            table = freeplay.map(model, {"bodies.rod.mass": [1.0]}, reduce={"x": ("body.rod.x", "final")})
            self.assertEqual(["", expected[-1, 1]], [table["error"][0], table["x"][0]])
            with self.assertRaises(freeplay.ModelError) as caught:
                model.replace(set={"bodies.rod.mass": "3 s"})
            self.assertNotIn("/here/", str(caught.exception))

    def test_facts_start_tree_and_drawing_are_those_of_the_commands(self):
        for name in ("four-bar", "slider-crank", "spatial/delta"):
            path = str(ROOT / f"mechanisms/{name}.yaml")
            model, told = freeplay.load(path), json.loads(command("validate", path, "--json").stdout)
            self.assertEqual((told["facts"], told["start"]), (model.facts(), model.start()))
            self.assertEqual(json.loads(command("show", path, "--json").stdout), model.tree())
            self.assertEqual(command("show", path, "--format", "svg").stdout.strip(), model.svg().strip())
            self.assertEqual(json.loads(command("list", "channels", path, "--json").stdout), [c._asdict() for c in model.channels])
        self.assertEqual(json.loads(command("list", "--json").stdout), freeplay.types())
        self.assertEqual(json.loads(command("describe", "flores", "--json").stdout), freeplay.describe("flores"))
        self.assertEqual(json.loads(command("schema").stdout), freeplay.schema())

    def test_mistakes_have_the_messages_of_the_command(self):
        text = (ROOT / "mechanisms/four-bar.yaml").read_text().replace("inertia: 1.0e-3", "intertia: 1.0e-3").replace("mass: 0.3 kg", "mass: 0.3 m")
        pathlib.Path("bad.yaml").write_text(text)
        done = command("validate", "bad.yaml", "--max-errors", "0", "--json", code=3)
        told = json.loads(done.stdout)["messages"]
        with self.assertRaises(freeplay.ModelError) as caught:
            freeplay.load("bad.yaml")
        self.assertEqual(told, [m._asdict() for m in caught.exception.messages])
        self.assertEqual(done.stderr.strip(), str(caught.exception))
        self.assertEqual(told, [m._asdict() for m in freeplay.check("bad.yaml")])
        pathlib.Path("sub").mkdir()
        for folder in (None, "sub"):
            with self.assertRaises(freeplay.ModelError) as caught:
                freeplay.load(text, folder=folder)
            self.assertEqual({"<model>"}, {m.file for m in caught.exception.messages})
            self.assertTrue(str(caught.exception).startswith("<model>:"), caught.exception)
        self.assertEqual(str(caught.exception), str(pickle.loads(pickle.dumps(caught.exception))))

    def test_what_cannot_be_meant_is_refused(self):
        for options in ({"set": {"nope": 1}}, {"end": "3 kg"}, {"step": "1 ms", "accuracy": "1 um"}, {"ideal": "writs"}, {"integrator": "bahte"}):
            with self.assertRaises(freeplay.UsageError, msg=str(options)) as caught:
                freeplay.load(SLIDER, **options)
            self.assertTrue(caught.exception.exit_code == 2 and caught.exception.messages)
        self.assertRaises(TypeError, freeplay.load, SLIDER, end=[1])
        self.assertRaises(TypeError, freeplay.load, 3)
        result, planar = freeplay.run(SLIDER, end="0.1 ms"), freeplay.load(str(ROOT / "mechanisms/3-rrr.yaml"))
        for call in (lambda: result.select(3), lambda: freeplay.describe(3), lambda: freeplay.types(0), lambda: freeplay.schema(None),
                     lambda: planar.ik(pose=np.zeros((2, 1, 3)))):
            with self.assertRaises(TypeError) as wrong:
                call()
            self.assertRegex(str(wrong.exception), "needed|not")
            self.assertNotIn("incompatible", str(wrong.exception))
        for call in (lambda: result.save("saved", force="no"), lambda: planar.ik(pose=[0, 0, 0], force="no"), lambda: freeplay.resume("saved", report=1)):
            self.assertRaisesRegex(TypeError, "True or False", call)
        for options in ({"tolerance": -1}, {"absolute": -1e-9}):  # as of the command
            with self.assertRaises(freeplay.UsageError) as negative:
                freeplay.compare(result, result, **options)
            self.assertIn("must not be negative", str(negative.exception))
        self.assertRaises(freeplay.PluginError, freeplay.load, SLIDER, plugins=["nope"])
        with self.assertRaisesRegex(freeplay.UsageError, "--from 1 is after --until 0"):
            freeplay.compare(result, result, start=1, until=0)
        within = {}
        within["bodies"] = within
        self.assertRaisesRegex(TypeError, "holds itself", freeplay.load, within)
        self.assertRaisesRegex(MemoryError, "longer interval", freeplay.run, SLIDER, end=1e9, interval=1e-6)
        for call in (lambda: freeplay.run(SLIDER, out=b"o"), lambda: freeplay.load("freeplay: 1\n", folder=3), lambda: freeplay.open(b"o"), lambda: freeplay.compare(result, 3),
                     lambda: freeplay.resume(3), lambda: result.save(3), lambda: result.report(b"p.html")):
            self.assertRaisesRegex(TypeError, "a path is needed", call)
        for name in ("pose", "input"):
            self.assertRaisesRegex(TypeError, f"{name}: ", planar.ik, **{name: 1.0})
        for word in ("force", "strict", "verify", "twin", "report", "profile"):
            self.assertRaisesRegex(TypeError, f"{word}: True or False", freeplay.run, SLIDER, end="0.1 ms", **{word: "no"})
        with self.assertRaises(freeplay.UnknownName) as name:
            freeplay.run(SLIDER, end="0.1 ms")["body.slider.xx"]
        self.assertIsInstance(name.exception, KeyError)
        self.assertIn("body.slider.x", str(name.exception))
        pathlib.Path("full").mkdir()
        pathlib.Path("full/mine.txt").write_text("x")
        for call in (lambda: freeplay.run(SLIDER, end="0.1 ms", out="full"), lambda: freeplay.open("nowhere")):
            self.assertRaises(freeplay.ResultError, call)

    def test_tables_are_those_of_the_command(self):
        path = str(ROOT / "mechanisms/4-rrr.yaml")
        table = freeplay.load(path).error(grid={"x": (-0.1, 0.1, 3), "y": (-0.1, 0.1, 2)})
        told = json.loads(command("analyze", "error", path, "--grid", "x=-0.1:0.1:3", "--grid", "y=-0.1:0.1:2", "--json").stdout)
        self.assertEqual(told["columns"], list(table.columns))
        self.assertEqual(told["summary"], table.summary)
        for place, name in enumerate(told["columns"]):
            cells = [row[place] for row in told["rows"]]
            np.testing.assert_array_equal(table[name], cells if isinstance(cells[0], str) else np.array(cells, dtype=float))
        self.assertEqual((3, 2), table.grid("position").shape)
        self.assertEqual("m", table.units["position"])
        command("analyze", "error", path, "--grid", "x=-0.1:0.1:3", "--grid", "y=-0.1:0.1:2", "--out", "c.csv")
        table.save("p.csv")
        self.assertEqual(pathlib.Path("c.csv").read_bytes(), pathlib.Path("p.csv").read_bytes())
        words = ("--grid", "x=-0.1:0.1:3", "--grid", "y=-0.1:0.1:2", "--colours")
        command("analyze", "error", path, *words, "--out", "c.csv", "--svg", "c.svg")
        drawn = freeplay.load(path).error(grid={"x": (-0.1, 0.1, 3), "y": (-0.1, 0.1, 2)}, colours=True)
        self.assertEqual(without_command(pathlib.Path("c.svg").read_text()), without_command(drawn.svg()))
        self.assertNotEqual(without_command(table.svg()), without_command(drawn.svg()))
        self.assertIn("<svg", pickle.loads(pickle.dumps(drawn))._repr_html_())
        for other in (freeplay.load(path).ik(time=(0, 0.1, 3)), freeplay.compare(*2 * [freeplay.run(SLIDER, end="0.1 ms")])):
            self.assertRaises(freeplay.UsageError, other.svg)
            self.assertIn("<table", other._repr_html_())
        with self.assertRaises(freeplay.NumericalError) as caught:
            freeplay.load(path).ik(pose=[5.0, 0, 0])
        self.assertEqual("ik-unreachable", caught.exception.messages[0].id)


class Package(unittest.TestCase):
    def test_it_imports_numpy_alone_and_prints_nothing(self):
        code = (f"import sys, warnings; warnings.simplefilter('ignore'); import freeplay; freeplay.run({SLIDER!r}, end='0.1 ms')\n"
                "assert not {'matplotlib', 'pandas', 'xarray', 'h5py', 'scipy', 'multiprocessing'} & set(sys.modules)")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        self.assertEqual((0, "", ""), (done.returncode, done.stdout, done.stderr))

    def test_the_extension_shows_its_entry_alone(self):
        core = next(pathlib.Path(freeplay.__file__).parent.glob("_core*.so"))
        names = subprocess.run(["nm", "-D", "--defined-only", core], capture_output=True, text=True, check=True).stdout
        self.assertEqual(["PyInit__core"], [line.split()[-1] for line in names.splitlines()])

    def test_types_are_those_that_are_written(self):
        try:
            import mypy  # noqa: F401
        except ImportError:
            self.skipTest("mypy is not installed")
        with tempfile.TemporaryDirectory() as cache:
            folder = ROOT / "core/python"
            done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--cache-dir", cache, "freeplay"],
                                  cwd=folder, capture_output=True, text=True)
        self.assertEqual(0, done.returncode, done.stdout)


if __name__ == "__main__":
    unittest.main()
