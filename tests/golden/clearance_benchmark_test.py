"""The Open Clearance Benchmark: its tool, its models and their oracles."""
import csv
import json
import math
import os
import shutil
import subprocess
import sys
import unittest

from program import MECHANISMS, PROGRAM, ROOT, ProgramTest

TOOL = os.path.join(ROOT, "tests", "validation", "benchmark.py")
FOLDER = os.path.join(MECHANISMS, "benchmark")


def oracles():
    with open(os.path.join(FOLDER, "oracles.json"), encoding="utf-8") as file:
        return json.load(file)


class Benchmark(ProgramTest):
    def benchmark(self, folder, *words, code=0):
        done = subprocess.run([sys.executable, "-B", TOOL, PROGRAM, folder, *words], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(code, done.returncode, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def begins(self, *options):
        self.freeplay("run", os.path.join(FOLDER, "scotch-yoke.yaml"), "--out", "out", "--quiet", "--force", *options)
        return [float(event["time"]) for event in csv.DictReader(self.read("out", "events.csv").splitlines())
                if event["kind"] == "contact_begin"]

    def test_the_table_has_a_line_for_each_accuracy(self):
        page = self.path("page.md")
        said = self.benchmark(FOLDER, "9", "tilting-pin", "11", "--page", page)
        lines = [line.split() for line in said.splitlines()[1:10]]
        self.assertEqual(["4", "9", "11"], [lines[0][0], lines[3][0], lines[6][0]])
        finest = lines[5]
        self.assertEqual(["9", "bounce", "-", "0.01", "nm"], finest[:5])
        self.assertLess(float(finest[6]), 1e-8)
        with open(page, encoding="utf-8") as file:
            text = file.read()
        self.assertIn("| 9 bounce | - | 0.01 nm | ", text)
        self.assertIn("Siconos", text)

    def test_what_is_off_is_named(self):
        folder = self.path("copy", "of", "benchmark")
        shutil.copytree(FOLDER, folder)
        cases = [case for case in oracles() if case["name"] == "bounce"]
        cases[0]["variants"][0]["events"]["B"][0][0] *= 1.001
        with open(os.path.join(folder, "oracles.json"), "w", encoding="utf-8") as file:
            json.dump(cases, file)
        self.assertIn("OFF  bounce : t#1 1.0e-03", self.benchmark(folder, code=7))

    def test_a_case_that_there_is_not_is_refused(self):
        self.assertIn("no case is called bouncing", self.benchmark(FOLDER, "bouncing", code=2))

    def test_every_model_is_without_mistakes(self):
        for case in oracles():
            with self.subTest(case["name"]):
                self.freeplay("validate", os.path.join(FOLDER, case["model"]))

    def test_a_yoke_nears_its_impacts_without_duration(self):
        """The first contact is exact; later ones near those of Newton's law as K^-0.4."""
        case, = [one for one in oracles() if one["name"] == "scotch-yoke"]
        expected, late = case["variants"][0]["events"]["slot"], []
        for stiffness in (1e11, 1e13):
            begins = self.begins("--set", "K=%r" % stiffness, "--set", "e=0.8007917360136086", "--end", "30 ms")
            self.assertLess(abs(begins[0] - expected[0][0]), 1e-9)
            late.append(begins[1] - expected[1][0])
        self.assertAlmostEqual(0.4, math.log(late[0] / late[1]) / math.log(1e2), delta=0.02)

    def test_a_block_nears_impacts_of_both_corners_without_duration(self):
        """Newton's law at two corners at once; without friction as K^-0.4, with it the first contact alone is known."""
        page = self.path("page.md")
        self.benchmark(FOLDER, "6b", "--page", page)
        with open(page, encoding="utf-8") as file:
            cells = [line.split(" | ") for line in file if line.startswith("| 6b block-impacts") and " | 0.01 nm | " in line]
        self.assertEqual(4, len(cells))
        for row in cells:
            self.assertLess(float(row[3]), 1e-9)
        soft, firm, stiff, rubbed = (float(row[4]) for row in cells)
        self.assertLess(rubbed, 1e-9)
        for more, less in ((soft, firm), (firm, stiff)):
            self.assertAlmostEqual(0.4, math.log(more / less) / math.log(1e2), delta=0.02)


if __name__ == "__main__":
    unittest.main()
