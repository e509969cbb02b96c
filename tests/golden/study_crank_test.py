"""freeplay study of the slider-crank: what is cut short goes on, rows are those of plain runs, and mistakes are refused."""
import csv
import glob
import json
import os
import re
import signal
import subprocess
import time
import unittest
import zlib

from program import PROGRAM, ProgramTest, mechanism

STUDY = """study:
  axes:
    c: [0.1 mm, 0.2 mm, -1 mm, 0.4 mm]
    joints.wrist.clearance.contact.restitution: {linspace: [0.6, 0.9, 3]}
  reducers:
    force: {channel: joint.wrist.fn, reduce: max}
    mean: {channel: joint.wrist.delta, reduce: mean}
    section: {channel: joint.wrist.ex, reduce: poincare, every: 1 ms}
"""
CHAIN = """study:
  set: {simulation.end: 2*2*pi/$speed}
  axes: {c: {linspace: [0.1 mm, 0.2 mm, 4]}}
  warm_start: {along: c, direction: both}
  reducers: {force: {channel: joint.wrist.fn, reduce: max}, section: {channel: joint.wrist.ex, reduce: poincare, every: 5 ms}}
"""
TABLES = ("study.csv", "samples.csv", "failures.jsonl", "study.h5")


def sealed(fields):
    """A line of a segment with its checksum."""
    text = b"\t".join(fields) + b"\t"
    return text + b"%08x\n" % zlib.crc32(text)


