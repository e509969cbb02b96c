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
simulation: {end: 1 s, step: 1 ms, output: {interval: 0.1 us}}
"""

PENDULUMS = """freeplay: 1
gravity: [0, -9.81]
templates:
  pendulum:
    bodies: {rod: {mass: 1 kg, inertia: 0.02, com: [0.5, 0]}}
    joints: {pin: {type: revolute, between: [ground, rod]}}
instances: {a: {template: pendulum, count: 600}}
simulation: {end: 2 ms, step: 1 ms, output: {interval: 1 ms}}
"""

SANITIZED = os.path.basename(BUILD) == "sanitize"  # which reserves more addresses than any limit allows
WORDS = {"no-memory": "the system gives no more memory", "no-threads": "the system gives no more threads",
         "cannot-write": "cannot write"}


class Room(ProgramTest):
    @staticmethod
    def write_little():
        """A program that does not refuse is ended before it fills the disk."""
        resource.setrlimit(resource.RLIMIT_FSIZE, (100 << 20, 100 << 20))

    def test_more_than_half_of_the_room_is_refused_before_anything_is_made(self):
        cases = {"rows": MANY_ROWS % ("1e6", "1e-6"), "bodies": MANY_BODIES % 40000}
        for name, text in cases.items():
            with self.subTest(name):
                model = self.write(name + ".yaml", text)
                out, err = self.freeplay("run", model, "--out", name, code=6, preexec_fn=self.write_little)
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
        shutil.rmtree(self.path("r"), ignore_errors=True)
        with subprocess.Popen([PROGRAM, "run", *words], cwd=self.folder, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL,
                              text=True) as process:
            while process.poll() is None and not os.path.exists(self.path("r", "checkpoint.bin")):
                time.sleep(0.01)
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


@unittest.skipIf(SANITIZED, "sanitizers want all addresses")
class System(ProgramTest):
    def limited(self, words, kind, limit, user=None):
        """Exit code and messages under a limit; None where the program could not even start."""
        def shrink():
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            if user:
                os.setgid(user)
                os.setuid(user)
            resource.setrlimit(kind, (limit, limit))
        done = subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, text=True, preexec_fn=shrink, timeout=300)
        return done.returncode, done.stdout, done.stderr

    def test_any_amount_of_memory_gives_a_result_or_a_message(self):
        crank = mechanism("slider-crank")
        commands = [("run", crank, "--end", "1 ms", "--quiet", "--out", "r"), ("validate", mechanism("4-rrr"), "--quiet"),
                    ("analyze", "error", mechanism("3-rrr"), "--grid", "x=-0.1:0.1:8", "--grid", "y=-0.1:0.1:8"),
                    ("export", "done", "--to", "csv", "--table", "spectra", "--channels", "body.slider.x")]
        self.freeplay("run", crank, "--quiet", "--end", "50 ms", "--out", "done")
        self.write("pendulums.yaml", PENDULUMS)
        commands.append(("run", "pendulums.yaml", "--format", "csv", "--quiet", "--out", "r"))
        enough = 400
        least = next(mb for mb in range(10, enough) if self.limited(["--version"], resource.RLIMIT_AS, mb << 20)[0] == 0)
        for words in commands:
            seen = set()
            good = 0
            for mb in [least + k / 2 for k in range(40)] + [least + k for k in range(20, 120, 3)] + [enough]:
                if good > 2:  # more is enough, too
                    break
                with self.subTest(words=words, mb=mb):
                    shutil.rmtree(self.path("r"), ignore_errors=True)
                    code, _, err = self.limited(words, resource.RLIMIT_AS, int(mb * (1 << 20)))
                    seen.add(code)
                    good = good + 1 if code == 0 else 0
                    if code == 0:
                        continue
                    self.assertEqual(6, code, err)
                    self.assertTrue(any(text in err and "[%s]" % name in err for name, text in WORDS.items()), err)
            self.assertIn(0, seen, words)

    def test_no_threads_and_no_processes_are_messages(self):
        user = 65534 if os.geteuid() == 0 else None
        os.chmod(self.folder, 0o777)
        code, out, err = self.limited(["--version"], resource.RLIMIT_NPROC, 1, user)
        if code != 0:
            self.skipTest("another user may not run the program")
        model = self.write("crank.yaml", self.text_of("slider-crank"))
        code, out, err = self.limited(["run", model, "--end", "1 ms", "--json", "--out", "r"], resource.RLIMIT_NPROC, 1, user)
        self.assertEqual((6, "no-threads"), (code, json.loads(out)["error"]["messages"][0]["id"]), err)
        for options in (("--twin",), ("--repeat", "2")):
            code, out, err = self.limited(["run", model, "--end", "1 ms", "--out", "r", *options], resource.RLIMIT_NPROC, 1, user)
            self.assertEqual(6, code, err)
            self.assertRegex(err, r"cannot start a process: .* \[no-process\]")
        # An analysis does alone what others would help with.
        model = self.write("robot.yaml", self.text_of("3-rrr"))
        words = ["analyze", "error", model, "--grid", "x=-0.1:0.1:5", "--grid", "y=-0.1:0.1:5"]
        self.assertEqual(self.freeplay(*words)[0], self.limited(words, resource.RLIMIT_NPROC, 1, user)[1])

    @staticmethod
    def text_of(name):
        with open(mechanism(name), encoding="utf-8") as file:
            return file.read()


if __name__ == "__main__":
    unittest.main()
