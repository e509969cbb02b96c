"""Runs that would write more than there is room for, and systems that give no memory, no threads or no processes."""
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import time
import unittest

from program import BUILD, PROGRAM, ProgramTest, mechanism

MANY_ROWS = """freeplay: 1
name: many-rows
bodies: {b: {mass: 1 kg, inertia: 1e-3}}
joints: {pin: {type: revolute, between: [ground, b]}}
simulation: {end: %s s, step: 1 ms, output: {interval: %s s}}
"""

MANY_BODIES = """freeplay: 1
name: many-bodies
templates: {ball: {bodies: {b: {mass: 1 kg, inertia: 1e-3}}}}
instances: {a: {template: ball, count: %d}}
simulation: {end: 1 s, step: 1 ms, output: {interval: 1 us}}
"""

PENDULUMS = """freeplay: 1
gravity: [0, -9.81]
templates:
  pendulum:
    bodies: {rod: {mass: 1 kg, inertia: 0.02, com: [0.5, 0]}}
    joints: {pin: {type: revolute, between: [ground, rod]}}
instances: {a: {template: pendulum, count: 1500}}
simulation: {end: 2 ms, step: 1 ms, output: {interval: 1 ms}}
"""

SANITIZED = os.path.basename(BUILD) == "sanitize"  # which reserves more addresses than any limit allows
WORDS = {"no-memory": "the system gives no more memory", "no-threads": "the system gives no more threads",
         "cannot-write": "cannot write"}


class Room(ProgramTest):
    def test_more_than_half_of_the_room_is_refused_before_anything_is_made(self):
        cases = {"rows": MANY_ROWS % ("1e6", "1e-6"), "bodies": MANY_BODIES % 199999}
        for name, text in cases.items():
            with self.subTest(name):
                model = self.write(name + ".yaml", text)
                out, err = self.freeplay("run", model, "--out", name, code=6)
                self.assertRegex(err, r"the run would write about [\d.]+ [TP]B \([\d.e+]+ rows of \d+ columns\) into '%s', more than "
                                      r"half of the [\d.]+ \wB that are free there \[too-large\]" % name)
                self.assertIn("--yes", err)
                self.assertEqual("", out)
                self.assertFalse(os.path.exists(self.path(name)))
        # Fewer columns, or fewer rows, fit.
        self.freeplay("run", "rows.yaml", "--out", "r", "--interval", "1000 s", "--step", "100 s", "--quiet")
        error = json.loads(self.freeplay("run", "rows.yaml", "--out", "rows", "--json", code=6)[0])["error"]
        self.assertEqual("too-large", error["messages"][0]["id"])
        self.freeplay("run", "rows.yaml", "--dry-run")

    def started(self, *words):
        """Messages of a run until its first row is there; then it is interrupted."""
        with subprocess.Popen([PROGRAM, "run", *words], cwd=self.folder, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL,
                              text=True) as process:
            while process.poll() is None and not os.path.exists(self.path("r", "checkpoint.bin")):
                time.sleep(0.01)
            time.sleep(0.3)
            process.send_signal(signal.SIGINT)
            _, err = process.communicate(timeout=60)
        self.assertEqual(130, process.returncode, err)
        return err

    def test_much_is_announced_and_yes_allows_more_than_half(self):
        self.write("large.yaml", MANY_ROWS % ("1e6", "0.01"))
        size = r"the run will write about %s \([\d.e+]+ rows of \d+ columns\) into 'r'; [\d.]+ \wB are free there\n"
        if shutil.disk_usage(self.folder).free > 200e9:
            self.assertRegex(self.started("large.yaml", "--out", "r"), size % r"[\d.]+ GB")
        self.write("larger.yaml", MANY_ROWS % ("1e6", "1e-6"))
        self.assertRegex(self.started("larger.yaml", "--out", "r", "--yes"), size % r"[\d.]+ TB")
        # What goes on has as many rows to write.
        self.assertIn("[too-large]", self.freeplay("run", "--resume", "r", code=6)[1])
        with subprocess.Popen([PROGRAM, "run", "--resume", "r", "--yes", "--quiet"], cwd=self.folder,
                              stderr=subprocess.DEVNULL) as process:
            while process.poll() is None and os.path.exists(self.path("r", "summary.json")):
                pass
            process.send_signal(signal.SIGTERM)
            self.assertEqual(130, process.wait(timeout=60))
        self.assertNotIn("will write", self.freeplay("run", mechanism("pendulum"), "--out", "p")[1])

    def test_two_runs_that_start_at_once_do_not_share_a_directory(self):
        self.write("long.yaml", MANY_ROWS % ("1e5", "1"))
        for force in ([], ["--force"]):
            words = [PROGRAM, "run", "long.yaml", "--quiet", "--out", "r", *force]
            both = [subprocess.Popen(words, cwd=self.folder, stderr=subprocess.PIPE, text=True) for _ in range(2)]
            refused = None
            while refused is None:
                refused = next((process for process in both if process.poll() is not None), None)
            other = both[1 - both.index(refused)]
            self.assertIsNone(other.poll())
            self.assertIn("[result-in-use]", refused.communicate()[1])
            self.assertEqual(6, refused.returncode)
            other.send_signal(signal.SIGINT)
            other.communicate(timeout=60)
            self.assertEqual(130, other.returncode)


if __name__ == "__main__":
    unittest.main()
