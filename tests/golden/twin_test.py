"""freeplay run --twin: the same mechanism without clearances alongside, and what the clearances make of it."""
import csv
import json
import math
import os
import shutil
import signal
import subprocess
import time
import unittest

from program import PROGRAM, ProgramTest, mechanism

CRANK = """freeplay: 1
name: crank
bodies:
  crank: {mass: 0.3 kg, inertia: 1e-4, com: [25 mm, 0], frames: {tip: [50 mm, 0]}}
  coupler: {mass: 0.21 kg, inertia: 2.5e-4, com: [60 mm, 0], frames: {tip: [120 mm, 0]}}
  slider: {mass: 0.14 kg, inertia: 1e-4}
joints:
  main: {type: revolute, between: [ground, crank]}
  crankpin: {type: revolute, between: [crank/tip, coupler]}
  guide: {type: prismatic, between: [ground, slider]}
  wrist:
    type: revolute
    bearing: coupler/tip
    journal: slider
    clearance:
      bearing_radius: 10 mm
      radial_clearance: 0.5 mm
      length: 15 mm
      material: {E: 207 GPa, nu: 0.3}
      contact: {law: lankarani-nikravesh, restitution: 0.9}
drivers: {motor: {joint: main, kind: velocity, value: 5000 rpm}}
initial: {joints: {main: 0 deg}}
simulation: {end: 6 ms, step: 2 us, output: {interval: 20 us, discard: 2 ms}}
"""


