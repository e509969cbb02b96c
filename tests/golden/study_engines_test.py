"""Studies on engines for many machines: Slurm, GNU parallel and Snakemake give the bytes of one undisturbed run."""
import glob
import os
import shutil
import subprocess
import unittest

import slurm_box
from program import ProgramTest

# Set by `./dev test --all`, which installs them; ./dev test says which are missing.
NEEDS_ENGINES = "FREEPLAY_NEEDS_ENGINES" in os.environ
FOLDER = "a {study} of {x}"  # blanks and braces in every path of the scripts
TABLES = ("study.csv", "samples.csv", "failures.jsonl", "study.h5")
PENDULUM = """freeplay: 1
gravity: [0, -9.81]
parameters: {tilt: 20 deg}
bodies: {rod: {mass: 1 kg, inertia: 0.01, com: [0.3 m, 0]}}
joints: {pivot: {type: revolute, between: [ground, rod]}}
initial: {joints: {pivot: $tilt}}
simulation: {end: 0.2 s, accuracy: 1 um}
study:
  axes: {tilt: {linspace: [0 deg, 80 deg, 9]}, bodies.rod.inertia: [0.01, 0.02, -1]}
  reducers:
    turned: {channel: body.rod.angle, reduce: final}
    section: {channel: body.rod.angle, reduce: poincare, every: 50 ms}
"""


class StudyOnEngines(ProgramTest):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path(FOLDER))
        self.write("pendulum.yaml", PENDULUM)

    def need(self, engine, package, missing):
        if missing:
            words = "%s IS NOT INSTALLED: no study ran on it (apt-get install %s)" % (engine.upper(), package)
            self.fail(words) if NEEDS_ENGINES else self.skipTest(words)

    def submit(self, engine, out, environment=None):
        """Runs the last line that `study script` prints."""
        told = self.freeplay("study", "script", "pendulum.yaml", "--out", out, "--engine", engine, "--tasks", "3", "--probe", "1")[0]
        done = subprocess.run(["bash", "-c", told.splitlines()[-1]], cwd=self.folder, capture_output=True, text=True, timeout=300,
                              env=environment, stdin=subprocess.DEVNULL)
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)

    def assert_same_as_undisturbed(self, out):
        if not os.path.exists(self.path("whole")):
            self.freeplay("study", "run", "pendulum.yaml", "--out", "whole", code=4)  # nine rods have no inertia
        for name in TABLES:
            with open(self.path("whole", name), "rb") as ours, open(self.path(out, name), "rb") as theirs:
                self.assertTrue(ours.read() == theirs.read(), "%s differs" % name)

    def segments(self, out):
        return glob.glob(self.path(glob.escape(out), "rows", "*.rows"))

    def test_slurm(self):
        self.need("Slurm", "slurm-wlm munge", slurm_box.missing())
        box = slurm_box.SlurmBox()
        self.addCleanup(box.stop)
        out = os.path.join(FOLDER, "slurm")
        idle = lambda: not box.run("squeue", "-h").stdout.strip()
        self.submit("slurm", out, box.environment)
        box.wait(idle)
        self.assertEqual(4 * ["COMPLETED"], [job["JobState"] for job in box.ended_jobs()], box.said())  # three shards and the merge
        self.assertEqual(3, len(self.segments(out)))
        self.assert_same_as_undisturbed(out)

        os.unlink(self.segments(out)[0])  # lost with its machine
        os.unlink(self.path(out, "study.csv"))
        self.submit("slurm", out, box.environment)
        box.wait(idle)
        self.assert_same_as_undisturbed(out)
        self.assertEqual([0, 0, 0], box.stop())

    def test_gnu_parallel(self):
        self.need("GNU parallel", "parallel", shutil.which("parallel") is None)
        out = os.path.join(FOLDER, "parallel")
        self.submit("gnu-parallel", out)
        self.assertEqual(3, len(self.segments(out)))
        self.assert_same_as_undisturbed(out)

    def test_snakemake(self):
        self.need("Snakemake", "snakemake", shutil.which("snakemake") is None)
        out = os.path.join(FOLDER, "snakemake")
        self.submit("snakemake", out, {**os.environ, "XDG_CACHE_HOME": self.path("cache")})
        self.assertEqual(3, len(self.segments(out)))
        self.assert_same_as_undisturbed(out)


if __name__ == "__main__":
    unittest.main()
