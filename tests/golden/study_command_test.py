"""freeplay study: the same bytes however its points are computed, and what is said of a study that has changed."""
import csv
import glob
import json
import math
import os
import random
import re
import shutil
import signal
import statistics
import subprocess
import sys
import time
import unittest
import xml.etree.ElementTree as xml

from program import BUILD, PROGRAM, ProgramTest, mechanism

BALL = """freeplay: 1
name: ball
parameters: {g: 9.81 m/s^2, v: 0 m/s}
gravity: [0, -$g]
bodies:
  ball: {mass: "$v*(1 kg)/(1 m/s) + 1 kg", inertia: 0.1, velocity: {linear: [$v, 0]}}
simulation: {end: 0.1 s, step: 10 ms, output: {interval: 10 ms}}
"""
# A ball of -1 kg fails.
GRID = """study:
  axes: {g: {linspace: [1, 2, 40]}, v: [-2 m/s, 1 m/s]}
  reducers:
    y: {channel: body.ball.y, reduce: final}
    section: {channel: body.ball.y, reduce: poincare, every: 20 ms}
  plots: {lines: {kind: line, x: g, y: y, by: v}, spread: {kind: histogram, value: y}}
"""
SLOW = """study:
  axes: {g: {linspace: [1, 2, 60]}}
  set: {simulation.end: 1 s, simulation.step: 10 us}
  reducers: {y: {channel: body.ball.y, reduce: final}}
"""