def columns(text):
    rows = list(csv.reader(text.splitlines()))
    return {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


class Twin(ProgramTest):
    def summary(self, *folders):
        return json.loads(self.read(*folders, "summary.json"))

    def test_both_are_the_runs_that_they_are_alone(self):
        self.write("m.yaml", CRANK)
        out, err = self.freeplay("run", "m.yaml", "--twin", "--out", "both")
        self.assertNotIn("--twin", err)
        self.freeplay("run", "m.yaml", "--out", "loose")
        self.freeplay("run", "m.yaml", "--ideal", "all", "--out", "ideal")
        for name in ("results.csv", "events.csv"):
            self.assertEqual(self.read("loose", name), self.read("both", name))
            self.assertEqual(self.read("ideal", name), self.read("both", "twin", name))
        self.assertEqual("completed", self.summary("both", "twin")["status"])
        self.assertIsNone(self.summary("loose")["twin"])
        self.assertRegex(out, r"against the ideal twin: bodies up to \S+ [um]m off \(\w+\), ripple of efforts up to \S+ % \(motor\)")

    def test_distances_and_ripple_are_those_of_rows(self):
        self.write("m.yaml", CRANK)
        self.freeplay("run", "m.yaml", "--twin", "--out", "both")
        a, b = columns(self.read("both", "results.csv")), columns(self.read("both", "twin", "results.csv"))
        keep = [i for i, t in enumerate(a["time"]) if t >= 2e-3 - 1e-12]
        self.assertEqual(201, len(keep))
        twin = self.summary("both")["twin"]
        for body, figures in twin["bodies"].items():
            off = [math.hypot(a[f"body.{body}.x"][i] - b[f"body.{body}.x"][i], a[f"body.{body}.y"][i] - b[f"body.{body}.y"][i])
                   for i in keep]
            turned = [abs(a[f"body.{body}.angle"][i] - b[f"body.{body}.angle"][i]) for i in keep]
            self.assertAlmostEqual(max(off), figures["max_position"], delta=1e-15)
            self.assertAlmostEqual(max(turned), figures["max_angle"], delta=1e-15)
            self.assertAlmostEqual(math.sqrt(sum(x * x for x in off) / len(off)), figures["rms_position"], delta=1e-15)
        self.assertGreater(twin["bodies"]["slider"]["max_position"], 1e-5)
        e, f = a["driver.motor.torque"], b["driver.motor.torque"]
        ripple = math.sqrt(sum((e[i] - f[i]) ** 2 for i in keep) / sum(f[i] ** 2 for i in keep))
        self.assertAlmostEqual(ripple, twin["drivers"]["motor"]["ripple"], delta=1e-12 * ripple)

    def test_a_twin_that_fails_leaves_a_warning(self):
        # Columns of the play are not there without it.
        self.write("m.yaml", CRANK.replace("discard: 2 ms", "discard: 2 ms, channels: [joint.wrist.delta]"))
        _, err = self.freeplay("run", "m.yaml", "--twin", "--out", "both")
        self.assertIn("warning: --twin: the run without clearances failed: no channel fits 'joint.wrist.delta'", err)
        summary = self.summary("both")
        self.assertIsNone(summary["twin"])
        self.assertTrue(any("--twin" in warning for warning in summary["warnings"]))
        self.assertEqual(301, len(columns(self.read("both", "results.csv"))["time"]))

    def test_a_new_run_takes_an_earlier_twin_away(self):
        self.write("m.yaml", CRANK)
        self.freeplay("run", "m.yaml", "--twin", "--out", "both")
        self.freeplay("run", "m.yaml", "--out", "both")
        self.assertFalse(os.path.exists(self.path("both", "twin")))

    def killed(self, name, late):
        """A run with its twin, killed once its own rows (late) or some rows of the twin are there."""
        with subprocess.Popen([PROGRAM, "run", "m.yaml", "--twin", "--out", name, "--quiet"], cwd=self.folder,
                              stderr=subprocess.DEVNULL) as process:
            seen = self.path(name, *(("results.csv",) if late else ("twin", "results.csv")))
            while process.poll() is None and not (os.path.exists(seen) and os.path.getsize(seen) > 2000):
                time.sleep(0.001)
            process.kill()
        return process.returncode

    def test_a_twin_that_was_killed_is_made_again(self):
        self.write("m.yaml", CRANK.replace("end: 6 ms", "end: 200 ms"))
        self.freeplay("run", "m.yaml", "--twin", "--out", "both")
        for late in (False, True):
            self.assertEqual(-signal.SIGKILL, self.killed("cut%d" % late, late))
            self.freeplay("run", "--resume", "cut%d" % late)
            self.assert_same("both", "cut%d" % late)
        self.assertIn("nothing to do", self.freeplay("run", "--resume", "both")[0])

    def test_a_run_that_ended_without_its_twin_runs_again(self):
        self.write("m.yaml", CRANK)
        self.freeplay("run", "m.yaml", "--twin", "--out", "both")
        shutil.copytree(self.path("both"), self.path("lost"))
        self.write(os.path.join("lost", "summary.json"), json.dumps({**self.summary("lost"), "twin": None}))
        self.freeplay("run", "--resume", "lost")
        self.assert_same("both", "lost")

    def assert_same(self, a, b):
        for folder in ((), ("twin",)):
            self.assertEqual(self.read(a, *folder, "results.csv"), self.read(b, *folder, "results.csv"))
        for key in ("twin", "hashes", "status", "counts"):
            self.assertEqual(self.summary(a)[key], self.summary(b)[key])

    def test_what_has_no_twin(self):
        for arguments, word in (((mechanism("four-bar"), "--twin"), "no-clearance"),
                                ((mechanism("slider-crank"), "--ideal", "all", "--twin"), "no-clearance"),
                                ((mechanism("slider-crank"), "--twin", "--repeat", "2"), "--repeat"),
                                ((mechanism("slider-crank"), "--twin", "--dry-run"), "--twin")):
            _, err = self.freeplay("run", *arguments, code=2)
            self.assertIn(word, err)
        self.assertFalse(os.path.exists(self.path("results")))


class Rows(ProgramTest):
    def test_interval_and_channels_stand_in_for_those_of_the_file(self):
        self.write("m.yaml", CRANK)
        self.freeplay("run", "m.yaml", "--interval", "0.1 ms", "--channels", "body.slider.x", "--channels", "joint.wrist.e*",
                      "--out", "few")
        few = columns(self.read("few", "results.csv"))
        self.assertEqual(["time", "body.slider.x", "joint.wrist.ex", "joint.wrist.ey"], list(few))
        self.assertEqual(61, len(few["time"]))

    def test_what_fits_no_row_or_channel(self):
        self.write("m.yaml", CRANK)
        for arguments, words in ((("--interval", "0"), ("--interval",)), (("--interval", "1 mm"), ("--interval",)),
                                 (("--channels", "joint.wrist.fm"), ("unknown-channel", "did you mean", "joint.wrist.f"))):
            _, err = self.freeplay("run", "m.yaml", *arguments, "--out", "none", code=2)
            for word in words:
                self.assertIn(word, err)
        self.assertFalse(os.path.exists(self.path("none")))


if __name__ == "__main__":
    unittest.main()
