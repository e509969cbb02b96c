"""The example of docs/openturns.md: FORM and Sobol indices over the table of a study, against what a linear function gives."""
import csv
import importlib.util
import math
import os
import re
import shutil
import subprocess
import sys
import unittest

from program import PROGRAM, ROOT, ProgramTest, mechanism

# Set by `./dev test --all`, which installs it; ./dev test says that it is missing.
NEEDS_OPENTURNS = "FREEPLAY_NEEDS_OPENTURNS" in os.environ
SHIPPED = os.path.join(ROOT, "mechanisms", "studies", "openturns")
PLAYS = ["joints.leg%d.%s.clearance.radial_clearance" % (leg, joint) for leg in (1, 2, 3) for joint in "BC"]


class OpenTurns(ProgramTest):
    def page(self):
        with open(os.path.join(ROOT, "docs", "openturns.md"), encoding="utf-8") as file:
            return file.read()

    def shipped(self, name):
        with open(os.path.join(SHIPPED, name), encoding="utf-8") as file:
            return file.read()

    def copy(self):
        """The example where it may write, at the same place beside its model."""
        folder = self.path("studies", "openturns")
        shutil.copytree(SHIPPED, folder)
        shutil.copy(mechanism("3-rrr"), self.folder)
        return folder

    def error(self, **changed):
        """The largest error in x [um] where one play is larger."""
        words = [word for name, value in changed.items() for word in ("--set", "%s=%r m" % (name, value))]
        out, _ = self.freeplay("analyze", "error", mechanism("3-rrr"), "--pose", "0,0,0", *words)
        return 1e6 * float(next(csv.DictReader(out.splitlines()))["dx"])

    def test_the_page_shows_what_is_shipped(self):
        for kind, name in (("yaml", "platform.yaml"), ("python", "platform.py")):
            self.assertEqual(self.shipped(name), re.search(r"^```%s\n(.*?)^```" % kind, self.page(), re.M | re.S)[1])

    def test_the_shipped_points_are_those_of_plain_analyses(self):
        folder = self.copy()
        self.freeplay("study", "run", os.path.join(folder, "platform.yaml"), "--out", "r", "--quiet")
        found = [1e6 * float(row["dx"]) for row in csv.DictReader(self.read("r", "study.csv").splitlines())]
        self.assertEqual([self.error()] + [self.error(**{play: 1.1e-4}) for play in PLAYS], found)

    def test_the_example_finds_what_a_linear_function_gives(self):
        if importlib.util.find_spec("openturns") is None:
            words = "OPENTURNS IS NOT INSTALLED: the example of docs/openturns.md was not run (apt-get install python3-openturns)"
            self.fail(words) if NEEDS_OPENTURNS else self.skipTest(words)
        folder = self.copy()
        self.write(os.path.join(folder, "platform.py"), self.shipped("platform.py").replace("count = 1024", "count = 256"))
        os.mkdir(self.path("bin"))
        os.symlink(os.path.abspath(PROGRAM), self.path("bin", "freeplay"))
        done = subprocess.run([sys.executable, "platform.py"], cwd=folder, capture_output=True, text=True, timeout=300,
                              env={**os.environ, "PATH": self.path("bin") + os.pathsep + os.environ["PATH"]})
        self.assertEqual(0, done.returncode, done.stderr)
        found = {name: [float(word) for word in words.split()] for name, words in re.findall(r"^([a-z -]+?) (-?\d.*)$", done.stdout, re.M)}
        usual = self.error()
        slopes = [(self.error(**{play: 1.1e-4}) - usual) for play in PLAYS]  # of a deviation
        beta = (280.0 - usual) / math.hypot(*slopes)
        self.assertAlmostEqual(beta, found["beta"][0], delta=1e-3)
        self.assertAlmostEqual(0.5 * math.erfc(beta / math.sqrt(2.0)), found["probability"][0], delta=1e-5)
        self.assertIn("Beta is %.2f" % beta, self.page())
        for share, index in zip([(slope / math.hypot(*slopes)) ** 2 for slope in slopes], found["total"]):
            self.assertAlmostEqual(share, index, delta=0.15)


if __name__ == "__main__":
    unittest.main()
