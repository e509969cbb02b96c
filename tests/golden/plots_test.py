"""The plots of docs/results.md, as they stand there."""
import os
import re
import shutil
import subprocess
import sys
import unittest

from program import ROOT, ProgramTest, mechanism

# Set by `./dev soak` and `./dev test --all`, which install it; ./dev test says that it is missing.
NEEDS_OCTAVE = "FREEPLAY_NEEDS_OCTAVE" in os.environ


def block(kind):
    with open(os.path.join(ROOT, "docs", "results.md"), encoding="utf-8") as file:
        blocks = re.findall(r"^```%s\n(.*?)^```" % kind, file.read(), re.M | re.S)
    if len(blocks) != 1:
        raise AssertionError("docs/results.md has %d blocks of %s" % (len(blocks), kind))
    return blocks[0]


class Plots(ProgramTest):
    def setUp(self):
        super().setUp()
        self.freeplay("run", mechanism("slider-crank"), "--quiet")
        self.assertTrue(os.path.exists(self.path("results", "slider-crank", "results.h5")))

    def plot(self, kind, name, *command):
        """What the page's text of that kind draws."""
        self.write(name, block(kind))
        done = subprocess.run([*command, name], cwd=self.folder, capture_output=True, text=True, timeout=300)
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        drawing = self.read("force.svg")
        for words in ("time [s]", "normal force"):
            self.assertIn(words, drawing)
        return drawing

    def test_python(self):
        drawing = self.plot("python", "plot.py", sys.executable, "-B")
        line = max(re.findall(r'<path d="([^"]*)"', drawing), key=len)
        heights = [float(y) for y in re.findall(r"[ML] \S+ (\S+)", line)]
        self.assertGreater(len(heights), 100)
        # As high as the largest force of the table, on an axis that it fills.
        with open(self.path("results", "slider-crank", "results.csv"), encoding="utf-8") as file:
            rows = [line.split(",") for line in file.read().splitlines()]
        forces = [float(row[rows[0].index("joint.wrist.fn")]) for row in rows[1:]]
        scale = (max(heights) - min(heights)) / max(forces)
        self.assertAlmostEqual(0.0, forces[0] * scale - (max(heights) - heights[0]), delta=1e-3 * max(heights))

    def test_octave(self):
        if shutil.which("octave") is None:
            words = "OCTAVE IS NOT INSTALLED: the plot of docs/results.md was not drawn (apt-get install octave)"
            self.fail(words) if NEEDS_OCTAVE else self.skipTest(words)
        self.assertGreater(len(self.plot("octave", "force.m", "octave", "--no-gui", "--quiet", "--no-init-file")), 10000)


if __name__ == "__main__":
    unittest.main()