class StudyOfTheCrank(ProgramTest):
    def setUp(self):
        super().setUp()
        self.crank("crank.yaml", STUDY)

    def crank(self, name, study, end="4 ms"):
        """The shipped slider-crank, short, with a section `study`."""
        with open(mechanism("slider-crank"), encoding="utf-8") as file:
            text, found = re.subn(r"(?m)^simulation:.*$", "simulation: {end: %s, accuracy: 1 um}" % end, file.read())
        self.assertEqual(1, found)
        return self.write(name, text + study)

    def study(self, *words, **options):
        return self.freeplay("study", *words, **options)

    def run_study(self, out, *words, code=4, file="crank.yaml"):
        """The object of `run --json`; three points of the study above fail, which is exit code 4."""
        return json.loads(self.study("run", file, "--out", out, "--json", *words, code=code)[0])

    def tables(self, out):
        found = {}
        for name in TABLES:
            with open(self.path(out, name), "rb") as file:
                found[name] = file.read()
        return found

    def assert_same_tables(self, one, other):
        ours, theirs = self.tables(one), self.tables(other)
        for name in TABLES:
            self.assertTrue(ours[name] == theirs[name], "%s of %s and %s differ" % (name, one, other))

    def segment(self, out):
        (path,) = glob.glob(self.path(out, "rows", "*.rows"))
        return path

    def rows(self, out):
        """Numbers of the points whose rows are in the segments."""
        found = set()
        for path in glob.glob(self.path(out, "rows", "*.rows")):
            with open(path, "rb") as file:
                for line in file.read().splitlines(keepends=True):
                    if line[:1].isdigit() and sealed(line.split(b"\t")[:-1]) == line:
                        found.add(int(line.split(b"\t")[0]))
        return found

    def test_an_interrupt_ends_it_with_exit_code_130(self):
        self.crank("endless.yaml", STUDY, end="100 s")
        child = subprocess.Popen([PROGRAM, "study", "run", "endless.yaml", "--jobs", "1", "--out", "cut"], cwd=self.folder,
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        until = time.time() + 60
        while time.time() < until and not os.path.exists(self.path("cut", "study.json")):
            time.sleep(0.01)
        child.send_signal(signal.SIGTERM)
        self.assertEqual(130, child.wait(timeout=60))
        self.assertTrue(os.path.exists(self.path("cut", "study.json")))

    def test_shards_in_directories_of_their_own_make_the_table_of_the_whole(self):
        self.run_study("whole")
        for number in (2, 3, 1):
            self.run_study("own%d" % number, "--shard", "%d/3" % number, "--allow-failed", code=0)
        self.assertIn("study-gaps", self.study("merge", "own1", "own2", code=3)[1])
        self.study("merge", "own1", "own2", "own3", "--out", "all")
        self.assert_same_tables("whole", "all")

    def test_status_counts_a_study_that_runs(self):
        self.crank("endless.yaml", "study:\n  axes: {simulation.end: [1 ms, 100 s, 100 s]}\n"
                                   "  reducers: {force: {channel: joint.wrist.fn, reduce: max}}\n")
        child = subprocess.Popen([PROGRAM, "study", "run", "endless.yaml", "--jobs", "1", "--out", "runs"], cwd=self.folder,
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            until = time.time() + 60
            while time.time() < until and not self.rows("runs"):
                time.sleep(0.01)
            status = json.loads(self.study("status", "runs", "--json")[0])
        finally:
            child.terminate()
            child.wait(timeout=60)
        self.assertEqual([1, 2, 1], [status[key] for key in ("done", "left", "active")])

    def test_a_point_is_one_plain_command_with_the_numbers_of_its_row(self):
        self.run_study("out")
        row = list(csv.DictReader(self.read("out", "study.csv").splitlines()))[4]
        point = json.loads(self.study("point", "out", "4", "--json")[0])
        self.assertEqual(4, point["index"])
        self.study("point", "out", "4", "--run", "--out", "four")
        force = json.loads(self.read("four", "summary.json"))["joints"]["wrist"]["max_fn"]
        self.assertEqual(float(row["force"]), force)

    def test_reducers_and_summaries_have_one_window(self):
        # Where the force falls at the instant that is left out, its peak is there: who begins a step later has another one.
        study = """study:
  axes: {simulation.output.discard: {linspace: [0.3 ms, 3.9 ms, 41]}}
  reducers:
    fn: {channel: joint.wrist.fn, reduce: max}
    reported: {summary: joints.wrist.max_fn}
    depth: {channel: joint.wrist.delta, reduce: max}
    reported_depth: {summary: joints.wrist.max_delta}
    play: {joint: wrist, set: clearance}
    hits: {events: wrist, reduce: count}
"""
        self.crank("window.yaml", study, end="4 ms, output: {discard: 1 ms}")
        self.run_study("w", file="window.yaml", code=0)
        rows = list(csv.DictReader(self.read("w", "study.csv").splitlines()))
        for row in rows:
            self.assertEqual((row["reported"], row["reported_depth"], row["play.wrist.contacts"]), (row["fn"], row["depth"], row["hits"]), row)
        self.assertLess(5, len({row["fn"] for row in rows}))

    def test_verify_finds_a_forged_row(self):
        self.run_study("out", "--jobs", "1")
        self.assertIn("same", self.study("verify", "out", "--points", "12")[0])
        with open(self.segment("out"), "rb") as file:
            lines = file.read().splitlines(keepends=True)
        at = next(i for i, line in enumerate(lines) if line[:1].isdigit() and line.split(b"\t")[2] == b"0")
        fields = lines[at].split(b"\t")[:-1]
        fields[7] = repr(float(fields[7]) * (1 + 1e-12)).encode()
        forged = sealed(fields)
        with open(self.segment("out"), "wb") as file:
            file.write(b"".join(lines[:at] + [forged] + lines[at + 1:]))
        self.study("merge", "out")
        self.assertIn("differs: force", "".join(self.study("verify", "out", "--points", "12", code=7)))

    def test_a_torn_row_runs_again(self):
        self.run_study("whole")
        self.run_study("torn", "--jobs", "1")
        with open(self.segment("torn"), "r+b") as file:
            file.truncate(os.path.getsize(self.segment("torn")) - 5)
        self.assertEqual(1, self.run_study("torn")["ran"])
        self.assert_same_tables("whole", "torn")

    def test_a_chain_that_was_cut_goes_on_from_where_it_ended(self):
        self.crank("chain.yaml", CHAIN)
        self.run_study("whole", file="chain.yaml", code=0)
        rows = list(csv.DictReader(self.read("whole", "study.csv").splitlines()))
        self.assertEqual(["cold"] + 7 * ["warm"], [row["start"] for row in rows])
        self.assertEqual(3, self.run_study("cut", "--only", "2", file="chain.yaml", code=0)["ran"])
        self.assertEqual(5, self.run_study("cut", file="chain.yaml", code=0)["ran"])
        self.assertEqual(self.read("whole", "study.csv"), self.read("cut", "study.csv"))

    def test_a_chain_is_as_if_nothing_had_happened_once_its_failed_point_is_good(self):
        self.crank("chain.yaml", CHAIN)
        self.run_study("whole", "--jobs", "1", file="chain.yaml", code=0)
        self.run_study("late", "--only", "2", "--jobs", "1", file="chain.yaml", code=0)
        with open(self.segment("late"), "rb") as file:
            lines = file.read().splitlines(keepends=True)
        row = lines[-1].split(b"\t")
        self.assertEqual(b"2", row[0])
        kept = [line for line in lines if line.split(b"\t")[0] not in (b"+2", b"@2", b"2")]
        failed = sealed([b"!2", b"it took long"]) + sealed([b"@2", b"", b"0", b""]) + sealed([b"2", row[1], b"4", b"timeout", b"0", b"0", b"0"])
        with open(self.segment("late"), "wb") as file:
            file.write(b"".join(kept) + failed)
        self.assertEqual(5, self.run_study("late", file="chain.yaml")["ran"])
        rows = list(csv.DictReader(self.read("late", "study.csv").splitlines()))
        self.assertEqual(["cold", "warm", "", "cold"] + 4 * ["warm"], [row["start"] for row in rows])
        self.assertEqual(0, self.run_study("late", file="chain.yaml")["ran"])
        self.assertEqual(2, self.run_study("late", "--retry-failed", "--only", "3", file="chain.yaml", code=0)["ran"])
        status = json.loads(self.study("status", "late", "--json")[0])
        self.assertEqual([4, 4, 0], [status[key] for key in ("done", "left", "failed")])
        self.assertIn("study-gaps", self.study("merge", "late", code=3)[1])
        self.study("merge", "late", "whole", "--out", "both")
        self.assert_same_tables("whole", "both")
        self.assertEqual(4, self.run_study("late", file="chain.yaml", code=0)["ran"])
        self.assert_same_tables("whole", "late")
        self.assertEqual("8 points: same\n", self.study("verify", "late")[0])

    def test_shipped_studies_plan_without_a_message(self):
        for name, points in (("clearance-bifurcation", 800), ("speed-bifurcation", 800), ("tolerance-bound", 160000),
                             ("tolerance-motion", 2000), ("3-rrr-vs-4-rrr/series", 22), ("3-rrr-vs-4-rrr/ideal", 8)):
            with self.subTest(study=name):
                out, err = self.study("plan", mechanism(os.path.join("studies", name)), "--probe", "0", "--json")
                self.assertEqual("", err)
                self.assertEqual(points, json.loads(out)["points"])
        told = self.run_study("bound", "--only", "0,20000,60000,159999", file=mechanism("studies/tolerance-bound"), code=0)
        self.assertEqual([4, 0], [told["done"], told["failed"]])
        self.study("merge", "bound", "--partial")
        rows = list(csv.DictReader(self.read("bound", "study.csv").splitlines()))
        self.assertEqual(["H7/g6", "H7/f7", "H8/e8", "H8/e8"], [row["loose.fit"] for row in rows])
        for row, (low, high) in zip(rows, ((2.5, 14.5), (6.5, 21.5), (12.5, 34.5), (12.5, 34.5))):  # ISO 286 on 10 mm [um]
            plays = [float(row[name]) for name in row if name.endswith("radial_clearance") and row[name]]
            self.assertEqual(8 if row["model"] == "four" else 6, len(plays))
            self.assertTrue(all(1e-6 * low <= play <= 1e-6 * high for play in plays), row)

    def test_mistakes_are_refused_before_anything_runs(self):
        for words, code, said in (
                (["run", "crank.yaml", "--shard", "5/4"], 2, ["--shard", "I from 1 to N, here from 1 to 4"]),
                (["run", "crank.yaml", "--shard", "a/b"], 2, ["I from 1 to N"]),
                (["run", "crank.yaml", "--only", "99"], 2, ["--only"]),
                (["run", "crank.yaml", "--keep", "al"], 2, ["--keep", "'all'"]),
                (["run", "crank.yaml", "--set", "cc=1mm"], 2, ["cc"]),
                (["run", mechanism("slider-crank")], 3, ["missing-key", "study"]),
                (["status", "nowhere"], 3, ["file-not-found", "nowhere"]),
                (["point", "nowhere", "1"], 3, ["file-not-found"]),
                (["runn", "crank.yaml"], 2, ["runn"]),
                ([], 2, ["study"])):
            with self.subTest(words=words):
                err = self.study(*words, code=code)[1]
                for word in said:
                    self.assertIn(word, err)
        for old, new, said in (
                ("c: [0.1 mm, 0.2 mm, -1 mm, 0.4 mm]", "c: []", ["wrong-length"]),
                ("c: [0.1 mm, 0.2 mm, -1 mm, 0.4 mm]", "c: {fit: [H7/g6, H7/h6], diameter: 10 mm}",
                 ["out-of-range", "the radial clearance of H7/h6 on 10 mm is 0 to 12 um"]),
                ("c: [0.1 mm, 0.2 mm, -1 mm, 0.4 mm]", "c: {fit: [H7/g6, H7/q6], diameter: 10 mm}", ["bad-fit", "'H7/q6'"]),
                ("c: [0.1 mm, 0.2 mm, -1 mm, 0.4 mm]", "c: {fit: [H7/g6, H7/g6], diameter: 10 mm}", ["duplicate-name", "twice"]),
                ("    c:", "    cc:", ["unknown-name", "cc"]),
                ("joints.wrist.clearance", "joints.wirst.clearance", ["unknown-name", "'joints.wrist.clearance.contact.restitution'"]),
                ("0.9, 3]", "0.9, 100000000]", ["too-large", "--yes"]),
                ("every: 1 ms", "every: 1e-16 s", ["too-large", "at most 10^7 values"]),
                ("reduce: mean", "reduce: mean, from: 2 ms, until: 1 ms", ["out-of-range", "ends at 0.001 s, before it begins"]),
                ("joint.wrist.fn", "joint.wrist.fnn", ["unknown-name", "joint.wrist.fn"])):
            with self.subTest(new=new):
                self.assertIn(old, STUDY)
                self.crank("wrong.yaml", STUDY.replace(old, new))
                err = self.study("run", "wrong.yaml", "--out", "wrong", code=3)[1]
                for word in ["wrong.yaml:", *said]:
                    self.assertIn(word, err)
        self.assertFalse(os.path.exists(self.path("wrong")))
        self.assertFalse(os.path.exists(self.path("results")))

    def test_a_column_that_begins_after_the_run_is_doubted(self):
        self.crank("late.yaml", STUDY.replace("reduce: mean", "reduce: mean, from: 2 s"))
        err = self.study("plan", "late.yaml", "--probe", "0", code=0)[1]
        self.assertRegex(err, r"late\.yaml:\d+:\d+: warning: the time begins at 2 s, but at the values of the file the run ends at")
        self.crank("late.yaml", STUDY)
        self.assertEqual("", self.study("plan", "late.yaml", "--probe", "0", code=0)[1])


if __name__ == "__main__":
    unittest.main()
