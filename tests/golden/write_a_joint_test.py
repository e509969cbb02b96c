"""docs/write-a-joint.md, done word by word outside the repository against an installed package; and every starter."""
import csv
import json
import math
import os
import re
import shutil
import subprocess
import tempfile
import unittest

from program import BUILD, ROOT, ProgramTest

PAGE = os.path.join(ROOT, "docs", "write-a-joint.md")
BLOCK = re.compile(r"^```(\w+)(?: (\S+))?\n(.*?)^```", re.M | re.S)


def setUpModule():
    global PREFIX
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    PREFIX = folder.name
    subprocess.run(["cmake", "--install", BUILD, "--prefix", PREFIX], check=True, capture_output=True)


class InstalledTest(ProgramTest):
    """With Freeplay installed in a folder of all tests, found through PATH."""

    def setUp(self):
        super().setUp()
        prefix = self.path("install")
        os.symlink(PREFIX, prefix)
        self.environment = {**os.environ, "PATH": os.path.join(prefix, "bin") + ":" + os.environ["PATH"]}
        # A library built by one compiler runs in a program built by another, but not one without the sanitizers' run time.
        os.mkdir(self.path("work"))

    def shell(self, line, code=0):
        done = subprocess.run(line, shell=True, cwd=self.path("work"), capture_output=True, text=True,
                              env=self.environment)
        self.assertEqual(code, done.returncode, "%s\n%s%s" % (line, done.stdout, done.stderr))
        return done.stdout

    def rows(self, *names):
        return list(csv.DictReader(self.read("work", *names).splitlines()))


class PageTest(InstalledTest):
    def test_every_block_of_the_page_does_what_it_says(self):
        with open(PAGE, encoding="utf-8") as file:
            blocks = BLOCK.findall(file.read())
        commands = []
        for language, name, text in blocks:
            if language == "sh":
                for line in text.splitlines():
                    self.shell(line)
                    commands.append(line)
            else:
                self.assertTrue(name, "a %s block without a file name" % language)
                with open(self.path("work", name), "w", encoding="utf-8") as file:
                    file.write(text)
        # From init to a run that uses the new joint.
        run = next(i for i, line in enumerate(commands) if line.startswith("freeplay run"))
        self.assertLessEqual(run + 1, 5)

        free = self.rows("results", "slot", "results.csv")
        self.assertEqual(101, len(free))
        for row in free:
            x, y = float(row["body.block.x"]), float(row["body.block.y"])
            self.assertAlmostEqual(0.02 * math.sin(2 * math.pi * x / 0.2), y, delta=1e-9)
            # Of 0.5 J; 2.8e-5 J at this step, a quarter of it at half the step.
            self.assertAlmostEqual(0.0, float(row["energy.residual"]), delta=4e-5)
        for row in self.rows("results", "wavy-slot-driven", "results.csv"):
            self.assertAlmostEqual(0.1 * math.sin(2 * math.pi * float(row["time"])), float(row["body.block.x"]),
                                   delta=1e-9)

        events = self.rows("results", "hole", "events.csv")
        self.assertEqual({"right", "upper", "lower"}, {event["kind"].split("_")[0] for event in events})
        ends = [event for event in events if event["kind"].endswith("contact_end")]
        self.assertGreater(len(ends), 2)
        error = self.rows("errors.csv")[0]
        for name in ("position", "ls_position"):
            self.assertAlmostEqual(5e-4, float(error[name]), delta=1e-12)
        start = self.rows("results", "window", "results.csv")[0]
        self.assertLess(float(start["joint.W.y"]), -3e-4)
        self.assertGreater(float(start["joint.W.fn"]), 1.0)
        ideal = self.rows("results", "ideal-window", "results.csv")
        away = [math.hypot(float(row["body.arm.x"]), float(row["body.arm.y"])) for row in ideal]
        self.assertLess(max(away) - min(away), 1e-12)
        summary = json.loads(self.read("work", "results", "hole", "summary.json"))
        hole = summary["joints"]["hole"]
        self.assertEqual(hole["contacts"], hole["play"]["impacts"] + sum(event["impact"] == "0" for event in ends) +
                         sum(event["kind"] == "contact_open" for event in events))
        self.assertGreaterEqual(summary["advice"]["min_steps_per_contact"], 20)
        self.assertLess(summary["residuals"]["energy_max"], 1e-8)

        rows = self.rows("results", "running-in", "results.csv")
        self.assertEqual(41, len(rows))
        for row in rows:
            slid = 2e-3 + float(row["body.block.x"]) - float(rows[0]["body.block.x"])
            mu = 0.3 - 0.2 * slid / 5e-3 if slid < 5e-3 else 0.1 - 0.05 * (slid - 5e-3) / 15e-3
            slip, normal = float(row["joint.guide.vt"]), float(row["joint.guide.fn"])
            self.assertAlmostEqual(-mu * normal * slip / math.hypot(slip, 1e-3), float(row["joint.guide.ft"]),
                                   delta=1e-4 * normal)

    def test_a_term_left_out_is_found(self):
        with open(PAGE, encoding="utf-8") as file:
            source = next(text for language, name, text in BLOCK.findall(file.read()) if language == "cpp")
        self.shell("freeplay init my-joint --kind plugin --type joint")
        wrong = source.replace(" + df * (s.vy + s.dy)", "")
        self.assertNotEqual(source, wrong)
        with open(self.path("work", "my-joint", "my_joint.cpp"), "w", encoding="utf-8") as file:
            file.write(wrong)
        self.shell("cmake -S my-joint -B my-joint/build && cmake --build my-joint/build")
        answer = json.loads(self.shell("freeplay check-plugin my-joint/build/my_joint.so --json", code=5))
        broken = [rule["rule"] for rule in answer["types"][0]["rules"] if not rule["held"]]
        self.assertEqual(1, len(broken), broken)


class StartersTest(InstalledTest):
    def test_every_starter_builds_passes_its_tests_and_runs(self):
        for kind in ("joint", "contact", "friction", "integrator"):
            with self.subTest(kind):
                answer = json.loads(self.shell("freeplay init new-%s --kind plugin --type %s --json" % (kind, kind)))
                for line in answer["next"]:
                    self.shell(line)
                self.shell("ctest --test-dir new-%s/build --output-on-failure" % kind)
                self.assertLess(10, len(self.rows("results", "new-%s-example" % kind, "results.csv")))


class PackageTest(InstalledTest):
    def test_the_package_needs_only_the_standard_library(self):
        self.shell("echo '#include <freeplay/plugin.h>' > a.cpp && "
                   "g++ -std=c++20 -Wall -Wextra -Wconversion -Werror -fsyntax-only -I ../install/include a.cpp")

    def test_a_library_of_the_folder_of_plugins_is_found_by_name(self):
        folder = self.path("install", "lib", "freeplay")
        os.makedirs(folder, exist_ok=True)
        self.addCleanup(os.remove, os.path.join(folder, "kuwabara_kono.so"))
        shutil.copy(os.path.join(BUILD, "plugins", "example", "kuwabara_kono.so"), folder)
        self.assertIn("kuwabara-kono", self.shell("freeplay list laws"))


if __name__ == "__main__":
    unittest.main()
