"""Results that were opened and are saved, simulations that are not closed, analyses that are broken off."""
import gc
import json
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
import unittest
import warnings

import freeplay
from in_folder import ROOT, SLIDER, InFolder, same_bits

FOUR = str(ROOT / "mechanisms/4-rrr.yaml")


def files_of(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in pathlib.Path(folder).rglob("*") if path.is_file()}


class Saved(InFolder):
    def test_a_result_that_was_opened_is_saved_with_the_bytes_it_has(self):
        for format in ("csv", "both"):
            freeplay.run(SLIDER, end="1 ms", out="a", force=True, format=format, twin=True, report=True)
            self.assertEqual(pathlib.Path("b"), freeplay.open("a").save("b"))
            self.assertEqual(files_of("a"), files_of("b"))
            self.assertTrue(same_bits(freeplay.open("a").data, freeplay.open("b").data))

    def test_rows_in_text_are_made_of_those_in_hdf5(self):
        ran = freeplay.run(SLIDER, end="1 ms", out="a", format="hdf5")
        ran.save("text", format="csv")
        freeplay.open("a").save("b", format="csv")
        self.assertEqual(pathlib.Path("text/results.csv").read_bytes(), pathlib.Path("b/results.csv").read_bytes())
        self.assertEqual(sorted(os.listdir("b")), json.loads(pathlib.Path("b/summary.json").read_text())["files"])
        self.assertNotIn("results.h5", os.listdir("b"))
        with self.assertRaisesRegex(freeplay.UsageError, "has no results.h5"):
            freeplay.open("b").save("c", format="both")

    def test_what_cannot_be_saved_costs_nothing(self):
        freeplay.run(SLIDER, end="1 ms", out="over/a")
        before, whole = files_of("over"), freeplay.open("over/a")
        for path in ("over/a", "over", "over/../over/a"):
            with self.assertRaisesRegex(freeplay.UsageError, "is or holds the result"):
                whole.save(path, force=True)
        with self.assertRaisesRegex(freeplay.UsageError, "bad value 'xml' of --format"):
            whole.save("b", format="xml")
        with self.assertRaisesRegex(freeplay.UsageError, "some of its channels"):
            freeplay.open("over/a", channels="body.*").save("b")
        pathlib.Path("alone.csv").write_bytes(pathlib.Path("over/a/results.csv").read_bytes())
        alone = freeplay.open("alone.csv")
        self.assertTrue(same_bits(whole.data, alone.data))
        self.assertEqual((0, None), (len(alone.events), alone.model))
        with self.assertRaisesRegex(freeplay.UsageError, "stands alone"):
            alone.save("b")
        self.assertEqual(before, files_of("over"))
        freeplay.run(SLIDER, end="0.5 ms", out="over/a", force=True)
        with self.assertRaisesRegex(freeplay.ResultError, "another summary than when it was opened"):
            whole.save("b")
        self.assertFalse(os.path.exists("b"))


class Left(InFolder):
    def test_a_simulation_that_is_not_closed_seals_its_files(self):
        with freeplay.load(SLIDER, end="1 ms").simulation(out="b") as sim:
            sim.advance("0.5 ms")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            sim = freeplay.load(SLIDER, end="1 ms").simulation(out="a")
            sim.advance("0.5 ms")
            del sim
            gc.collect()
        self.assertIn(ResourceWarning, [one.category for one in caught])
        self.assertEqual("stopped", freeplay.open("a").status)
        self.assertEqual(pathlib.Path("b/results.csv").read_bytes(), pathlib.Path("a/results.csv").read_bytes())

    def test_the_end_of_the_program_seals_them_too(self):
        code = f"import freeplay, warnings\nwarnings.simplefilter('ignore', freeplay.ModelWarning)\nsim = freeplay.load({SLIDER!r}, end='1 ms').simulation(out='a')\nsim.advance('0.5 ms')"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        self.assertEqual((0, "", ""), (done.returncode, done.stdout, done.stderr))
        self.assertEqual("stopped", freeplay.open("a").status)


class BrokenOff(InFolder):
    def test_an_analysis_is_broken_off_in_each_of_its_parts(self):
        model = freeplay.load(FOUR)
        grid = {"x": (-0.1, 0.1, 80), "y": (-0.1, 0.1, 80)}
        began = time.perf_counter()
        model.error(grid=grid)
        whole = time.perf_counter() - began
        for share in (0.1, 0.5):
            timer = threading.Timer(share * whole, os.kill, (os.getpid(), signal.SIGINT))
            timer.start()
            with self.assertRaises(freeplay.Interrupted):
                model.error(grid={axis: (a, b, 10 * count) for axis, (a, b, count) in grid.items()})
            timer.join()


if __name__ == "__main__":
    unittest.main()
