"""Results that were opened and are saved, simulations that are not closed, analyses that are broken off."""
import gc
import json
import os
import pathlib
import signal
import subprocess
import sys
import unittest
import warnings

import freeplay
from in_folder import ROOT, SLIDER, InFolder, is_in_core, same_bits

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
    def test_an_analysis_ends_at_any_signal_that_raises(self):
        model = freeplay.load(FOUR)
        self.addCleanup(signal.signal, signal.SIGALRM, signal.getsignal(signal.SIGALRM))
        self.addCleanup(signal.setitimer, signal.ITIMER_REAL, 0)
        for last in (1, 3):  # of the signals that the analysis heeds
            heeded = []

            def heed(_, frame):
                if is_in_core(frame, "asked"):
                    heeded.append(frame)
                    if len(heeded) == last:
                        raise KeyboardInterrupt
            signal.signal(signal.SIGALRM, heed)
            signal.setitimer(signal.ITIMER_REAL, 1e-3, 1e-3)
            with self.assertRaises(freeplay.Interrupted):
                model.error(grid={"x": (-0.1, 0.1, 1000), "y": (-0.1, 0.1, 1000)})
            signal.setitimer(signal.ITIMER_REAL, 0)


if __name__ == "__main__":
    unittest.main()
