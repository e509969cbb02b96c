"""Pages that `freeplay report` and `run --report` write."""
import base64
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

from page_reader import Page, numbers, real, wanted_of
from program import PROGRAM, ProgramTest, mechanism

MODEL = mechanism("slider-crank")
LIMIT = 2000000

PENDULUM = """freeplay: 1
name: %s
description: %s
gravity: [0, -9.81]
bodies:
  rod: {mass: 1 kg, inertia: "1 kg*m^2 / 12", com: [0.5 m, 0]}
joints:
  pivot: {type: revolute, between: [ground, rod]}
initial: {joints: {pivot: 0 deg}}
simulation: {end: %s, step: 0.1 ms, output: {interval: 0.1 ms}}
"""


class Report(ProgramTest):
    def run_model(self, *options, out="r", end="5 ms", model=MODEL):
        self.freeplay("run", model, "--quiet", "--end", end, "--out", out, *options)
        return out

    def table(self, *names):
        with open(self.path(*names), encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))
        return {name: [float(row[i]) if row[i] else math.nan for row in rows[1:]] for i, name in enumerate(rows[0])}

    def report(self, *arguments, out="page.html"):
        """The page of some results, which is within its size and refers to nothing."""
        stdout, _ = self.freeplay("report", *arguments, "--out", out, "--force")
        text = self.read(out)
        self.assertEqual("report in %s (%d bytes)\n" % (out, len(text.encode())), stdout)
        self.assertLessEqual(len(text.encode()), LIMIT)
        page = Page(text)
        self.assertIn("default-src 'none'", page.policy)
        self.assertTrue(all(link.startswith("data:image/svg+xml;base64,") for link in page.links))
        self.assertEqual(page.data["provenance"]["data_sha256"], page.hash_of_runs())
        return page

    def compare_channels(self, run, rows):
        times, buckets = numbers(run["times"], "d"), run["buckets"]
        count = len(rows["time"])
        self.assertEqual(count, run["rows"])
        edges = [k * count // buckets for k in range(buckets)] if buckets else range(count)
        self.assertEqual([rows["time"][e] for e in edges] + ([rows["time"][-1]] if buckets else []), times)
        for channel in run["channels"]:
            name, column = channel["name"], rows[channel["name"]]
            known = real(column) or [0.0]
            if real(column):
                self.assertEqual((min(known), max(known)), (channel["min"], channel["max"]), name)
                self.assertEqual(rows["time"][column.index(max(known))], channel["max_time"], name)
                self.assertEqual(rows["time"][column.index(min(known))], channel["min_time"], name)
            else:
                self.assertEqual((None, None), (channel["min"], channel["max"]), name)
            got = [channel["offset"] + x for x in numbers(channel["values"], "f")]
            slack = 6.1e-8 * (max(known) - min(known)) + 1e-15 * abs(channel["offset"]) + 1e-300
            for a, b in zip(got, wanted_of(column, buckets), strict=True):
                self.assertTrue(abs(a - b) <= slack or (math.isnan(a) and math.isnan(b)), "%s: %g is not %g" % (name, a, b))

    def test_a_short_run_is_there_row_by_row(self):
        self.run_model(end="14 ms")
        page, rows = self.report("r"), self.table("r", "results.csv")
        run = page.runs[0]
        self.assertEqual(0, run["buckets"])
        self.assertEqual(set(rows) - {"time"}, {channel["name"] for channel in run["channels"]})
        self.assertEqual("N", next(c["unit"] for c in run["channels"] if c["name"] == "joint.wrist.fn"))
        self.compare_channels(run, rows)
        self.assertEqual([], run["left_out"])
        self.assertEqual([], run["windows"])
        summary = json.loads(self.read("r", "summary.json"))
        del summary["performance"]
        self.assertEqual(summary, run["summary"])
        self.assertEqual(self.read("r", "model.yaml"), run["model"])
        self.assertIn("freeplay run slider-crank.yaml --end '0.014 s'", run["rerun"])
        wanted = {"top", "facts", "mechanism", "orbits", "plots", "clearance", "bearing", "impacts", "drivers", "energy", "advice",
                  "model", "provenance", "scene", "play", "scrub", "speed", "exaggerate", "trace", "forces", "clock", "now", "channels",
                  "unzoom"}
        self.assertEqual(set(), wanted - page.ids)
        self.assertEqual(set(), {"side", "twin"} & page.ids)

    def test_a_long_run_keeps_its_extremes_in_buckets(self):
        self.run_model("--interval", "1 us", end="5 ms")
        page, rows = self.report("r"), self.table("r", "results.csv")
        run = page.runs[0]
        self.assertEqual(0, run["buckets"] % 100)
        self.assertTrue(200 <= run["buckets"] <= 2000)
        self.compare_channels(run, rows)
        self.assertGreater(len(run["windows"]), 0)
        offsets = {channel["name"]: channel["offset"] for channel in run["channels"]}
        for window in run["windows"]:
            rows_of = slice(window["first"], window["first"] + window["rows"])
            self.assertEqual(rows["time"][rows_of], numbers(window["times"], "d"))
            self.assertLessEqual(window["rows"], 64)
            self.assertIn("joint.%s.fn" % window["joint"], window["channels"])
            for name, channel in window["channels"].items():
                self.assertEqual(offsets[name], channel["offset"])
                slack = 6.1e-8 * (max(rows[name]) - min(rows[name])) + 1e-300
                for a, b in zip(numbers(channel["values"], "f"), rows[name][rows_of], strict=True):
                    self.assertAlmostEqual(channel["offset"] + a, b, delta=slack)

    def test_poses_orbits_and_impacts_are_those_of_the_rows(self):
        self.run_model("--interval", "1 us", end="5 ms")
        run, rows = self.report("r").runs[0], self.table("r", "results.csv")
        motion, count = run["animation"], len(rows["time"])
        frames = numbers(motion["rows"], "i")
        self.assertEqual([k * (count - 1) // (motion["frames"] - 1) for k in range(motion["frames"])], frames)
        self.assertEqual([rows["time"][row] for row in frames], numbers(motion["times"], "d"))
        self.assertEqual(["crank", "coupler", "slider"], [body["name"] for body in motion["bodies"]])
        for body in motion["bodies"]:
            poses = numbers(body["poses"], "f")
            for i, quantity in enumerate(("x", "y", "angle")):
                column = rows["body.%s.%s" % (body["name"], quantity)]
                slack = 1e-7 * (max(column) - min(column)) + 1e-15
                for k, row in enumerate(frames):
                    self.assertAlmostEqual(column[row], body["offset"][i] + poses[3 * k + i], delta=slack)
        joints = {joint["name"]: joint for joint in motion["joints"]}
        self.assertEqual({"main", "crankpin", "guide", "wrist"}, set(joints))
        self.assertEqual(("slide", "turn"), (joints["guide"]["symbol"], joints["wrist"]["symbol"]))
        self.assertEqual((5e-4, None), (joints["wrist"]["clearance"], joints["main"]["clearance"]))
        # Bearing and journal meet but for the play, so that places on bodies and poses belong together.
        place = dict(zip([body["name"] for body in motion["bodies"]], motion["bodies"]))
        for joint in (joints["wrist"], joints["crankpin"]):
            ends = []
            for name, at in ((joint["first"], joint["at_first"]), (joint["second"], joint["at_second"])):
                x, y, angle = (o + p for o, p in zip(place[name]["offset"], numbers(place[name]["poses"], "f")[-3:]))
                ends.append((x + math.cos(angle) * at[0] - math.sin(angle) * at[1], y + math.sin(angle) * at[0] + math.cos(angle) * at[1]))
            self.assertLess(math.dist(*ends), 1.2 * (joint["clearance"] or 1e-6))
        orbit = run["orbits"][0]
        points, kept = numbers(orbit["points"], "f"), numbers(orbit["rows"], "i")
        self.assertEqual(("wrist", 5e-4), (orbit["joint"], orbit["clearance"]))
        self.assertTrue(50 <= len(kept) <= 4000 and 2 * len(kept) == len(points) and kept == sorted(set(kept)))
        radius = [math.hypot(x, y) for x, y in zip(rows["joint.wrist.ex"], rows["joint.wrist.ey"])]
        self.assertIn(radius.index(max(radius)), kept)
        for k, row in enumerate(kept):
            self.assertAlmostEqual(rows["joint.wrist.ex"][row] / 5e-4, points[2 * k], delta=1e-6)
        with open(self.path("r", "events.csv"), encoding="utf-8", newline="") as file:
            ended = [event for event in csv.DictReader(file) if event["kind"] == "contact_end"]
        events = run["events"]
        self.assertEqual(len(ended), events["total"])
        largest = sorted((float(event["max_fn"]) for event in ended), reverse=True)[:200]
        self.assertEqual(largest, sorted((row[events["columns"].index("max_fn")] for row in events["rows"]), reverse=True))
        times = [row[0] for row in events["rows"]]
        self.assertEqual(sorted(times), times)

    def test_the_same_results_give_the_same_bytes(self):
        self.run_model("--twin", end="14 ms")
        self.run_model("--ideal", "all", out="ideal")
        page = self.report("r", "ideal")
        self.assertIn("side", page.ids)
        self.assertIn("twin", page.ids)
        self.assertEqual(["slider-crank", "slider-crank-ideal"], [run["name"] for run in page.runs])
        first = self.read("page.html")
        self.report("r", "ideal", out="other/second.html")
        self.assertEqual(first, self.read("other", "second.html"))
        self.assertNotIn(self.folder, first)

    def test_a_window_and_chosen_channels(self):
        self.run_model()
        page = self.report("r", "--from", "1 ms", "--until", "2 ms", "--channels", "joint.wrist.*", "--channels", "energy.work", "--title", "A < B")
        run, rows = page.runs[0], self.table("r", "results.csv")
        inside = [k for k, t in enumerate(rows["time"]) if 1e-3 - 1e-12 <= t <= 2e-3 + 1e-12]
        self.compare_channels(run, {name: [column[k] for k in inside] for name, column in rows.items()})
        self.assertTrue(all(c["name"].startswith("joint.wrist.") or c["name"] == "energy.work" for c in run["channels"]))
        self.assertEqual(("A < B", "A < B"), (page.title, page.data["title"]))
        self.assertEqual(["--channels", "joint.wrist.*", "--channels", "energy.work", "--from", "1 ms", "--until", "2 ms", "--title", "A < B"],
                         page.data["provenance"]["arguments"])

    def test_pictures_of_other_commands_are_on_the_page(self):
        self.run_model()
        self.freeplay("analyze", "error", mechanism("3-rrr"), "--grid", "x=-0.05:0.05:5", "--grid", "y=-0.05:0.05:5", "--svg", "map.svg")
        self.write("evil.svg", '<svg xmlns="http://www.w3.org/2000/svg"><title>"a</title><script>window.pwned=1</script></svg>')
        page = self.report("r", "--picture", "map.svg", "--picture", "evil.svg")
        pictures = [base64.b64decode(link.partition("base64,")[2]).decode() for link in page.links]
        self.assertEqual([self.read("map.svg"), self.read("evil.svg")], pictures)
        self.assertIn("pictures", page.ids)
        self.assertIn('alt="3-rrr: largest position error by clearance"', self.read("page.html"))
        self.assertIn('alt="&quot;a"', self.read("page.html"))
        self.assertNotIn("pwned", self.read("page.html"))
        self.assertEqual("same bytes", self.freeplay("reproduce", "page.html")[0].splitlines()[-1])
        for name, text, code, words in (("no.svg", "x", 6, "it is no SVG"), ("big.svg", "<svg>" + "x" * 1000000, 2, "[too-large]")):
            self.write(name, text)
            self.assertIn(words, self.freeplay("report", "r", "--picture", name, code=code)[1])

    def test_text_of_a_model_stays_text(self):
        evil = "</script><script>window.pwned=1</script><img src=x onerror=window.pwned=1>"
        self.write("evil.yaml", PENDULUM % ('"</title>%s"' % evil, '"%s"' % evil, "10 ms"))
        self.freeplay("run", "evil.yaml", "--quiet", "--out", "r")
        page = self.report("r")
        self.assertIn(evil, page.runs[0]["model"])
        self.assertNotIn("img", page.tags)
        self.assertNotIn(evil, self.read("page.html"))

    def test_a_run_without_play_has_no_sections_of_it(self):
        self.write("p.yaml", PENDULUM % ("p", "x", "10 ms"))
        self.freeplay("run", "p.yaml", "--quiet", "--out", "r")
        page = self.report("r")
        self.assertEqual(set(), {"orbits", "clearance", "bearing", "impacts", "twin", "drivers", "spectra", "side"} & page.ids)
        self.assertIn("mechanism", page.ids)
        # The centre of mass is no end of the rod: points are counted from it.
        self.assertEqual([-0.5, 0.0], page.runs[0]["animation"]["bodies"][0]["points"][0])

    def test_forces_along_an_axis_have_no_zigzag_between_two_points(self):
        self.write("p.yaml", PENDULUM.replace("between: [ground, rod]}\n", "between: [ground, rod]}\n"
                   "  end: {type: joint-stop, kind: rotational, between: [ground, rod], lower: -1, upper: 1, stiffness: 1}\n"
                   "  coil: {type: spring-damper, kind: linear, between: [ground/up, rod], stiffness: 1}\nframes: {ground/up: [0, 1]}\n")
                   % ("p", "x", "10 ms"))
        self.freeplay("run", "p.yaml", "--quiet", "--out", "r")
        symbols = {joint["name"]: joint["symbol"] for joint in self.report("r").runs[0]["animation"]["joints"]}
        self.assertEqual({"pivot": "turn", "end": "force", "coil": "tie"}, symbols)

    def test_rows_without_anything_beside_them(self):
        self.run_model()
        os.mkdir(self.path("alone"))
        shutil.copy(self.path("r", "results.csv"), self.path("alone"))
        page = self.report("alone")
        self.compare_channels(page.runs[0], self.table("r", "results.csv"))
        self.assertEqual("alone", page.runs[0]["name"])
        self.assertIn("no summary.json", page.runs[0]["note"])
        self.assertEqual(set(), {"mechanism", "orbits", "model"} & page.ids)
        alone = self.report("r/results.h5")  # has the model, and the summary stands beside it
        self.assertIn("mechanism", alone.ids)

    def test_a_killed_run_and_one_that_goes_on(self):
        command = [PROGRAM, "run", MODEL, "--quiet", "--end", "100 s", "--out", "r"]
        with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.DEVNULL) as process:
            while not os.path.exists(self.path("r", "results.h5")) or self.freeplay("export", "r", "--to", "csv")[0].count("\n") < 20:
                time.sleep(0.1)
            going_on = self.report("r")
            process.send_signal(signal.SIGKILL)
        killed = self.report("r")
        for page in (going_on, killed):
            self.assertIn("no summary.json", page.runs[0]["note"])
            run = page.runs[0]
            self.assertIn("mechanism", page.ids)
            self.assertEqual(set(), {"clearance", "advice"} & page.ids)
            known = run["summary"]
            self.assertEqual(("incomplete", run["rows"], numbers(run["times"], "d")[-1]), (known["status"], known["counts"]["rows"], known["time"]["reached"]))
            self.assertEqual({"name": "slider-crank", "space": "planar", "bodies": 3, "joints": 4, "clearance_joints": 1, "drivers": 1}, known["model"])
        # Rows of a run that has just begun are read from results.csv, later ones from results.h5: each may be ahead.
        text = self.read("r", "results.csv").count("\n") - 1
        self.assertLessEqual(going_on.runs[0]["rows"], max(killed.runs[0]["rows"], text))
        self.freeplay("export", "r", "--to", "csv", "--out", "rows.csv")
        self.compare_channels(killed.runs[0], self.table("rows.csv"))

    def test_rows_that_were_cut_are_named(self):
        self.run_model("--format", "csv")
        lines = self.read("r", "results.csv").splitlines(keepends=True)
        rows = len(lines) - 1
        self.assertNotIn("note", self.report("r").runs[0])
        self.write("r/results.csv", "".join(lines[: rows // 2 + 1])[:-9])
        self.assertEqual("the file of rows was cut: it has %d of the %d that the run wrote" % (rows // 2 - 1, rows), self.report("r").runs[0]["note"])
        self.assertRegex(self.report("r", "--from", "1 ms").runs[0]["note"], "the file of rows was cut: it ends at 0.00.* s, the run at 0.005 s")
        self.assertEqual("motion, curves and impacts from 0 s to 0.001 s alone; tables as of the whole run",
                         self.report("r", "--until", "1 ms").runs[0]["note"])

    def test_fields_that_are_empty(self):
        self.run_model("--format", "csv")
        with open(self.path("r", "results.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))
        for name, every in (("joint.wrist.fn", 1), ("joint.wrist.ex", 7), ("body.slider.x", 7), ("driver.motor.torque", 7)):
            place = rows[0].index(name)
            for row in rows[1::every]:
                row[place] = ""
        with open(self.path("r", "results.csv"), "w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
        run = self.report("r").runs[0]
        self.compare_channels(run, self.table("r", "results.csv"))
        missing = {channel["name"]: channel["missing"] for channel in run["channels"] if "missing" in channel}
        self.assertEqual({"joint.wrist.fn": run["rows"], **dict.fromkeys(("joint.wrist.ex", "body.slider.x", "driver.motor.torque"), (run["rows"] + 6) // 7)}, missing)

    def test_infinite_values_are_gaps(self):
        self.write("r.csv", "time,a,b\n0,1,inf\n1,inf,-inf\n2,3,inf\n3,-inf,inf\n4,5,nan\n")
        a, b = self.report("r.csv").runs[0]["channels"]
        self.assertEqual((1, 5, None, None), (a["min"], a["max"], b["min"], b["max"]))
        gaps = lambda channel: [math.isnan(x) for x in numbers(channel["values"], "f")]
        self.assertEqual(([False, True] * 2 + [False], [True] * 5), (gaps(a), gaps(b)))

    def test_many_channels_and_runs_fit(self):
        results = []
        for k in range(8):
            results.append(self.run_model("--set", "c=%d um" % (100 + k), out="r%d" % k, end="2 ms", model=mechanism("3-rrr")))
        page = self.report(*results)
        self.assertEqual(8, len(page.runs))
        self.assertEqual("3-rrr, c = 107 um", page.runs[7]["name"])
        same = self.report("r0", self.run_model("--set", "c=100 um", out="again", end="2 ms", model=mechanism("3-rrr")))
        self.assertEqual(["3-rrr, c = 100 um", "3-rrr, c = 100 um (2)"], [run["name"] for run in same.runs])
        for run, result in zip(page.runs, results):
            names = {channel["name"] for channel in run["channels"]}
            self.assertEqual(set(self.table(result, "results.csv")) - {"time"}, names | set(run["left_out"]))
            self.assertIn("energy.work", names)

    def test_pages_are_replaced_and_other_files_are_not(self):
        self.run_model()
        stdout, _ = self.freeplay("report", "r", "--json")
        made = json.loads(stdout)
        self.assertEqual({"file": "r/report.html", "bytes": os.path.getsize(self.path("r", "report.html")), "runs": ["slider-crank"], "left_out": []}, made)
        self.freeplay("report", "r")
        self.write("r/report.html", "mine")
        _, stderr = self.freeplay("report", "r", code=6)
        self.assertIn("r/report.html", stderr)
        self.assertEqual("mine", self.read("r", "report.html"))
        self.freeplay("report", "r", "--force")
        self.assertEqual("", self.freeplay("report", "r", "--quiet")[0])
        self.assertEqual([], [name for name in os.listdir(self.path("r")) if name.endswith(".part")])

    def test_a_run_writes_its_page(self):
        stdout, _ = self.freeplay("run", MODEL, "--end", "1 ms", "--out", "r", "--report")
        self.assertIn("  report in r/report.html (%d bytes)\n" % os.path.getsize(self.path("r", "report.html")), stdout)
        made = self.read("r", "report.html")
        self.freeplay("report", "r")
        self.assertEqual(made, self.read("r", "report.html"))
        stdout, _ = self.freeplay("run", MODEL, "--end", "1 ms", "--out", "r", "--report", "--json", "--twin")
        self.assertEqual(0, json.loads(stdout)["exit_code"])
        self.assertTrue(os.path.exists(self.path("r", "report.html")))
        self.assertFalse(os.path.exists(self.path("r", "twin", "report.html")))
        _, stderr = self.freeplay("run", MODEL, "--dry-run", "--report", code=2)
        self.assertIn("--report", stderr)

    def test_mistakes(self):
        self.run_model(end="1 ms")
        cases = [((), 2, "report needs a result"), (("nix",), 6, "'nix' cannot be read"), (("r", "r/"), 2, "'r/' is given twice"),
                 (("r/results.csv", "r"), 2, "'r' is given twice"), (("r", "./r/results.h5"), 2, "'./r/results.h5' is given twice"),
                 (("r", "--channels", "joint.wrist.fm"), 2, "did you mean 'joint.wrist.f"),
                 (("r", "--from", "2 ms"), 2, "no rows in this window"), (("r", "--from", "2 ms", "--until", "1 ms"), 2, "is after"),
                 (("r",) * 9, 2, "8 runs at most"), (("r", "--out", "r"), 6, "it is a directory")]
        for arguments, code, words in cases:
            with self.subTest(arguments):
                _, stderr = self.freeplay("report", *arguments, code=code)
                self.assertIn(words, stderr)
        self.assertFalse(os.path.exists(self.path("r", "report.html")))

    def test_what_is_written_for_the_page_is_small(self):
        for name in ("a", "b"):
            self.run_model("--twin", end="14 ms", out=name)
        page = self.report("a", "b")
        text = self.read("page.html")
        plots = next(script for script in page.scripts.values() if "dygraphs" in script)
        self.assertIn("@license", plots)  # the notice stays
        self.assertNotIn("sourceMappingURL", text)
        self.assertEqual(set(), {"side", "twin", "spectra", "impacts"} - page.ids)
        own = re.sub(r"\.dygraph-[^{}]*{[^}]*}", "", text.replace(plots, "").replace(page.scripts["freeplay-data"], ""))
        self.assertLess(len(own.encode()), 60000)


if __name__ == "__main__":
    unittest.main()
