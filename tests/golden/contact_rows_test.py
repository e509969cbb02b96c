"""Rows inside of contacts: `output: {rows_in_contact: N}`."""
import csv
import json
import math
import os
import re
import shutil
import signal
import subprocess
import time
import unittest

from program import PROGRAM, ProgramTest, mechanism

PART = 1e-6  # of a peak
# Model, its end and options: several contacts of one joint, and of six at once.
CASES = [("slider-crank", "16 ms", ("--step", "1 us")), ("slider-crank", "16 ms", ("--accuracy", "1um")),
         ("slider-crank", "16 ms", ("--accuracy", "1um", "--integrator", "verner7")),
         ("3-rrr", "0.15 s", ("--step", "2 us")), ("3-rrr", "0.15 s", ("--accuracy", "1um"))]


class ContactRows(ProgramTest):
    def model(self, name, rows, output=""):
        """A shipped model with so many rows in each impact."""
        with open(mechanism(name), encoding="utf-8") as file:
            text = file.read()
        text, count = re.subn(r"output: \{", "output: {rows_in_contact: %s, %s" % (rows, output), text)
        self.assertEqual(1, count)
        return self.write("%s-%s.yaml" % (name, rows), text)

    def run_model(self, model, *options, out="r"):
        self.freeplay("run", model, "--out", out, "--force", "--quiet", *options)
        rows = list(csv.DictReader(self.read(out, "results.csv").splitlines()))
        events = list(csv.DictReader(self.read(out, "events.csv").splitlines()))
        return rows, events, json.loads(self.read(out, "summary.json"))

    def test_peaks_of_the_rows_are_those_of_the_table_and_of_every_contact(self):
        for name, end, options in CASES:
            with self.subTest(name, options=options):
                rows, events, summary = self.run_model(self.model(name, 1), "--end", end, *options)
                self.check_contacts(rows, events)
                counted = [row for row in rows if float(row["time"]) >= summary["statistics"]["from"]]
                self.assertEqual(len(rows), summary["counts"]["rows"])
                with_play = [joint for joint, figures in summary["joints"].items() if figures["max_fn"] is not None]
                self.assertTrue(with_play)
                for joint in with_play:
                    for key, channel in (("max_fn", "fn"), ("max_delta", "delta")):
                        peak = summary["joints"][joint][key]
                        of_rows = max(float(row["joint.%s.%s" % (joint, channel)]) for row in counted)
                        self.assertLessEqual(abs(of_rows - peak), PART * peak, (joint, key))

    def check_contacts(self, rows, events):
        times = [float(row["time"]) for row in rows]
        seen = 0
        for event in events:
            if event["kind"] != "contact_end" or float(event["steps"]) < 4:
                continue
            until = float(event["time"])
            inside = [row for t, row in zip(times, rows) if until - float(event["duration"]) <= t <= until]
            for key, channel in (("max_fn", "fn"), ("max_delta", "delta")):
                column = "joint.%s.%s" % (event["joint"], channel)
                of_rows = max((float(row[column]) for row in inside), default=0.0)
                self.assertLessEqual(abs(of_rows - float(event[key])), PART * of_rows, (key, event))
            seen += 1
        self.assertGreater(seen, 5)

    def check_events(self, more, grid):
        """The same events; peaks that the further rows found may be larger."""
        for event, plain in zip(more, grid, strict=True):
            for key in ("max_fn", "max_delta"):
                peak, lower = event.pop(key), plain.pop(key)
                if lower:
                    self.assertGreaterEqual(float(peak), float(lower))
            self.assertEqual(plain, event)

    def test_rows_of_the_grid_are_as_without_them_and_times_rise(self):
        for name, end, options in CASES:
            with self.subTest(name, options=options):
                self.run_model(self.model(name, 10), "--end", end, *options, out="more")
                self.run_model(self.model(name, 0), "--end", end, *options, out="grid")
                more, grid = (self.read(out, "results.csv").splitlines() for out in ("more", "grid"))
                self.assertGreater(len(more), len(grid) + 50)
                self.assertEqual([], sorted(set(grid) - set(more)))
                times = [float(line.split(",")[0]) for line in more[1:]]
                self.assertTrue(all(a < b for a, b in zip(times, times[1:])))
                self.check_events(*(list(csv.DictReader(self.read(out, "events.csv").splitlines())) for out in ("more", "grid")))
        spectra = [self.freeplay("export", out, "--to", "csv", "--table", "spectra")[0] for out in ("more", "grid")]
        self.assertEqual(*spectra)

    def test_an_impact_has_as_many_rows_as_asked_for(self):
        for options in (("--step", "0.2 us"), ("--accuracy", "1um")):
            for number in (4, 20):
                with self.subTest(options, number=number):
                    model = self.model("slider-crank", number, "interval: 1 s, ").replace("interval: 20 us, ", "")
                    with open(self.path(model), encoding="utf-8") as file:
                        text = file.read().replace("interval: 20 us, ", "").replace("discard: 12 ms", "discard: 0 ms")
                    self.write(model, text.replace("restitution: 0.9", "restitution: 1"))
                    rows, events, _ = self.run_model(model, "--end", "16 ms", *options)
                    times = [float(row["time"]) for row in rows]
                    impacts = [event for event in events if event["impact"] == "1"]
                    self.assertGreater(len(impacts), 5)
                    for event in impacts:
                        until, lasts = float(event["time"]), float(event["duration"])
                        inside = [t for t in times if until - lasts < t < until]
                        # Where it separates more slowly than it came, the half wave ends early.
                        part = math.acos(-min(1.0, float(event["speed"]) / float(event["approach_speed"]))) / math.pi
                        self.assertGreaterEqual(len(inside), math.floor(0.7 * part * number), event)
                        self.assertLessEqual(len(inside), number + 4, event)  # those of both peaks, and of the grid
                        # What pushes on besides makes it another wave.
                        gaps = [b - a for a, b in zip([until - lasts, *inside], inside)]
                        self.assertLess(max(gaps), max(0.35, 2.5 / (part * number)) * lasts, event)

    def test_files_of_both_formats_have_the_same_rows(self):
        self.run_model(self.model("slider-crank", 5), "--end", "16 ms", out="r")
        self.freeplay("compare", "r/results.csv", "r/results.h5", "--tolerance", "0", "--absolute", "0")

    def test_a_second_run_of_verify_and_the_twin_meet_the_grid_alone(self):
        self.freeplay("run", self.model("slider-crank", 5), "--end", "4 ms", "--accuracy", "1um", "--verify", "--twin", "--out", "r")
        plain = self.freeplay("run", self.model("slider-crank", 0), "--end", "4 ms", "--accuracy", "1um", "--verify", "--twin",
                              "--out", "plain")
        self.assertTrue(plain)
        with_rows, without = (json.loads(self.read(out, "summary.json")) for out in ("r", "plain"))
        self.assertEqual(without["verification"]["agreement"], with_rows["verification"]["agreement"])
        self.assertEqual(without["twin"], with_rows["twin"])

    def test_a_run_that_is_cut_goes_on_to_the_same_bytes(self):
        for options in (("--end", "0.06 s"), ("--end", "0.15 s", "--accuracy", "1um")):
            model = self.model("slider-crank", 5)
            options += ("--checkpoint", "20 ms", "--quiet")
            began = time.monotonic()
            self.freeplay("run", model, "--out", "whole", "--force", *options)
            seconds = time.monotonic() - began
            for number, part in ((signal.SIGKILL, 0.3), (signal.SIGKILL, 0.7), (signal.SIGTERM, 0.5)):
                with self.subTest(options, number=number, part=part):
                    shutil.rmtree(self.path("cut"), ignore_errors=True)
                    with subprocess.Popen([PROGRAM, "run", model, "--out", "cut", "--force", *options], cwd=self.folder,
                                          stderr=subprocess.DEVNULL) as process:
                        while process.poll() is None and not os.path.exists(self.path("cut", "checkpoint.bin")):
                            time.sleep(0.005)
                        time.sleep(part * seconds)
                        process.send_signal(number)
                    self.freeplay("run", "--resume", "cut", "--quiet")
                    for name in ("results.csv", "events.csv"):
                        self.assertTrue(self.read("cut", name) == self.read("whole", name), name)
                    self.assertEqual(*(json.loads(self.read(out, "summary.json"))["hashes"] for out in ("cut", "whole")))

    def test_what_is_no_number_of_rows_is_refused(self):
        for value in ("-1", "1001", "1.5", "many", "1 s"):
            out, _ = self.freeplay("validate", self.model("slider-crank", value), "--json", code=3)
            message = json.loads(out)["messages"][0]
            self.assertIn(message["id"], ("out-of-range", "wrong-type", "bad-expression", "dimension-mismatch"), message)
            self.assertTrue(message["line"] > 0 and message["column"] > 0, message)


if __name__ == "__main__":
    unittest.main()
