"""Results survive, in short; in full: `./dev soak`."""
import os
import random
import shutil
import sys
import unittest

from program import BUILD, PROGRAM, ROOT, ProgramTest, mechanism

sys.path.insert(0, os.path.join(ROOT, "tests", "soak"))
import soak
from faults import Faults
from results import Reference

LIBRARY = os.path.join(BUILD, "tests", "failing_calls.so")
# Half a second, or so.
KILLED = [("fixed", "slider-crank", ["--end", "0.3 s", "--interval", "0.2 ms"]),
          ("rows in contact", "slider-crank", ["--end", "1 s", "--interval", "1 ms", "--accuracy", "1um"])]


class Soak(ProgramTest):
    def test_a_run_that_is_killed_leaves_what_it_should_and_goes_on(self):
        said = []
        # On a busy machine a run may be over before it is killed.
        kinds = soak.soak_kills(PROGRAM, self.folder, 6, random.Random(1), said.append, KILLED)
        self.assertTrue(all(kind.killed >= 1 for kind in kinds), said)
        self.assertEqual(2, len(said))

    def test_a_call_that_fails_ends_the_run_and_loses_nothing(self):
        said = []
        faults = soak.soak_faults(PROGRAM, LIBRARY, self.folder, 16, random.Random(1), said.append)
        self.assertGreater(faults.failed.total(), 8)
        self.assertGreater(faults.counted, 100)
        # The first calls and the last are of other files than those between.
        for call in (*range(1, 20, 3), *range(faults.counted - 8, faults.counted, 3)):
            faults.fail(call, "EIO")

    def test_what_is_lost_or_changed_would_be_seen(self):
        self.freeplay("run", mechanism("slider-crank"), "--end", "24 ms", "--quiet", "--out", "whole")
        whole = Reference(self.path("whole"))
        whole.require_same(self.path("whole"))
        self.assertEqual((1201, 1201), whole.part(self.path("whole")))
        for name, damage in (("results.csv", lambda data: data.replace(b"1", b"2", 1)), ("events.csv", lambda data: data[:-9] + b"x\n"),
                             ("results.h5", lambda data: data.replace(whole.times[:500].tobytes(), whole.times[1:501].tobytes()))):
            with self.subTest(name):
                shutil.rmtree(self.path("other"), ignore_errors=True)
                shutil.copytree(self.path("whole"), self.path("other"))
                with open(self.path("other", name), "rb") as file:
                    data = file.read()
                self.assertNotEqual(data, damage(data))
                with open(self.path("other", name), "wb") as file:
                    file.write(damage(data))
                self.assertRaises(AssertionError, whole.part, self.path("other"))
                self.assertRaises(AssertionError, whole.require_same, self.path("other"))


if __name__ == "__main__":
    unittest.main()