class StudyCommand(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("ball.yaml", BALL + GRID)

    def study(self, *words, code=0, **options):
        return self.freeplay("study", *words, code=code, **options)

    def run_json(self, *words, code=4):
        return json.loads(self.study("run", *words, "--json", code=code)[0])

    def files(self, folder):
        found = {}
        for name in ("study.csv", "samples.csv", "study.h5", "failures.jsonl"):
            with open(self.path(folder, name), "rb") as file:
                found[name] = file.read()
        return found

    def rows(self, folder):
        with open(self.path(folder, "study.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_any_number_of_workers_and_shards_gives_the_same_bytes(self):
        told = self.run_json("ball.yaml", "--out", "one", "--jobs", "1")
        self.assertEqual((80, 80, 40, 80), tuple(told[key] for key in ("points", "done", "failed", "ran")))
        wanted = self.files("one")
        for words in (("--jobs", "3"), ("--isolate",)):
            self.run_json("ball.yaml", "--out", words[0][2:], *words)
            self.assertEqual(wanted, self.files(words[0][2:]))
        for shard in ("3/3", "1/3", "2/3"):
            self.run_json("ball.yaml", "--out", "shards", "--shard", shard)
        self.assertFalse(os.path.exists(self.path("shards", "study.csv")))
        self.study("merge", "shards")
        self.assertEqual(wanted, self.files("shards"))

    def test_a_reducer_called_error_leaves_the_reason_its_own_column(self):
        self.write("e.yaml", BALL + GRID.replace("y: {channel", "error: {channel").replace("value: y", "value: error").replace("y: y", "y: error"))
        self.run_json("e.yaml", "--out", "e", "--jobs", "2")
        rows = self.rows("e")
        self.assertEqual(["error", "section", "exit_code", "error_of_point"], list(rows[0])[-4:])
        self.assertEqual({("", "out-of-range")}, {(row["error"], row["error_of_point"]) for row in rows if row["exit_code"] != "0"})
        self.assertTrue(all(float(row["error"]) < 0 for row in rows if row["exit_code"] == "0"))
        self.study("plot", "e")

    def test_failed_points_have_their_reason_and_run_again_on_demand(self):
        self.run_json("ball.yaml", "--out", "r")
        failed = [row for row in self.rows("r") if row["exit_code"] != "0"]
        self.assertEqual(40, len(failed))
        self.assertEqual({("3", "out-of-range", "")}, {(row["exit_code"], row["error"], row["y"]) for row in failed})
        self.assertEqual(0, self.run_json("ball.yaml", "--out", "r")["ran"])
        self.assertEqual(40, self.run_json("ball.yaml", "--out", "r", "--retry-failed")["ran"])
        self.assertEqual(40, self.run_json("ball.yaml", "--out", "r", "--allow-failed", code=0)["failed"])

    def test_a_study_that_is_killed_fifty_times_has_the_same_bytes(self):
        self.write("slow.yaml", BALL + SLOW.replace("10 us", "25 us"))
        begun = time.monotonic()
        self.run_json("slow.yaml", "--out", "killed", "--only", "0", code=0)
        start = time.monotonic() - begun
        calm = self.run_json("slow.yaml", "--out", "calm", code=0)
        seed = random.randrange(10**9)
        chance, cut = random.Random(seed), 0
        for _ in range(50):
            with subprocess.Popen([PROGRAM, "study", "run", "slow.yaml", "--out", "killed", "--quiet", "--jobs", "2"], cwd=self.folder) as process:
                time.sleep(chance.uniform(0.0, start + 4 * calm["wall_seconds"] / 50))
                process.send_signal(signal.SIGKILL)
            cut += process.returncode == -signal.SIGKILL
        told = self.run_json("slow.yaml", "--out", "killed", code=0)
        self.assertGreater(cut, 10, "seed %d" % seed)
        self.assertLess(told["ran"], 59, "no row outlived a kill, seed %d" % seed)
        for name in ("study.csv", "study.h5"):
            with open(self.path("calm", name), "rb") as calm_file, open(self.path("killed", name), "rb") as killed:
                self.assertEqual(calm_file.read(), killed.read(), "%s, seed %d" % (name, seed))

    def test_moments_of_a_linear_model_are_those_of_its_samples(self):
        # A ball falls g t^2/2 in t = 0.1 s: mean and deviation are those of g times 0.005, within three standard errors.
        count = 1000
        for method, width in (("random", 3.0), ("latin-hypercube", 0.1), ("sobol", 0.1)):
            self.write("fall.yaml", BALL + "study:\n  axes: {g: {normal: [10, 2]}}\n  sample: {method: %s, points: %d, seed: 5}\n"
                       "  reducers: {y: {channel: body.ball.y, reduce: final}}\n" % (method, count))
            self.run_json("fall.yaml", "--out", method, code=0)
            falls = [-float(row["y"]) for row in self.rows(method)]
            self.assertAlmostEqual(10 * 0.005, statistics.fmean(falls), delta=width * 2 * 0.005 / math.sqrt(count))
            self.assertAlmostEqual(1.0, statistics.pstdev(falls) / (2 * 0.005), delta=3.0 / math.sqrt(2 * count))

    def test_a_damaged_row_runs_again(self):
        self.run_json("ball.yaml", "--out", "r")
        wanted, segment = self.files("r"), glob.glob(self.path("r", "rows", "*"))[0]
        with open(segment, "r+b") as file:
            text = bytearray(file.read())
            text[len(text) // 2] ^= 1
            file.seek(0)
            file.write(text)
        out, err = self.study("run", "ball.yaml", "--out", "r", "--json", code=4)
        self.assertEqual(1, json.loads(out)["ran"])
        self.assertIn("[rows-damaged]", err)
        self.assertEqual(wanted, self.files("r"))

    def test_a_changed_study_is_refused_extended_or_begun_anew(self):
        self.run_json("ball.yaml", "--out", "r")
        self.write("ball.yaml", BALL + GRID.replace("[-2 m/s, 1 m/s]", "[1 m/s, 2 m/s]"))
        _, err = self.study("run", "ball.yaml", "--out", "r", code=3)
        self.assertIn("[study-changed]", err)
        self.assertIn("--extend keeps 40 of 80 points", err)
        self.assertEqual(40, self.run_json("ball.yaml", "--out", "r", "--extend", code=0)["ran"])
        self.assertEqual(80, self.run_json("ball.yaml", "--out", "r", "--restart", code=0)["ran"])
        self.assertEqual(["0001", "0002"], sorted(os.listdir(self.path("r", "old"))))

    def test_a_plan_says_that_no_point_ended_while_it_tried(self):
        self.write("long.yaml", BALL.replace("end: 0.1 s, step: 10 ms", "end: 1e5 s, step: 1 us") + "study:\n  axes: {v: [1 m/s, 2 m/s]}\n"
                   "  reducers: {x: {channel: body.ball.x, reduce: final}}\n")
        self.assertIn("  a point    longer than 10 s", self.study("plan", "long.yaml")[0])
        self.assertNotIn("  a point", self.study("plan", "long.yaml", "--probe", "0")[0])

    def test_a_plan_does_not_count_what_others_do_on_a_busy_machine(self):
        self.write("slow.yaml", BALL.replace("step: 10 ms", "step: 2 us") + "study:\n  axes: {v: [1 m/s, 2 m/s, 3 m/s, 4 m/s]}\n"
                   "  reducers: {x: {channel: body.ball.x, reduce: final}}\n")
        self.study("run", "slow.yaml", "--out", "r", "--jobs", "1")
        with open(self.path("r", "timing.csv"), encoding="utf-8") as file:
            needed = [float(row["cpu_seconds"]) for row in csv.DictReader(file)]
        one = min(os.sched_getaffinity(0))
        pin = lambda: os.sched_setaffinity(0, {one})
        busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"], preexec_fn=pin) for _ in range(6)]
        try:
            told = json.loads(self.study("plan", "slow.yaml", "--json", preexec_fn=pin)[0])["seconds_per_point"]
        finally:
            for process in busy:
                process.kill()
                process.wait()
        self.assertLess(told["mean"], 3.0 * max(needed))

    def test_an_extension_that_is_cut_short_loses_no_row(self):
        self.run_json("ball.yaml", "--out", "whole")
        self.write("ball.yaml", BALL + GRID.replace("[-2 m/s, 1 m/s]", "[1 m/s]"))  # fewer points: nothing is to be computed
        library = {"LD_PRELOAD": os.path.join(BUILD, "tests", "failing_calls.so"), "FAILING_FOLDER": self.path("r"), "FAILING_WITH": "EIO"}
        words = [PROGRAM, "study", "run", "ball.yaml", "--out", self.path("r"), "--extend", "--json"]
        for call in [*range(1, 24), *range(24, 1000, 9)]:  # rows are moved first; tables follow
            shutil.rmtree(self.path("r"), ignore_errors=True)
            shutil.copytree(self.path("whole"), self.path("r"))
            cut = subprocess.run(words, cwd=self.folder, capture_output=True, text=True, env={**os.environ, **library, "FAILING_CALL": str(call)})
            if cut.returncode == 0:
                break
            told = json.loads(self.study(*words[2:], code=0)[0])
            self.assertEqual([0, 40], [told["ran"], told["done"]], "after call %d: %s" % (call, cut.stderr))
        self.assertGreater(call, 10, cut.stderr)
        self.assertEqual(0, cut.returncode, "more than %d calls" % call)

    def test_gaps_and_other_studies_are_not_merged(self):
        self.run_json("ball.yaml", "--out", "half", "--shard", "1/2", "--allow-failed", code=0)
        _, err = self.study("merge", "half", code=3)
        self.assertIn("40 of 80 points are missing (first 1, 3, 5)", err)
        self.study("merge", "half", "--partial")
        self.assertEqual(40, len(self.rows("half")))
        self.write("other.yaml", BALL + SLOW)
        self.study("run", "other.yaml", "--out", "other", "--only", "0")
        self.assertIn("[study-mixed]", self.study("merge", "half", "other", code=3)[1])

    def test_merging_copies_loses_no_row_and_hides_no_contradiction(self):
        self.run_json("ball.yaml", "--out", "whole", "--jobs", "1")
        wanted = self.files("whole")
        (name,) = os.listdir(self.path("whole", "rows"))
        shutil.copytree(self.path("whole"), self.path("early"))
        with open(self.path("early", "rows", name), "rb+") as segment:  # as copied while rows were written
            segment.truncate(os.path.getsize(segment.name) // 2)
        for folders in (("whole", "early"), ("early", "whole")):
            self.study("merge", *folders)
            self.assertEqual(wanted, self.files(folders[0]))
        for part, points in (("left", "0-39"), ("right", "40-79")):  # two machines with one name of the host
            self.run_json("ball.yaml", "--out", part, "--jobs", "1", "--only", points)
            (segment,) = os.listdir(self.path(part, "rows"))
            os.rename(self.path(part, "rows", segment), self.path(part, "rows", name))
        self.study("merge", "left", "right")
        self.assertEqual(wanted, self.files("left"))

    def test_an_empty_list_of_points_is_no_list_of_all(self):
        for words in (("plan", "ball.yaml", "--points"), ("run", "ball.yaml", "--out", "r")):
            _, err = self.study(*words, "--only", "", code=2)
            self.assertIn("[bad-value]", err)
        self.assertFalse(os.path.exists(self.path("r", "study.csv")))

    def test_a_point_is_a_command_and_is_verified(self):
        self.run_json("ball.yaml", "--out", "r")
        told = json.loads(self.study("point", "r", "3", "--json")[0])
        self.assertEqual({"g", "v"}, set(told["set"]))
        for wrong in ("1.5", "1-2", "-1"):
            self.assertIn("it must be the number of one point, such as 12", self.study("point", "r", wrong, code=2)[1])
        self.study("point", "r", "3", "--run", "--out", "again")
        self.assertTrue(os.path.exists(self.path("again", "results.csv")))
        self.assertEqual("20 points: same\n", self.study("verify", "r")[0])

    def test_pictures_and_page(self):
        self.run_json("ball.yaml", "--out", "r")
        self.study("plot", "r")
        marks = [element for element in xml.parse(self.path("r", "plots", "lines.svg")).iter() if element.get("data-point")]
        self.assertEqual(40, len(marks))
        self.freeplay("report", "r")
        self.assertIn("freeplay run", self.read("r", "report.html"))
        for name, what, command in (("p.svg", "picture", ("study", "plot", "r", "lines")), ("p.html", "page", ("report", "r"))):
            self.write(name, "mine")
            self.assertIn("it is there already, and no %s of this program" % what, self.freeplay(*command, "--out", name, code=6)[1])
            self.assertEqual("mine", self.read(name))
            for force in (("--force",), ()):  # then it is its own
                self.freeplay(*command, "--out", name, *force)

    def test_a_tornado_has_a_bar_for_every_axis(self):
        axes = {"g": "[1, 2]", "bodies.ball.mass": "{uniform: [1 kg, 2 kg]}", "way": "{cases: {left: {v: 0.1 m/s}, right: {v: 0.3 m/s}}}",
                "simulation.integrator": "[bathe, dopri5]"}
        section = ("study:\n  axes:\n%s%s  reducers: {x: {channel: body.ball.x, reduce: final}, y: {channel: body.ball.y, reduce: final}}\n"
                   "  plots: {wind: {kind: tornado, value: x}}\n")
        sample = "  sample: {method: random, points: 5, seed: 1}\n"
        for name, kinds, star in (("mixed", axes, ""), ("listed", {k: v for k, v in axes.items() if "uniform" not in v}, ""),
                                  ("star", {"g": "[1, 2]", "v": "[0.1 m/s, 0.3 m/s]"}, "  combine: star\n")):
            text = section % ("".join("    %s: %s\n" % axis for axis in kinds.items()), sample if name == "mixed" else star)
            self.write(name + ".yaml", BALL + text)
            self.study("run", name + ".yaml", "--out", name, "--quiet")
            self.study("plot", name)
            picture = self.read(name, "plots", "wind.svg")
            xml.fromstring(picture)
            bars = dict(re.findall(r"<title>(\S+) (.*?)</title></rect>", picture))
            self.assertEqual(set(kinds), set(bars))
        for axis in ("way", "v"):  # 0.1 s at these speeds; without an axis the ball rests
            self.assertIn(axis, picture if axis == "v" else self.read("listed", "plots", "wind.svg"))
        self.assertRegex(self.read("listed", "plots", "wind.svg"), r"way 0\.01\d* to 0\.03")
        self.assertRegex(self.read("mixed", "plots", "wind.svg"), r"way 0\.01\d* to 0\.03")
        self.assertRegex(picture, r"v 0 to 0\.03")

    def test_columns_of_one_name_and_units_that_do_not_fit_are_refused_before_anything_runs(self):
        for section, words in (
                ("  axes: {g: [1, 2]}\n  reducers: {g: {channel: body.ball.y, reduce: final}}\n", "an axis has a column of the reducer 'g', too"),
                ("  axes: {g: [1, 2]}\n  reducers: {index: {channel: body.ball.y, reduce: final}}\n", "the name 'index' is reserved"),
                ("  sample: {method: random, points: 100, seed: 1}\n  axes: {g: {uniform: [1 m/s^2, 2 m/s^2]}}\n"
                 "  reducers: {y: {channel: body.ball.y, reduce: final}}\n  stop: {reducer: y, of: mean, half_width: 1 N}\n",
                 "[dimension-mismatch]")):
            with self.subTest(words):
                self.write("bad.yaml", BALL + "study:\n" + section)
                for command in ("plan", "run"):
                    _, err = self.study(command, "bad.yaml", code=3)
                    self.assertIn(words, err)
                    self.assertRegex(err, r"bad\.yaml:\d+:\d+: error: ")
        self.assertNotIn("results", os.listdir(self.folder))

    def test_a_study_stays_in_the_folder_of_results(self):
        self.write("far.yaml", BALL + GRID.replace("study:\n", "study:\n  name: ../../far/away\n"))
        self.study("run", "far.yaml", code=4)
        self.assertEqual(["___.._far_away-study"], os.listdir(self.path("results")))

    def test_a_point_of_a_chain_says_what_its_command_leaves_out(self):
        self.write("chain.yaml", BALL + "study:\n  axes: {g: {linspace: [1, 2, 4]}}\n  warm_start: {along: g}\n"
                   "  reducers: {y: {channel: body.ball.y, reduce: final}}\n")
        self.study("run", "chain.yaml", "--out", "chain")
        self.assertEqual("", self.study("point", "chain", "0")[1])
        out, err = self.study("point", "chain", "2")
        self.assertIn("run ", out)
        self.assertIn("point 2 goes on from the end of point 1", err)
        self.assertEqual(1, json.loads(self.study("point", "chain", "2", "--json")[0])["goes_on_from"])
        self.freeplay("report", "chain")
        page = self.read("chain", "report.html")
        self.assertEqual([0, 1, 2], sorted(int(n) for n in re.findall(r'"before":(\d+)', page)))

    def test_messages_name_the_target_where_it_is_written(self):
        self.write("far.csv", "g,w\n1,2\n")
        self.write("word.csv", "g,v\n1,2\nfast,3\n")
        for section, words in (
                ("  axes: {way: {cases: {a: {g: 1}, b: {gg: 1}}}}\n", r"9:39: error: the model has no parameter of this name"),
                ("  axes: {way: {cases: {a: {g: 1}, b: {g: 2, v: 1 s}}}}\n", r"9:48: error: 'v' = 1 s: "),
                ("  axes: {way: {table: far.csv}}\n", r"column 'w' of 'far\.csv': the model has no parameter"),
                ("  axes: {way: {table: word.csv}}\n", r"line 3 of 'word\.csv': 'g' = fast: 'fast' is not a number"),
                ("  axes: {bodies.ball.mass: [1, 2], all: {target: 'bodies.*.mass', list: [1, 2]}}\n",
                 r"'bodies\.ball\.mass' is set by 'bodies\.ball\.mass' \(line 9\) and by 'all'"),
                ("  axes: {start: {target: g, list: [1, 2]}}\n", r"give the axis another name, and `target: g`")):
            with self.subTest(words):
                self.write("bad.yaml", BALL + "study:\n" + section + "  reducers: {y: {channel: body.ball.y, reduce: final}}\n")
                self.assertRegex(self.study("plan", "bad.yaml", code=3)[1], words)
        self.write("bad.yaml", BALL + "study:\n  reducers: {y: {channel: body.ball.y, reduce: fnal}}\n")
        self.assertEqual(1, self.study("plan", "bad.yaml", code=3)[1].count("error:"))

    def test_a_key_that_a_plot_does_not_look_at_is_told(self):
        self.write("plots.yaml", BALL + "study:\n  axes: {g: [1, 2], v: [0, 1]}\n  reducers: {y: {channel: body.ball.y, reduce: final}}\n"
                   "  plots:\n    a: {kind: heat, x: g, y: v, value: y, by: v}\n    b: {kind: tornado, value: y, x: g}\n"
                   "    c: {kind: line, x: g, y: y, percentiles: [5]}\n    d: {kind: line, x: g, y: y, by: v}\n")
        warnings = self.study("plan", "plots.yaml", "--probe", "0")[1]
        self.assertEqual([("heat", "by"), ("tornado", "x"), ("line", "percentiles")],
                         re.findall(r"a plot of kind (\w+) does not look at '(\w+)'", warnings))

    def test_a_histogram_marks_percentiles_of_each_family(self):
        self.write("two.yaml", BALL + "study:\n  axes: {g: {uniform: [1, 2]}, v: [0, 1]}\n  sample: {method: random, points: 30, seed: 1}\n"
                   "  reducers: {x: {channel: body.ball.x, reduce: final}, y: {channel: body.ball.y, reduce: final}}\n"
                   "  plots: {one: {kind: histogram, value: y, percentiles: [100/2]}, two: {kind: histogram, value: y, by: v, percentiles: [50]}}\n")
        self.study("run", "two.yaml", "--out", "r", "--quiet")
        self.study("plot", "r")
        self.assertEqual([1, 2], [self.read("r", "plots", name + ".svg").count(">50 %<") for name in ("one", "two")])

    def test_a_plan_counts_the_samples_of_sections(self):
        sizes = []
        for count, every in ((5, "20 ms"), (5, "1 ms")):
            self.write("disk.yaml", BALL + "study:\n  axes: {g: {linspace: [1, 2, %d]}}\n"
                       "  reducers: {s: {channel: body.ball.y, reduce: poincare, every: %s}}\n" % (count, every))
            sizes.append(json.loads(self.study("plan", "disk.yaml", "--json")[0])["row_bytes"])
        self.study("run", "disk.yaml", "--out", "r", "--quiet")
        self.assertGreater(sizes[1], sizes[0] + 800)
        lines = sum(os.path.getsize(name) for name in glob.glob(self.path("r", "rows", "*")))
        self.assertAlmostEqual(lines / 5, sizes[1], delta=200)

    def test_columns_of_an_analysis_have_its_units(self):
        self.write("error.yaml", "freeplay: 1\nstudy:\n  models: [%s]\n  axes: {c: [0.1 mm, 0.2 mm]}\n  do: {analyze: error, pose: [0, 0, 0]}\n"
                   "  reducers:\n    error: {column: position, reduce: max}\n    turn: {column: dangle, reduce: max}\n"
                   "    poses: {column: position, reduce: count}\n    part: {of: '[error]/$c'}\n" % mechanism("3-rrr"))
        self.study("run", "error.yaml", "--out", "r", "--quiet")
        record = json.loads(self.read("r", "study.json"))
        self.assertEqual(["m", "rad", "1", "1"], record["units"])
        self.write("wrong.yaml", self.read("error.yaml").replace("[error]/$c", "[error] + 1 kg"))
        self.assertIn("[dimension-mismatch]", self.study("plan", "wrong.yaml", code=3)[1])


if __name__ == "__main__":
    unittest.main()
