"""Runs that are killed, interrupted or refused, and what `run --resume` makes of them."""
import hashlib
import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import time
import unittest

from program import PROGRAM, ProgramTest, mechanism

CRANK = mechanism("slider-crank")


HELD = """freeplay: 1
name: held-rod
gravity: [0, -9.81]
bodies: {rod: {mass: 1 kg, inertia: "1 kg*m^2 / 12", com: [0.5, 0]}}
joints: {pivot: {type: revolute, between: [ground, rod]}}
drivers: {motor: {joint: pivot, kind: torque, input: 0 N*m}}
simulation: {end: 20 s, step: 0.1 ms, output: {interval: 10 ms}}
"""


def other_arithmetic(checkpoint):
    """A checkpoint as a machine with other elementary functions would have written it."""
    data = re.sub(rb'("arithmetic":\s*")[0-9a-f]{16}', rb"\g<1>0123456789abcdef", checkpoint[:-64])
    return data + hashlib.sha256(data).hexdigest().encode()


class Resume(ProgramTest):
    model = CRANK

    def run_model(self, name, *options):
        return self.freeplay("run", self.model, "--quiet", "--out", name, *options)

    def whole(self, *options):
        """Not disturbed; how long it took [s]."""
        began = time.monotonic()
        self.run_model("whole", *options, "--force")
        return time.monotonic() - began

    def ended_early(self, name, number, after, *options):
        """Gives a run a signal some seconds after its first checkpoint. Returns its exit code."""
        with subprocess.Popen([PROGRAM, "run", self.model, "--quiet", "--out", name, *options], cwd=self.folder,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            while process.poll() is None and not os.path.exists(self.path(name, "checkpoint.bin")):
                time.sleep(0.005)
            time.sleep(after)
            process.send_signal(number)
        return process.returncode

    def interrupted(self, number, seconds, *options):
        """The directory of a run that ended before its end; on a machine that is busy it may take more than one."""
        for attempt in range(5):
            name = "cut%d-%d" % (number, attempt)
            if self.ended_early(name, number, seconds / 2 ** (attempt + 1), *options) == 130:
                return name
        return self.fail("no run of five was interrupted")

    def assert_same(self, a, b):
        for name in ("results.csv", "events.csv"):
            self.assertTrue(self.read(a, name) == self.read(b, name), name)
        summaries = []
        for folder in (a, b):
            summary = json.loads(self.read(folder, "summary.json"))
            del summary["performance"], summary["model"]["file"], summary["provenance"]["command"]
            summaries.append(summary)
        self.assertEqual(*summaries)

    def test_a_killed_run_goes_on_to_the_same_bytes(self):
        draw = random.Random(1)
        for options in (("--end", "0.1 s"), ("--end", "0.3 s", "--accuracy", "1um")):
            options += ("--checkpoint", "25 ms")
            seconds = self.whole(*options)
            for again in range(3):
                with self.subTest(options=options, again=again):
                    name = "killed%d-%d" % (len(options), again)
                    self.ended_early(name, signal.SIGKILL, draw.uniform(0.1, 0.9) * seconds, *options)
                    self.freeplay("run", "--resume", name, "--quiet")
                    self.assert_same(name, "whole")

    def test_an_interrupted_run_has_a_checkpoint_and_rows_of_the_whole_one(self):
        options = ("--end", "0.1 s", "--checkpoint", "0")
        seconds = self.whole(*options)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(number):
                name = self.interrupted(number, seconds, *options)
                part = self.read(name, "results.csv")
                self.assertTrue(self.read("whole", "results.csv").startswith(part))
                self.freeplay("run", "--resume", name, "--quiet")
                self.assert_same(name, "whole")
                self.assertIn("resumed from t = ", self.read(name, "run.log"))

    def test_an_interrupt_while_the_directory_is_made_leaves_a_summary(self):
        for run in range(24):
            out = "early%d" % run
            process = subprocess.Popen([PROGRAM, "run", mechanism("4-rrr"), "--end", "100 s", "--out", out],
                                       cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            while not os.path.exists(self.path(out)):
                self.assertIsNone(process.poll())
            time.sleep(0.25e-3 * run)
            process.send_signal(signal.SIGTERM)
            self.assertEqual(130, process.wait(timeout=60))
            self.assertEqual("interrupted", json.loads(self.read(out, "summary.json"))["status"])

    def test_of_a_damaged_hdf5_file_the_text_has_the_rows(self):
        options = ("--end", "0.1 s", "--checkpoint", "0")
        name = self.interrupted(signal.SIGTERM, self.whole(*options), *options)
        with open(self.path(name, "results.h5"), "r+b") as file:
            for place in range(os.path.getsize(file.name) // 8, os.path.getsize(file.name), 997):
                file.seek(place)
                file.write(b"torn")
        self.freeplay("export", name + "/results.h5", "--to", "csv", "--out", "no.csv", code=6)
        self.freeplay("run", "--resume", name, "--quiet")
        self.assert_same(name, "whole")
        os.rename(self.path(name, "results.csv"), self.path("text.csv"))
        self.freeplay("compare", name + "/results.h5", "text.csv")

    def test_a_run_with_inputs_goes_on_with_those_that_it_began_with(self):
        self.model = self.write("held.yaml", HELD)
        self.write("course.csv", "time,motor\n0,1\n0.0137,2\n3,-1\n7.77,0.5\n90,0\n")
        options = ("--inputs", "course.csv", "--checkpoint", "0")
        name = self.interrupted(signal.SIGTERM, self.whole(*options), *options)
        self.write("course.csv", "time,motor\n0,1\n")
        before = self.read(name, "results.csv")
        _, refused = self.freeplay("run", "--resume", name, code=3)
        self.assertRegex(refused, r"'course.csv' of the inputs is not that of the run.*\[resume-mismatch\]")
        self.assertTrue(before == self.read(name, "results.csv"))
        os.remove(self.path("course.csv"))  # the copy in the result serves
        self.freeplay("run", "--resume", name, "--quiet")
        self.assert_same(name, "whole")
        self.assertTrue(self.read(name, "inputs.csv") == self.read("whole", "inputs.csv"))

    def test_rows_and_events_that_were_changed_are_found(self):
        options = ("--end", "0.1 s", "--checkpoint", "0")
        name = self.interrupted(signal.SIGTERM, self.whole(*options), *options)
        for file in ("results.csv", "events.csv"):
            changed = "changed-" + file
            shutil.copytree(self.path(name), self.path(changed))
            text = self.read(changed, file)
            after_time = text.index(",", text.index("\n", len(text) // 3))  # rows whose times do not grow are refused otherwise
            place = next(i for i in range(after_time, len(text)) if text[i] in "12345678")
            self.write(os.path.join(changed, file), text[:place] + str(int(text[place]) + 1) + text[place + 1:])
            _, err = self.freeplay("run", "--resume", changed, "--quiet", code=6)
            self.assertIn("'%s' was changed" % os.path.join(changed, file), err)
        self.freeplay("run", "--resume", name, "--quiet")
        self.assert_same(name, "whole")

    def test_a_run_that_was_killed_twice_after_its_last_row_begins_again(self):
        self.whole("--end", "0.1 s")
        shutil.copytree(self.path("whole"), self.path("again"))
        os.remove(self.path("again", "summary.json"))  # killed before it was written
        self.write(os.path.join("again", "results.csv"), "".join(self.read("again", "results.csv").splitlines(True)[:9]))
        self.freeplay("run", "--resume", "again", "--quiet")  # whose rows another one was killed at
        self.assert_same("again", "whole")

    def test_a_limit_of_file_sizes_leaves_rows_that_are_named_and_gone_on_from(self):
        self.whole("--end", "0.1 s", "--format", "both")
        for format_, largest in (("both", "results.csv"), ("hdf5", "results.h5")):
            limit = os.path.getsize(self.path("whole", largest)) // 2
            name = "limited-" + format_
            done = subprocess.run([PROGRAM, "run", CRANK, "--quiet", "--out", name, "--end", "0.1 s", "--format", format_],
                                  cwd=self.folder, capture_output=True, text=True, check=False,
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
            self.assertEqual(done.returncode, 6, done.stderr)
            self.assertRegex(done.stderr, "rows up to t = [0-9.]+ s are safe; free some space and go on with freeplay run "
                                          "--resume " + name)
            summary = json.loads(self.read(name, "summary.json"))
            rows, _ = self.freeplay("export", name, "--to", "csv", "--channels", "time")
            self.assertGreater(summary["counts"]["rows"], 0)
            self.assertLessEqual(summary["counts"]["rows"], rows.count("\n") - 1)
            self.freeplay("run", "--resume", name, "--quiet")
            if format_ == "both":
                self.assert_same(name, "whole")

    def test_a_result_that_had_no_room_for_its_tables_is_gone_on_from(self):
        self.whole("--end", "10 ms", "--interval", "1 ms", "--format", "both")
        limit = 20 * 1024  # results.h5 cannot be made
        done = subprocess.run([PROGRAM, "run", CRANK, "--quiet", "--out", "full", "--end", "10 ms", "--interval", "1 ms", "--format", "both"],
                              cwd=self.folder, capture_output=True, text=True, check=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        self.assertEqual(6, done.returncode, done.stderr)
        self.assertIn("no rows are safe; free some space and go on with freeplay run --resume full", done.stderr)
        self.freeplay("run", "--resume", "full", "--quiet")
        self.assert_same("full", "whole")

    def test_a_later_end_gives_the_run_to_that_end(self):
        self.run_model("whole", "--end", "24 ms", "--interval", "0.1 ms")
        for first in ("10.00037 ms", "12 ms"):
            self.run_model("longer", "--end", first, "--interval", "0.1 ms")
            self.freeplay("run", "--resume", "longer", "--end", "24 ms", "--quiet")
            self.assert_same("longer", "whole")

    def test_what_does_not_fit_is_refused_and_nothing_is_changed(self):
        self.run_model("done", "--end", "5 ms", "--interval", "0.1 ms")

        def change(name, edit):
            path = self.path("done", name)
            with open(path, "rb") as file:
                data = file.read()
            with open(path, "wb") as file:
                file.write(edit(data))
            return path, data

        def files():
            found = {}
            for name in sorted(os.listdir(self.path("done"))):
                if name != "run.log":
                    with open(self.path("done", name), "rb") as file:
                        found[name] = file.read()
            return found

        cases = [
            (0, "nothing to do", (), None),
            (2, "--set does not go with --resume", ("--set", "c=1mm"), None),
            (2, "MODEL does not go with --resume", (CRANK,), None),
            (2, "is to end at 0.005 s: it can end later, not before", ("--end", "1 ms"), None),
            (2, "it must not be negative", ("--checkpoint", "-1"), None),
            (3, "resume-mismatch", ("--end", "9 ms"), ("model.yaml", lambda d: d + b"# another\n")),
            (3, "the program's arithmetic is not that of the run", ("--end", "9 ms"), ("checkpoint.bin", other_arithmetic)),
            (6, "bad-checkpoint", ("--end", "9 ms"), ("checkpoint.bin", lambda d: d[:-70] + b"x" + d[-69:])),
            (6, "bad-checkpoint", ("--end", "9 ms"), ("checkpoint.bin", lambda d: d[:100])),
            (6, "bad-checkpoint", ("--end", "9 ms"), ("results.csv", lambda d: d[:len(d) // 2])),
        ]
        for code, words, options, spoiled in cases:
            with self.subTest(words=words, options=options):
                kept = change(*spoiled) if spoiled else None
                before = files()
                out, err = self.freeplay("run", "--resume", "done", *options, code=code)
                self.assertIn(words, out + err)
                self.assertEqual(files(), before)
                if kept:
                    with open(kept[0], "wb") as file:
                        file.write(kept[1])
        os.remove(self.path("done", "checkpoint.bin"))
        for folder, words in (("done", "no-checkpoint"), ("nowhere", "unreadable-result")):
            _, err = self.freeplay("run", "--resume", folder, code=6)
            self.assertIn(words, err)
        self.freeplay("run", CRANK, "--checkpoint", "often", code=2)


if __name__ == "__main__":
    unittest.main()
