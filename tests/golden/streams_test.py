"""Exit codes whatever becomes of the output: closed pipes, full devices, closed descriptors."""
import os
import subprocess

from program import PROGRAM, ProgramTest, mechanism

BAD = "freeplay: 1\nbodies: {a: {mas: 1}}\n"
FALL = """freeplay: 1
gravity: [0, -9.81]
parameters: {m: 1 kg}
bodies: {b: {mass: $m, inertia: 1}}
joints: {slide: {type: prismatic, between: [ground, b]}}
simulation: {end: 10 ms, step: 1 ms}
"""
# The path of its driver ends before the run does.
FAILS = """freeplay: 1
bodies: {b: {mass: 1, inertia: 1}}
joints: {slide: {type: prismatic, between: [ground, b]}}
drivers: {m: {joint: slide, kind: position, table: {points: [[0, 0], [1 ms, 1 mm]], interpolation: linear, outside: error}}}
simulation: {end: 10 ms, step: 1 ms}
"""


class Streams(ProgramTest):
    def into_closed_pipe(self, *arguments, **options):
        """Exit code and stderr of a command whose reader has gone before the first word."""
        reader, writer = os.pipe()
        os.close(reader)
        done = subprocess.run([PROGRAM, *arguments], stdout=writer, stderr=subprocess.PIPE, cwd=self.folder, text=True,
                              **options)
        os.close(writer)
        return done.returncode, done.stderr

    def into_full_device(self, *arguments):
        with open("/dev/full", "w") as full:
            done = subprocess.run([PROGRAM, *arguments], stdout=full, stderr=subprocess.PIPE, cwd=self.folder,
                                  text=True)
        return done.returncode, done.stderr

    def commands(self):
        """Command and exit code, several commands for each code."""
        self.write("good.yaml", FALL)
        self.write("bad.yaml", BAD)
        self.write("fails.yaml", FAILS)
        self.freeplay("run", "good.yaml", "--out", "a", "--quiet")
        self.freeplay("run", "good.yaml", "--out", "b", "--quiet", "--set", "m=2 kg")
        self.write("c.csv", "time,body.b.x\n0,1\n1,2\n")
        self.write("d.csv", "time,body.b.x\n0,1\n1,3\n")
        crank = mechanism("four-bar")
        return [
            (0, ["list"]), (0, ["--help"]), (0, ["--version"]), (0, ["run", "--help"]), (0, ["schema"]),
            (0, ["describe", "bathe"]), (0, ["doctor"]), (0, ["validate", "good.yaml"]), (0, ["show", crank]),
            (0, ["show", crank, "--format", "svg"]), (0, ["run", "good.yaml"]), (0, ["run", "good.yaml", "--json"]),
            (0, ["run", "good.yaml", "--profile"]), (0, ["compare", "a", "b", "--channels", "body.*.x"]),
            (0, ["analyze", "ik", mechanism("3-rrr")]), (0, ["list", "channels", "good.yaml"]),
            (0, ["init", "--from", "list"]), (2, []), (2, ["--json"]), (2, ["rnu", "--json"]),
            (3, ["validate", "bad.yaml"]), (3, ["validate", "good.yaml", "bad.yaml"]),
            (3, ["validate", "bad.yaml", "--json"]), (3, ["run", "bad.yaml", "--json"]), (3, ["show", "none", "--json"]),
            (4, ["run", "fails.yaml"]), (4, ["run", "fails.yaml", "--json"]), (5, ["check-plugin", "none.so"]),
            (7, ["compare", "c.csv", "d.csv"]), (7, ["compare", "c.csv", "d.csv", "--json"]),
            (6, ["compare", "a", "none", "--json"]),
        ]

    def test_a_closed_pipe_leaves_the_exit_code_and_a_full_device_is_a_failure_unless_there_is_another(self):
        for code, arguments in self.commands():
            expected = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True)
            self.assertEqual(code, expected.returncode, arguments)
            self.assertEqual((code, expected.stderr), self.into_closed_pipe(*arguments), arguments)
            if not expected.stdout:
                continue
            found, err = self.into_full_device(*arguments)
            self.assertEqual(code or 6, found, arguments)
            self.assertIn("cannot write to stdout: No space left on device", err)

    def test_a_run_without_reader_writes_its_results(self):
        self.write("good.yaml", FALL)
        self.assertEqual((0, ""), self.into_closed_pipe("run", "good.yaml", "--out", "r"))
        self.freeplay("run", "good.yaml", "--out", "s")
        for name in ("results.csv", "events.csv", "model.yaml"):
            self.assertEqual(self.read("s", name), self.read("r", name))

    def test_closed_descriptors_are_not_taken_by_files(self):
        # The kinematic warning of a jump goes to stderr, which is closed.
        self.write("jump.yaml", FAILS.replace("outside: error", "outside: hold"))
        _, err = self.freeplay("run", "jump.yaml", "--out", "whole")
        self.assertIn("warning", err)
        for closed in ("0<&-", "1>&-", "2>&-", "0<&- 1>&- 2>&-"):
            done = subprocess.run(["sh", "-c", 'exec "$0" run jump.yaml --out r ' + closed, PROGRAM], cwd=self.folder,
                                  capture_output=True)
            self.assertEqual(0, done.returncode, closed)
            for name in ("results.csv", "events.csv", "model.yaml"):
                self.assertEqual(self.read("whole", name), self.read("r", name), closed)
            self.assertEqual(self.read("whole", "summary.json").count("\n"), self.read("r", "summary.json").count("\n"))

    def test_closed_descriptors_leave_exit_codes(self):
        self.write("bad.yaml", BAD)
        for closed in ("0<&-", "1>&-", "2>&-", "0<&- 1>&- 2>&-"):
            done = subprocess.run(["sh", "-c", 'exec "$0" validate bad.yaml ' + closed, PROGRAM], cwd=self.folder,
                                  capture_output=True)
            self.assertEqual(3, done.returncode, closed)


if __name__ == "__main__":
    import unittest
    unittest.main()
